// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/spectral_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "gap/sets/set_fit.hpp"

namespace steerid::gap {
namespace {

/// An effect's values with what a linear scan says they explain.
struct Tried {
  double nats = 0;
  std::vector<double> values;
};

Response evaluated(const SpectralRecord& record, const Parts& parts, const Whittle::Fit& fit, const Spectrum& offset,
                   Spectrum& residual) {
  SpectralModel model(record, parts, offset);
  Response response;
  model.evaluate(fit.x, residual, response);
  return response;
}

}  // namespace

std::vector<double> scaled(const Hypothesis& hypothesis, int scaled_by, std::vector<double> values,
                           const LinearScan::Gain& gain) {
  const EffectType& type = hypothesis.type();
  const auto clamped = [&](std::size_t i, double value) {
    return std::clamp(value, type.parameters[i].low, type.parameters[i].high);
  };
  if (scaled_by == Hypothesis::kScalesRatio) {
    values[1] = clamped(1, 1 + gain.first);
  } else if (const int phase = hypothesis.linear().phase; phase >= 0) {
    values[0] = clamped(0, std::hypot(gain.first, gain.second));
    values[static_cast<std::size_t>(phase)] = std::atan2(gain.second, gain.first);
  } else if (scaled_by >= 0) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string_view name = type.parameters[i].name;
      const bool torque = name.ends_with("_nm") || i == 0;  // both levels of asymmetric friction scale together
      if (torque) values[i] = clamped(i, values[i] * gain.first);
    }
  }
  return values;
}

LinearScan::LinearScan(const SpectralRecord& record, const Parts& parts, const Whittle::Fit& fit,
                       const Whittle::Roles& roles, const Spectrum& offset, const std::vector<Spectrum>& free)
    : record_(record),
      response_(evaluated(record, parts, fit, offset, residual_)),
      density_(fit.floor.density(record.spectra, response_.gain.cwiseAbs2())),
      whitened_(record.spectra, response_, fit.floor, roles),
      projection_(whitened_, free),
      left_(projection_.of(whitened_, residual_)) {}

Eigen::VectorXd LinearScan::cleaned(const std::vector<double>& torque_nm) const {
  return projection_.of(whitened_, response_.gain_on_motion().cwiseProduct(record_.made(torque_nm)));
}

LinearScan::Gain LinearScan::of(const std::vector<double>& torque_nm) const {
  const Eigen::VectorXd rows = cleaned(torque_nm);
  const double power = rows.squaredNorm();
  const double along = rows.dot(left_);
  if (!(power > 1e-30)) return {};
  return {along * along / power, along / power, 0};
}

LinearScan::Gain LinearScan::of(const std::vector<double>& first_nm, const std::vector<double>& second_nm) const {
  const Eigen::VectorXd a = cleaned(first_nm);
  const Eigen::VectorXd b = cleaned(second_nm);
  const double aa = a.squaredNorm();
  const double bb = b.squaredNorm();
  const double ab = a.dot(b);
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-9 * aa * bb)) return of(first_nm);
  const double ar = a.dot(left_);
  const double br = b.dot(left_);
  const double first = (bb * ar - ab * br) / determinant;
  const double second = (aa * br - ab * ar) / determinant;
  return {first * ar + second * br, first, second};
}

std::array<double, 3> LinearScan::strongest_lines() const {
  // Blocks of the fit have the finest lines; their power is summed on a grid of half their spacing.
  const Spectrum clean = whitened_.without_ends(residual_);
  double step = 0;
  for (const BlockSpectra::Bins& bins : record_.spectra.blocks()) {
    if (bins.block.role == Block::Role::kFit && bins.count > 2) step = record_.spectra.line_step_rad_s(bins);
  }
  std::array<double, 3> lines_hz{};
  if (!(step > 0)) return lines_hz;
  std::vector<double> power(static_cast<std::size_t>(2 * std::numbers::pi * kHighest_hz / step) + 2, 0.0);
  for (const BlockSpectra::Bins& bins : record_.spectra.blocks()) {
    if (bins.block.role != Block::Role::kFit) continue;
    for (Eigen::Index k = 1; k < bins.count; ++k) {
      const auto at = static_cast<std::size_t>(std::round(record_.spectra.omega()[bins.first + k] / step));
      power[std::min(at, power.size() - 1)] += std::norm(clean[bins.first + k]) / density_[bins.first + k];
    }
  }
  for (double& line_hz : lines_hz) {
    const auto strongest = std::ranges::max_element(power);
    const auto at = static_cast<std::size_t>(strongest - power.begin());
    line_hz = static_cast<double>(at) * step / (2 * std::numbers::pi);
    for (std::size_t k = at > 2 ? at - 2 : 0; k < std::min(power.size(), at + 3); ++k) power[k] = 0;
  }
  return lines_hz;
}

