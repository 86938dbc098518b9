// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/best_probe.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "experiment/multisine.hpp"
#include "gap/likelihood/block_spectra.hpp"
#include "gap/model/parts_response.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/free_run.hpp"

namespace steerid::gap {
namespace {

constexpr auto kPeriodSamples = static_cast<std::size_t>(ProbeProposal().period_s / kTickS + 0.5);
constexpr double kCrest = 1.8;       // of a multisine with Schroeder's phases
constexpr double kEpsPeak_nm = 5.0;  // what an EPS motor grants; a machine that has taken more takes that
constexpr double kFarther = 1.5;     // than the record went, at most

/// One period from rest to steady, and one to look at.
Record probe_record(const ProbeProposal& probe) {
  Multisine multisine({probe.rms_nm, probe.low_hz, probe.high_hz, probe.period_s, {}});
  Record record;
  for (std::size_t i = 0; i < 2 * kPeriodSamples; ++i) {
    record.time_s.push_back(static_cast<double>(i) * kTickS);
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(multisine.next().value);
    record.angle_rad.push_back(0);
  }
  return record;
}

double span_of(std::span<const double> angle) {
  const auto [low, high] = std::ranges::minmax_element(angle);
  return *high - *low;
}

std::ptrdiff_t free_numbers(const Standing& model) {
  return std::ranges::count_if(model.fitted, [](const Fitted& one) { return one.scale > 0; });
}

/// Simulated wheels under one probe.
class Play {
 public:
  Play(const ProbeProposal& probe, TorqueSignal::Between between)
      : record_(probe_record(probe)), run_(record_, {.between = between}) {}
  Play(const Play&) = delete;
  Play& operator=(const Play&) = delete;

  /// One angle a sample, valid until the next; empty where the wheel runs away.
  std::span<const double> angle_rad(const Point& at) {
    const auto angle = run_(at.wheel, at.effects, WheelState{});
    return std::isfinite(angle.back()) ? angle : std::span<const double>();
  }

 private:
  Record record_;
  FreeRun run_;
};

/// What the models answer to a probe.
struct Judged {
  ProbeProposal probe;
  bool runs_away = false;    ///< the first model does
  std::vector<double> nats;  ///< between the first model and each of the others; 0 where that one runs away
  double score = 0;
};

/// What it counts that a model is told apart: nothing if another one is told less that the same change hangs on.
double part_of_score(const std::vector<Standing>& models, const std::vector<double>& nats, std::size_t model) {
  for (std::size_t i = 1; i < models.size(); ++i) {
    const bool less = nats[i - 1] < nats[model - 1] || (nats[i - 1] == nats[model - 1] && i < model);
    if (models[i].doubted == models[model].doubted && less) return 0;
  }
  return models[model].weight * std::log1p(nats[model - 1]);
}

class Judge {
 public:
  Judge(const std::vector<Standing>& models, const ProbeSetting& setting)
      : models_(models),
        setting_(setting),
        spectra_(std::vector{Block{Block::Role::kFit, kPeriodSamples, kPeriodSamples}}),
        whitened_(spectra_, response_of_first(), setting.floor, {Block::Role::kFit}) {}

  /// Of the strongest probe of a band that neither the motor nor the wheel's travel forbids, or of a share of it.
  [[nodiscard]] Judged judge(double low_hz, double high_hz, double share) const {
    const Record& record = setting_.prepared.record;
    double peak_nm = kEpsPeak_nm;
    for (std::size_t i = 0; i < record.size(); ++i) peak_nm = std::max(peak_nm, std::abs(record.net_torque_nm(i)));
    const double travel_rad = share * kFarther * span_of(record.angle_rad);
    Judged out{.probe = {.rms_nm = share * peak_nm / kCrest, .low_hz = low_hz, .high_hz = high_hz},
               .nats = std::vector<double>(models_.size() - 1)};
    constexpr int kRounds = 5;
    for (int round = 0; round < kRounds; ++round) {
      Play play(out.probe, setting_.prepared.spectral->between());
      double span_rad = 0;
      std::vector<std::optional<Spectrum>> answers;
      for (const Standing& model : models_) {
        const std::span<const double> angle = play.angle_rad(model.at);
        answers.push_back(angle.empty() ? std::nullopt : std::optional(spectra_.of(angle)));
        if (!angle.empty()) span_rad = std::max(span_rad, span_of(angle.subspan(kPeriodSamples)));
      }
      out.runs_away = !answers.front().has_value();
      if (out.runs_away) return out;
      if (span_rad > travel_rad && round + 1 < kRounds) {
        out.probe.rms_nm *= 0.95 * travel_rad / span_rad;
        continue;
      }
      separate(play, answers, out);
      return out;
    }
    return out;
  }

 private:
  [[nodiscard]] Response response_of_first() const {
    Response response;
    set_parts_response(felt_by_noise(models_.front().at, setting_.prepared.spectral->motion), spectra_.omega(),
                       response);
    return response;
  }

