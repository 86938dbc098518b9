#include "gap/next_experiment.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gap/simulated_model.hpp"
#include "plant/free_run.hpp"

namespace steerid {
namespace {

constexpr double kRate_hz = 100;
constexpr double kPeriod_s = 10;
constexpr std::size_t kMostModels = 4;

/// A model that is left standing.
struct Standing {
  std::string id;
  double probability = 0;
  Simulation simulation;
};

/// One period of rest-to-steady and one to look at, of a multisine with Schroeder's phases, from the motor.
Record probe_record(const ProbeProposal& probe) {
  const auto first = static_cast<int>(std::ceil(probe.low_hz * kPeriod_s - 1e-9));
  const auto last = static_cast<int>(std::floor(probe.high_hz * kPeriod_s + 1e-9));
  const int tones = last - first + 1;
  const double amplitude = probe.rms_nm * std::sqrt(2.0 / tones);
  Record record;
  const auto samples = static_cast<std::size_t>(2 * kPeriod_s * kRate_hz);
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    double torque = 0;
    for (int k = 0; k < tones; ++k) {
      const double phase = -std::numbers::pi * k * (k - 1) / tones;
      torque += std::cos(2 * std::numbers::pi * (first + k) / kPeriod_s * t + phase);
    }
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(amplitude * torque);
    record.angle_rad.push_back(0);
  }
  return record;
}

std::vector<Standing> standing_models(const Diagnosis& diagnosis, const Comparison& comparison,
                                      const Simulation& simulation) {
  std::vector<Standing> models;
  for (const RankedEffect& one : diagnosis.ranking) {
    if (models.size() == kMostModels) break;
    const auto found = std::ranges::find(comparison.candidates, one.id, &Candidate::id);
    if (found == comparison.candidates.end() || one.id == "unmeasured_torque") continue;
    Standing model{one.id, std::max(one.probability, 1e-3), simulation};
    model.simulation.wheel = wheel_of(found->fit.x);
    if (found->type != nullptr) {
      Effect effect(*found->type);
      const auto count = static_cast<Eigen::Index>(effect.values.size());
      for (Eigen::Index i = 0; i < count; ++i) {
        effect.values[static_cast<std::size_t>(i)] = found->fit.x[found->fit.x.size() - count + i];
      }
      model.simulation.effects.push_back(effect);
    }
    models.push_back(std::move(model));
  }
  return models;
}

/// What both models' differing answers to the probe are worth, J, B and C being free to make up for some of it.
double separation(const Spectrum& a, const Spectrum& b, const Spectrum& torque, const BlockSpectra& spectra,
                  const WheelArm& wheel, const NoiseFloor& floor) {
  const Eigen::VectorXd& omega = spectra.omega();
  Spectrum response(omega.size());
  for (Eigen::Index k = 0; k < omega.size(); ++k) response[k] = wheel_response(wheel, omega[k]);
  const Whittle::Whitened whitened(spectra, response, floor, {Block::Role::kFit});
  Eigen::MatrixXd wheel_columns(whitened.rows(), 3);
  for (int power = 0; power < 3; ++power) {
    Spectrum column(omega.size());
    for (Eigen::Index k = 0; k < omega.size(); ++k) {
      column[k] = response[k] * response[k] * std::pow(Complex(0, omega[k]), power) * torque[k];
    }
    wheel_columns.col(power) = whitened(column);
    wheel_columns.col(power) /= std::max(wheel_columns.col(power).norm(), 1e-300);
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(wheel_columns);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(whitened.rows(), 3);
  Eigen::VectorXd difference = whitened(a - b);
  difference -= basis * (basis.transpose() * difference).eval();
  return difference.squaredNorm();
}

}  // namespace

NextExperiment next_experiment(const Diagnosis& diagnosis, const Comparison& comparison, const Whittle& whittle,
                               const Simulation& simulation) {
  const std::vector<Standing> models = standing_models(diagnosis, comparison, simulation);
  NextExperiment best;
  double best_score = -1;
  // An EPS grants some 5 Nm at the peak; the crest factor is 1.7.
  for (const auto& [low, high] : {std::array{0.1, 1.0}, {0.2, 2.5}, {0.2, 5.0}, {0.2, 8.0}, {2.0, 10.0}}) {
    for (const double rms : {1.0, 2.8}) {
      const ProbeProposal probe{.rms_nm = rms, .low_hz = low, .high_hz = high, .period_s = kPeriod_s, .duration_s = 60};
      const Record record = probe_record(probe);
      const auto half = record.size() / 2;
      const BlockSpectra spectra({{Block::Role::kFit, half, half}}, kRate_hz);
      const Spectrum torque = spectra.of(record.torque_motor_nm);
      std::vector<Spectrum> answers;
      for (const Standing& model : models) {
        FreeRun run(record);
        const auto angle = run(model.simulation.wheel, model.simulation.effects, WheelState{});
        answers.push_back(std::isfinite(angle.back()) ? spectra.of(angle) : Spectrum::Zero(spectra.bins()));
      }
      double score = 0;
      double largest = -1;
      NextExperiment here{.probe = probe};
      for (std::size_t i = 0; i < models.size(); ++i) {
        for (std::size_t j = i + 1; j < models.size(); ++j) {
          const double nats =
              probe.duration_s / kPeriod_s *
              separation(answers[i], answers[j], torque, spectra, models[i].simulation.wheel, whittle.white());
          const double weight = models[i].probability * models[j].probability;
          score += weight * std::log1p(nats);
          if (weight * std::log1p(nats) > largest) {
            largest = weight * std::log1p(nats);
            here.separates = {models[i].id, models[j].id};
            here.separation = nats;
          }
        }
      }
      if (score > best_score * 1.02) {
        best_score = score;
        best = here;
      }
    }
  }
  best.why = fmt::format(
      "A multisine of {:g} Nm rms from {:g} to {:g} Hz for {:g} s is expected to tell {} from {} by {:.0f} nats.",
      best.probe.rms_nm, best.probe.low_hz, best.probe.high_hz, best.probe.duration_s, best.separates[0],
      best.separates[1], best.separation);
  return best;
}

}  // namespace steerid
