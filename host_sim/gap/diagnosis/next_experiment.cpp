// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/next_experiment.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "gap/attribution/verdict_ids.hpp"
#include "gap/model/simulated_model.hpp"
#include "plant/free_run.hpp"

namespace steerid {
namespace {

constexpr double kRate_hz = 100;
constexpr double kPeriod_s = 10;
constexpr double kDuration_s = 60;
constexpr std::size_t kMostRivals = 3;
constexpr double kCrest = 1.8;       // of a multisine with Schroeder's phases
constexpr double kEpsPeak_nm = 5.0;  // what an EPS motor grants; a machine that has taken more takes that
/// Nm rms, the weakest probe that is proposed: five steps of a motor's torque request on a bus (some 0.01 Nm), and a
/// tenth of the dry friction that a steering holds (0.5 Nm, docs/column.md). Proposals on labelled records are of 2 Nm
/// and more; those below come of a model that swings at next to nothing, and 0.02 or 0.2 would refuse the same ones.
constexpr double kLeast_nm = 0.05;
constexpr double kTold = 1e-3;    // smaller probabilities are not told apart
constexpr double kFarther = 1.5;  // than the record went, at most

/// A model that is left standing, and the weight of its being right.
struct Standing {
  std::string id;
  double weight = 0;
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

Simulation simulation_of(const Candidate& candidate, const Simulation& given) {
  Simulation out = given;
  out.wheel = wheel_of(candidate.fit.x);
  if (const auto effect = fitted_effect(candidate)) out.effects.push_back(*effect);
  return out;
}

/// The verdict (or what stands in for it) first, then the effects that come closest to it: by probability, and where
/// that says nothing by how well they fit. A slow torque of no known course cannot be simulated ahead.
std::vector<Standing> standing_models(const Diagnosis& diagnosis, const Comparison& comparison,
                                      const Simulation& given) {
  struct Ranked {
    const Candidate* candidate;
    double probability;
  };
  std::vector<Ranked> ranked;
  for (const Candidate& one : comparison.candidates) {
    const auto found = std::ranges::find(diagnosis.ranking, one.id, &RankedEffect::id);
    const bool rival = names_effect(one.id) || one.id == diagnosis.verdict;
    if (rival && one.id != "unmeasured_torque") ranked.push_back({&one, found->probability});
  }
  std::ranges::sort(ranked, [](const Ranked& a, const Ranked& b) {
    const double pa = std::max(a.probability, kTold);
    const double pb = std::max(b.probability, kTold);
    return pa != pb ? pa > pb : a.candidate->fit.cost(kSeen) < b.candidate->fit.cost(kSeen);
  });
  std::vector<Standing> models;
  for (const Ranked& one : ranked) {
    if (models.size() > kMostRivals) break;
    models.push_back({one.candidate->id, std::max(one.probability, kTold), simulation_of(*one.candidate, given)});
  }
  return models;
}

/// Two effects at once against each of them alone; none where there is one, or one that cannot be simulated ahead.
std::vector<Standing> both_or_one(const Diagnosis& diagnosis, const Comparison& comparison, const Simulation& given) {
  if (diagnosis.causes.size() < 2) return {};
  Simulation both = given;
  both.wheel = diagnosis.with_effect.wheel;
  std::string together;
  std::vector<Standing> models = {{}};
  for (const Cause& cause : diagnosis.causes) {
    const auto alone = std::ranges::find(comparison.candidates, cause.effect.type->id, &Candidate::id);
    if (alone == comparison.candidates.end() || alone->id == "unmeasured_torque") return {};
    both.effects.push_back(cause.effect);
    together += (together.empty() ? "" : " with ") + alone->id;
    models.push_back({alone->id + " alone", 1.0, simulation_of(*alone, given)});
  }
  models.front() = {together, 1.0, both};
  return models;
}

/// What both models' differing answers to the probe are worth, J, B and C being free to make up for some of it.
double separation(const Spectrum& a, const Spectrum& b, const Spectrum& torque, const BlockSpectra& spectra,
                  const WheelArm& wheel, const NoiseFloor& floor) {
  const Eigen::VectorXd& omega = spectra.omega();
  Spectrum response(omega.size());
  for (Eigen::Index k = 0; k < omega.size(); ++k) response[k] = wheel_response(wheel, omega[k]);
  const Whittle::Whitened whitened(spectra, {response, response}, floor, {Block::Role::kFit});
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

double span_of(std::span<const double> angle) {
  const auto [low, high] = std::ranges::minmax_element(angle);
  return *high - *low;
}

/// A probe with the answers of all that is left standing; of the steady second period.
struct Played {
  ProbeProposal probe;
  BlockSpectra spectra{{}, kRate_hz};
  Spectrum torque{};
  std::vector<std::optional<Spectrum>> answers{};  ///< none: the simulation diverges
  double angle_span_rad = 0;                       ///< of the first model
};

Played play(const ProbeProposal& probe, const std::vector<Standing>& models) {
  Played out{.probe = probe};
  const Record record = probe_record(probe);
  const auto half = record.size() / 2;
  out.spectra = BlockSpectra({{Block::Role::kFit, half, half}}, kRate_hz);
  out.torque = out.spectra.of(record.torque_motor_nm);
  FreeRun run(record);
  for (const Standing& model : models) {
    const auto angle = run(model.simulation.wheel, model.simulation.effects, WheelState{});
    const bool finite = std::isfinite(angle.back());
    if (&model == &models.front() && finite) out.angle_span_rad = span_of(angle.subspan(half));
    out.answers.push_back(finite ? std::optional(out.spectra.of(angle)) : std::nullopt);
  }
  return out;
}

/// The strongest probe of a band that neither the motor nor the wheel's travel forbids.
Played play_within(double low_hz, double high_hz, double share, const std::vector<Standing>& models,
                   const Record& record) {
  double peak_nm = kEpsPeak_nm;
  for (std::size_t i = 0; i < record.size(); ++i) peak_nm = std::max(peak_nm, std::abs(record.net_torque_nm(i)));
  const double travel_rad = kFarther * span_of(record.angle_rad);
  ProbeProposal probe{.rms_nm = share * peak_nm / kCrest,
                      .low_hz = low_hz,
                      .high_hz = high_hz,
                      .period_s = kPeriod_s,
                      .duration_s = kDuration_s};
  Played out = play(probe, models);
  for (int again = 0; again < 4 && out.angle_span_rad > share * travel_rad; ++again) {
    probe.rms_nm *= 0.95 * share * travel_rad / out.angle_span_rad;
    out = play(probe, models);
  }
  return out;
}

double two_digits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::floor(value / unit) * unit;
}

}  // namespace

NextExperiment next_experiment(const Diagnosis& diagnosis, const Comparison& comparison, const PreparedRecord& prepared,
                               const Simulation& given) {
  if (diagnosis.verdict == "unknown" && diagnosis.causes.empty()) {
    return {.why = "Nothing explains this record, so that there are no rivals for a probe to tell apart."};
  }
  std::vector<Standing> models = both_or_one(diagnosis, comparison, given);
  if (models.empty()) models = standing_models(diagnosis, comparison, given);
  NextExperiment best;
  if (models.size() < 2) {
    best.why = "No other effect of the library is left that a probe could tell apart.";
    return best;
  }
  double best_score = -1;
  for (const auto& [low, high] : {std::array{0.1, 1.0}, {0.2, 2.5}, {0.2, 5.0}, {0.2, 8.0}, {2.0, 10.0}}) {
    for (const double share : {0.35, 1.0}) {
      const Played played = play_within(low, high, share, models, prepared.record);
      if (!played.answers[0]) continue;
      if (played.probe.rms_nm < kLeast_nm) continue;
      double score = 0;
      double runner_up = 0;
      for (std::size_t i = 1; i < models.size(); ++i) {
        if (!played.answers[i]) continue;
        const double nats = kDuration_s / kPeriod_s *
                            separation(*played.answers[0], *played.answers[i], played.torque, played.spectra,
                                       models[0].simulation.wheel, prepared.whittle->white());
        score += models[i].weight * std::log1p(nats);
        if (i == 1) runner_up = nats;
      }
      if (score > best_score * 1.02) {
        best_score = score;
        best.probe = played.probe;
        best.separates = {models[0].id, models[1].id};
        best.separation = runner_up;
      }
    }
  }
  if (!(best.separation > 0)) return {};  // what was found, or its nearest rival, diverges under every probe
  best.probe.rms_nm = two_digits(best.probe.rms_nm);
  constexpr double kPlainly = 1000;  // more says nothing more
  best.why = fmt::format(
      "A multisine of {:g} Nm rms from {:g} to {:g} Hz for {:g} s is expected to tell {} from {} by {} nats of "
      "log likelihood (N nats are odds of e^N to 1).",
      best.probe.rms_nm, best.probe.low_hz, best.probe.high_hz, best.probe.duration_s, best.separates[0],
      best.separates[1],
      best.separation < kPlainly ? fmt::format("{:.2g}", best.separation) : fmt::format("more than {:g}", kPlainly));
  return best;
}

}  // namespace steerid