  void separate(Play& play, const std::vector<std::optional<Spectrum>>& answers, Judged& out) const {
    std::vector<std::optional<Eigen::MatrixXd>> made_up(models_.size());
    for (std::size_t i = 1; i < models_.size(); ++i) {
      if (!answers[i]) continue;
      const std::size_t poorer = free_numbers(models_[i]) <= free_numbers(models_[0]) ? i : 0;
      if (!made_up[poorer]) made_up[poorer] = made_up_by(play, models_[poorer], *answers[poorer]);
      const Eigen::MatrixXd& basis = *made_up[poorer];
      Eigen::VectorXd difference = whitened_(*answers[0] - *answers[i]);
      difference -= basis * (basis.transpose() * difference).eval();
      out.nats[i - 1] = out.probe.duration_s / out.probe.period_s * difference.squaredNorm() / setting_.dispersion;
    }
    for (std::size_t i = 1; i < models_.size(); ++i) out.score += part_of_score(models_, out.nats, i);
  }

  /// Orthonormal: what the model's free numbers can do to its answer.
  [[nodiscard]] Eigen::MatrixXd made_up_by(Play& play, const Standing& model, const Spectrum& answer) const {
    Eigen::MatrixXd columns(whitened_.rows(), std::ssize(model.fitted));
    Eigen::Index count = 0;
    for (std::size_t i = 0; i < model.fitted.size(); ++i) {
      if (!(model.fitted[i].scale > 0)) continue;
      Eigen::VectorXd beside = model.at.numbers();
      double& number = beside[static_cast<Eigen::Index>(i)];
      number += difference_step(model.fitted[i], number);
      const std::span<const double> angle = play.angle_rad(Point::of(beside, hypotheses_of(model.at.effects)));
      if (angle.empty()) continue;
      const Eigen::VectorXd column = whitened_(spectra_.of(angle) - answer);
      if (column.norm() > 0) columns.col(count++) = column.normalized();
    }
    // Beside a wheel that a loop alone holds every run may leave.
    if (count == 0) return Eigen::MatrixXd(columns.rows(), 0);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns.leftCols(count));
    return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
  }

  const std::vector<Standing>& models_;
  const ProbeSetting& setting_;
  BlockSpectra spectra_;
  Whittle::Whitened whitened_;
};

double two_digits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::floor(value / unit) * unit;
}

}  // namespace

NextExperiment best_probe(const std::vector<Standing>& models, const ProbeSetting& setting) {
  constexpr std::array<std::array<double, 2>, 5> kBands_hz = {
      {{0.1, 1.0}, {0.2, 2.5}, {0.2, 5.0}, {0.2, 8.0}, {2.0, 10.0}}};
  constexpr std::array kShares = {0.35, 1.0};
  const Judge judge(models, setting);
  std::vector<Judged> all(kBands_hz.size() * kShares.size());
  work_in_parallel(all.size(), setting.threads, [&](std::size_t i) {
    const auto& [low_hz, high_hz] = kBands_hz[i / kShares.size()];
    all[i] = judge.judge(low_hz, high_hz, kShares[i % kShares.size()]);
  });
  std::erase_if(all, &Judged::runs_away);
  if (all.empty()) {
    return {.why = fmt::format("A wheel with {} runs away under every probe, so that none can be judged by simulation.",
                               models.front().name)};
  }
  const Judged& best = *std::ranges::max_element(all, {}, &Judged::score);
  const auto part = [&](std::size_t i) { return part_of_score(models, best.nats, i); };
  std::size_t told = 1;
  for (std::size_t i = 2; i < models.size(); ++i) told = part(i) > part(told) ? i : told;
  NextExperiment out{.probe = best.probe, .separation = best.nats[told - 1]};
  if (!(out.separation >= settling_nats())) {
    out.why = fmt::format(
        "No probe is proposed: none that the motor's torque and the wheel's travel allow is expected to tell {} from "
        "{} by odds of {:.3g} to 1.",
        models[0].name, models[told].name, (1 - kDoubt) / kDoubt);
    return out;
  }
  out.separates = {models[0].name, models[told].name};
  out.probe.rms_nm = two_digits(out.probe.rms_nm);
  constexpr double kPlainly = 1000;  // more says nothing more
  out.why = fmt::format(
      "A multisine of {:g} Nm rms from {:g} to {:g} Hz for {:g} s is expected to tell {} from {} by {} nats of "
      "log likelihood (N nats are odds of e^N to 1).",
      out.probe.rms_nm, out.probe.low_hz, out.probe.high_hz, out.probe.duration_s, out.separates[0], out.separates[1],
      out.separation < kPlainly ? fmt::format("{:.2g}", out.separation) : fmt::format("more than {:g}", kPlainly));
  return out;
}

}  // namespace steerid::gap
