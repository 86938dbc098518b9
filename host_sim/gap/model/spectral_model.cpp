// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/spectral_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "gap/likelihood/fast_part.hpp"
#include "gap/model/parts_response.hpp"

namespace steerid::gap {

SpectralRecord::SpectralRecord(const Record& from, const WheelArm& wheel, std::vector<Block> blocks, bool torque_held,
                               bool anew, double highest_hz, double from_hz)
    : record(from),
      motion(measured_motion(from, wheel)),
      spectra(std::move(blocks), highest_hz, from_hz),
      angle(spectra.of(from.angle_rad)),
      net_torque_nm(from.net_torque_nm()),
      held(torque_held),
      anew_each_block(anew),
      lowest_hz(from_hz) {
  torque = torque_late_by(0);
  double square = 0;
  for (const double value : net_torque_nm) square += value * value;
  applied_rms_nm = std::sqrt(square / static_cast<double>(net_torque_nm.size()));
  std::vector<Block> run;
  for (const BlockSpectra::Bins& bins : spectra.blocks()) run.push_back(bins.block);
  stretches = run_stretches(from, run, anew);
}

namespace {

/// A signal so many samples late; beyond its ends these hold.
std::vector<double> late_by(std::ptrdiff_t samples, const std::vector<double>& signal) {
  const std::ptrdiff_t last = std::ssize(signal) - 1;
  std::vector<double> late(signal.size());
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    late[static_cast<std::size_t>(i)] =
        signal[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i - samples, 0, last))];
  }
  return late;
}

}  // namespace

Spectrum SpectralRecord::made(std::span<const double> signal) const {
  if (!(lowest_hz > 0)) return spectra.of(signal);
  return spectra.of(without_drift({signal.begin(), signal.end()}, lowest_hz));
}

Spectrum SpectralRecord::torque_late_by(std::ptrdiff_t samples) const {
  Spectrum out = spectra.of(late_by(samples, net_torque_nm));
  for (Eigen::Index k = 0; held && k < out.size(); ++k) {
    out[k] *= zero_order_hold(spectra.omega()[k] / kResampledRateHz);
  }
  return out;
}

SpectralModel::SpectralModel(const SpectralRecord& record, Parts parts, Spectrum offset)
    : record_(record),
      parts_(std::move(parts)),
      offset_(std::move(offset)),
      torque_nm_(record.record.size()),
      acted_(parts_.size()) {}

/// Derivatives by differences come back to a point after each of its neighbours.
const SpectralModel::Acted& SpectralModel::known(std::size_t part, const WheelArm& wheel, std::ptrdiff_t late,
                                                 std::vector<double> at) {
  const Hypothesis& hypothesis = *parts_[part];
  std::vector<Acted>& all = acted_[part];
  const std::size_t most = at.size() + 2;
  const auto place = std::ranges::find_if(all, [&](const Acted& one) { return one.late == late && one.at == at; });
  if (place != all.end()) {
    std::rotate(all.begin(), place, place + 1);
    return all.front();
  }
  const auto spectrum = [&] {
    hypothesis.torque(wheel, at.data(), record_.record, record_.motion, torque_nm_);
    return record_.made(late == 0 ? torque_nm_ : late_by(late, torque_nm_));
  };
  if (all.size() < most) all.emplace_back();
  std::rotate(all.begin(), all.end() - 1, all.end());
  Acted& latest = all.front();
  latest.at = at;
  latest.late = late;
  latest.torque = spectrum();
  if (const int phase = hypothesis.linear().phase; phase >= 0) {
    at[static_cast<std::size_t>(phase)] = std::numbers::pi / 2;
    latest.quarter = spectrum();
  }
  return latest;
}

Spectrum SpectralModel::acted(std::size_t part, const Point& point, std::ptrdiff_t late) {
  const Hypothesis& hypothesis = *parts_[part];
  const Hypothesis::Linear linear = hypothesis.linear();
  const auto take = [](std::vector<double>& at, int i, double in_place) {
    return i < 0 ? in_place : std::exchange(at[static_cast<std::size_t>(i)], in_place);
  };
  std::vector<double> at = point.effects[part].values;
  at.resize(static_cast<std::size_t>(hypothesis.shown()));
  const double scale = take(at, linear.scale, 1);
  const double phase = take(at, linear.phase, 0);
  const Hypothesis::Knows knows = hypothesis.knows();
  if (knows.inertia) at.push_back(point.wheel.inertia_kgm2);
  if (knows.damping) at.push_back(point.wheel.damping_nms_per_rad);
  if (knows.stiffness) at.push_back(point.wheel.stiffness_nm_per_rad);
  const Acted& one = known(part, point.wheel, late, std::move(at));
  if (linear.phase < 0) return scale * one.torque;
  return scale * std::cos(phase) * one.torque + scale * std::sin(phase) * one.quarter;
}

void SpectralModel::evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& out) {
  const Eigen::VectorXd& omega = record_.spectra.omega();
  const Point at = Point::of(x, parts_);
  const double delay_s = set_parts_response(at, omega, out);
  // A delay of many samples reaches beyond a block: whole samples are shifted in the record, the rest is a phase.
  const auto whole = static_cast<std::ptrdiff_t>(std::lround(delay_s * kResampledRateHz));
  if (whole != shifted_by_) {
    shifted_ = record_.torque_late_by(whole);
    shifted_by_ = whole;
  }
  const double whole_s = static_cast<double>(whole) / kResampledRateHz;
  delay(out.late, omega, delay_s - whole_s);
  const Spectrum late = out.gain_of_recorded();
  residual = record_.angle - late.cwiseProduct(whole == 0 ? record_.torque : shifted_);
  delay(out.late, omega, whole_s);
  if (offset_.size() > 0) residual += offset_;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i]->acts()) continue;
    // What acts in time alone is recorded late, as the applied torque is; the motion that tells the others was so.
    residual -= parts_[i]->exact_at_once() ? late.cwiseProduct(acted(i, at, whole)).eval()
                                           : out.gain_on_motion().cwiseProduct(acted(i, at, 0)).eval();
  }
}

namespace {

Fitted fitted_wheel_number(double sim, double scale) {
  return {sim / kWheelWithin, std::max(sim * kWheelWithin, 10 * scale), scale, Prior::of_given(sim)};
}

/// A choice is enumerated by the starts.
Fitted fitted_effect_number(const Parameter& of) {
  return {std::max(of.low, of.prior.low), std::min(of.high, of.prior.high), of.whole ? 0 : of.scale,
          Prior::normal(of.prior.mean, of.prior.sd)};
}

}  // namespace

std::vector<Fitted> fitted_parameters(const WheelArm& sim, const Parts& parts) {
  // Steps of 3 %, or what a tenth of a radian a second and a radian make of the inertia's torque.
  const double j = sim.inertia_kgm2;
  std::vector<Fitted> fitted = {
      fitted_wheel_number(j, 0.03 * j),
      fitted_wheel_number(sim.damping_nms_per_rad, std::max(0.03 * sim.damping_nms_per_rad, 0.1 * j)),
      fitted_wheel_number(sim.stiffness_nm_per_rad, std::max(0.03 * sim.stiffness_nm_per_rad, 1.0 * j))};
  fitted[1].low = 0;
  if (sim.stiffness_nm_per_rad == 0) fitted[2].low = 0;
  for (const Hypothesis* part : parts) {
    for (const Parameter& parameter : part->type().parameters) fitted.push_back(fitted_effect_number(parameter));
  }
  return fitted;
}

}  // namespace steerid::gap