namespace {

/// Frequencies near the strongest lines of what is left, in steps that keep the phase over the whole record.
void spread_over_lines(const SpectralRecord& record, const LinearScan& scan, Hypothesis::Starts& starts) {
  const std::vector<double> unit = starts.values.front();
  starts.values.clear();
  const double step_hz = 0.4 / std::clamp(record.motion.length_s(), 4.0, 120.0);
  const double width_hz =
      0.6 * record.spectra.line_step_rad_s(record.spectra.blocks().front()) / (2 * std::numbers::pi);
  for (const double line_hz : scan.strongest_lines()) {
    for (double f = line_hz - width_hz; f <= line_hz + width_hz; f += step_hz) {
      if (f < 0.05) continue;
      std::vector<double> values = unit;
      values[1] = f;
      starts.values.push_back(values);
    }
  }
}

Tried tried(const Hypothesis& hypothesis, const SpectralRecord& record, const SearchOrigin& origin,
            const Hypothesis::Starts& starts, const std::vector<double>& values, std::vector<double>& first,
            std::vector<double>& second) {
  if (!hypothesis.tried_as_torque()) return {0, values};
  const auto torque = [&](const std::vector<double>& of, std::vector<double>& out) {
    hypothesis.torque(origin.from.wheel, of.data(), record.record, record.motion, out);
  };
  torque(values, first);
  LinearScan::Gain gain;
  const int phase = hypothesis.linear().phase;
  if (phase >= 0) {
    std::vector<double> quarter = values;
    quarter[static_cast<std::size_t>(phase)] += std::numbers::pi / 2;
    torque(quarter, second);
    gain = origin.scan.of(first, second);
  } else {
    gain = origin.scan.of(first);
  }
  // Nothing to scale: the gain counts as far as the factor wanted is one.
  if (starts.scaled == Hypothesis::kScalesNothing) {
    return {gain.first > 0 ? gain.nats / (1 + std::pow(std::log(gain.first), 2)) : 0.0, values};
  }
  const bool one_sided = starts.scaled >= 0 && phase < 0 && hypothesis.type().parameters[0].low >= 0;
  if (one_sided && gain.first < 0) gain = {0, 0.01, 0};
  return {gain.nats, scaled(hypothesis, starts.scaled, values, gain)};
}

}  // namespace

std::vector<StartingPoint> starting_points(const Hypothesis& hypothesis, const SpectralRecord& record,
                                           const SearchOrigin& origin) {
  Hypothesis::Starts starts = hypothesis.starts(origin.from.wheel, origin.acted, record.motion);
  if (starts.by_line) spread_over_lines(record, origin.scan, starts);
  std::vector<Tried> all;
  std::vector<double> first(record.record.size());
  std::vector<double> second(record.record.size());
  for (const std::vector<double>& values : starts.values) {
    all.push_back(tried(hypothesis, record, origin, starts, values, first, second));
  }
  std::ranges::stable_sort(all, [](const Tried& a, const Tried& b) { return a.nats > b.nats; });
  if (hypothesis.tried_as_torque() && all.size() > starts.keep) all.resize(starts.keep);
  std::vector<StartingPoint> points;
  for (const Tried& one : all) {
    points.push_back({one.nats, with_added(origin.from, hypothesis, one.values), starts.scaled});
  }
  return points;
}

Record with_torques_of(const Point& at, const SpectralRecord& record) {
  Record acted = record.record;
  std::vector<double> torque_nm(acted.size());
  for (const Effect& effect : at.effects) {
    const Hypothesis& hypothesis = *hypothesis_of(*effect.type);
    if (!hypothesis.acts()) continue;
    hypothesis.torque(at.wheel, effect.values.data(), record.record, record.motion, torque_nm);
    for (std::size_t i = 0; i < acted.size(); ++i) acted.torque_driver_nm[i] += torque_nm[i];
  }
  return acted;
}

Point with_added(Point at, const Hypothesis& hypothesis, std::vector<double> values) {
  at.effects.emplace_back(hypothesis.type()).values = std::move(values);
  return at;
}

namespace {

/// One search: its model, what of it is fitted, and by which cost.
class Search {
 public:
  Search(const Hypothesis& hypothesis, const SearchSetting& setting)
      : hypothesis_(hypothesis),
        setting_(setting),
        parts_(with(setting.parts, hypothesis)),
        fitted_(fitted_parameters(setting.sim, parts_)),
        model_(setting.record, parts_, setting.offset) {
    std::ranges::copy(setting.present, fitted_.begin());
  }

  /// The best of what the starting points lead to.
  Whittle::Fit from_starts() {
    constexpr std::size_t kFits = 3;
    std::vector<Whittle::Fit> starts;
    for (const StartingPoint& point : setting_.starts) starts.emplace_back().x = point.at.numbers();
    const auto by_cost = [this](const Whittle::Fit& fit) { return cost(fit); };
    if (hypothesis_.acts() && starts.size() > kFits) {
      for (Whittle::Fit& one : starts) one = judged(one.x);
      std::ranges::sort(starts, {}, by_cost);
      starts.resize(kFits);
    }
    for (Whittle::Fit& one : starts) one = refined(one);
    return *std::ranges::min_element(starts, {}, by_cost);
  }

  /// A changed response is cheap to work out and its valleys are narrow: on until nothing is gained any more.
  Whittle::Fit to_the_end(Whittle::Fit best) {
    constexpr int kAgain = 4;
    for (int again = 0; again < kAgain && !hypothesis_.acts(); ++again) {
      Whittle::Fit next = refined(best);
      if (!(cost(next) < cost(best) - 0.1)) break;
      best = std::move(next);
    }
    return best;
  }

  /// `best`, or what its steps have missed where that is better; and what they miss from there.
  Whittle::Fit unless_missed(Whittle::Fit best) {
    constexpr int kMost = 3;
    for (int again = 0; again < kMost; ++again) {
      Point from = Point::of(best.x, parts_);
      std::vector<std::vector<double>> missed = hypothesis_.missed(from.effects.back().values);
      std::ranges::move(hypothesis_.missed_instants(from.effects.back().values), std::back_inserter(missed));
      from.effects.pop_back();
      std::optional<Whittle::Fit> other;
      for (const std::size_t i : nearest(from, missed, best.floor)) {
        Whittle::Fit fit = judged(with_added(from, hypothesis_, missed[i]).numbers());
        if (!other || cost(fit) < cost(*other)) other = std::move(fit);
      }
      if (!other) return best;
      *other = refined(*other);
      if (!(cost(*other) < cost(best))) return best;
      best = std::move(*other);
    }
    return best;
  }

 private:
  static Parts with(Parts parts, const Hypothesis& hypothesis) {
    parts.push_back(&hypothesis);
    return parts;
  }
  double cost(const Whittle::Fit& fit) const { return fit.cost(setting_.roles); }
  /// The few of an effect's values that leave least under one floor: a floor of its own for each of hundreds takes far
  /// longer than all that it is asked about. The effect is a torque, so that the response is the same for all.
  std::vector<std::size_t> nearest(const Point& from, const std::vector<std::vector<double>>& all,
                                   const NoiseFloor& floor) {
    constexpr std::size_t kFew = 8;
    std::vector<double> left(all.size());
    std::optional<Whittle::Whitened> whitened;
    Spectrum residual;
    Response response;
    for (std::size_t i = 0; i < all.size(); ++i) {
      model_.evaluate(with_added(from, hypothesis_, all[i]).numbers(), residual, response);
      if (!whitened) whitened.emplace(setting_.record.spectra, response, floor, setting_.roles);
      left[i] = (*whitened)(residual).squaredNorm();
    }
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return left[i]; });
    order.resize(std::min(kFew, order.size()));
    return order;
  }
  Whittle::Fit judged(const Eigen::VectorXd& x) {
    return setting_.whittle.judge(model_, x, fitted_, setting_.roles, setting_.slow);
  }
  Whittle::Fit refined(const Whittle::Fit& from) {
    return setting_.whittle.fit(model_, from.x, fitted_, setting_.roles, setting_.slow, kMotionBudget);
  }

  const Hypothesis& hypothesis_;
  const SearchSetting& setting_;
  Parts parts_;
  std::vector<Fitted> fitted_;
  SpectralModel model_;
};

}  // namespace

Whittle::Fit search(const Hypothesis& hypothesis, const SearchSetting& setting) {
  Search one(hypothesis, setting);
  return one.unless_missed(one.to_the_end(one.from_starts()));
}

}  // namespace steerid::gap
