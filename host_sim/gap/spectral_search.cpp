#include "gap/spectral_search.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace steerid {
namespace {

/// A starting point with what a linear scan says it explains.
struct Candidate {
  double nats = 0;
  std::vector<double> values;
};

Response evaluated(const SpectralRecord& record, const SpectralModel::Parts& parts, const Whittle::Fit& fit,
                   const Spectrum& offset, Spectrum& residual) {
  SpectralModel model(record, parts, offset);
  Response response;
  model.evaluate(fit.x, residual, response);
  return response;
}

/// The values with the scan's factors put in.
std::vector<double> scaled(const Hypothesis::Starts& starts, std::vector<double> values, const LinearScan::Gain& gain,
                           const EffectType& type) {
  const auto clamped = [&](std::size_t i, double value) {
    return std::clamp(value, type.parameters[i].low, type.parameters[i].high);
  };
  if (starts.scaled == -2) {  // time_varying_stiffness: a ratio
    values[1] = clamped(1, 1 + gain.first);
  } else if (starts.phase >= 0) {
    const auto phase = static_cast<std::size_t>(starts.phase);
    values[0] = clamped(0, std::hypot(gain.first, gain.second));
    values[phase] = std::atan2(gain.second, gain.first);
  } else if (starts.scaled >= 0) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string_view name = type.parameters[i].name;
      const bool torque = name.ends_with("_nm") || i == 0;  // both levels of asymmetric friction scale together
      if (torque) values[i] = clamped(i, values[i] * gain.first);
    }
  }
  return values;
}

}  // namespace

LinearScan::LinearScan(const SpectralRecord& record, const Whittle& whittle, const SpectralModel::Parts& parts,
                       const Whittle::Fit& fit, const Whittle::Roles& roles, const Spectrum& offset)
    : record_(record),
      response_(evaluated(record, parts, fit, offset, residual_)),
      density_(fit.floor.density(record.spectra.omega(), response_.gain.cwiseAbs2())),
      roles_(roles),
      whitened_(whittle.spectra(), response_, fit.floor, roles) {
  // d(residual)/dJ = -H^2 w^2 (T + ends), and so on: with the predicted angle at hand, H times its derivatives.
  const Spectrum predicted = record.angle - residual_;
  const Eigen::VectorXd& omega = record.spectra.omega();
  Eigen::MatrixXd columns(whitened_.rows(), 3);
  for (int power = 0; power < 3; ++power) {
    Spectrum sensitivity(omega.size());
    for (Eigen::Index k = 0; k < omega.size(); ++k) {
      sensitivity[k] = response_.gain[k] * std::pow(Complex(0, omega[k]), power) * predicted[k];
    }
    columns.col(power) = whitened_(sensitivity);
    columns.col(power) /= std::max(columns.col(power).norm(), 1e-300);
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  wheel_ = qr.householderQ() * Eigen::MatrixXd::Identity(whitened_.rows(), 3);
  left_ = whitened_(residual_);
  left_ -= wheel_ * (wheel_.transpose() * left_).eval();
}

Eigen::VectorXd LinearScan::cleaned(const std::vector<double>& torque_nm) const {
  Eigen::VectorXd rows = whitened_(response_.gain.cwiseProduct(record_.spectra.of(torque_nm)));
  rows -= wheel_ * (wheel_.transpose() * rows).eval();
  return rows;
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

std::vector<double> LinearScan::strongest_lines(std::size_t count) const {
  // Blocks of the fit have the finest lines; their power is summed on a grid of half their spacing.
  const Spectrum clean = whitened_.without_ends(residual_);
  double step = 0;
  for (const BlockSpectra::Bins& bins : record_.spectra.blocks()) {
    if (bins.block.role == Block::Role::kFit && bins.count > 2) step = record_.spectra.omega()[bins.first + 1];
  }
  if (!(step > 0)) return {};
  std::vector<double> power(static_cast<std::size_t>(2 * std::numbers::pi * kHighest_hz / step) + 2, 0.0);
  for (const BlockSpectra::Bins& bins : record_.spectra.blocks()) {
    if (bins.block.role != Block::Role::kFit) continue;
    for (Eigen::Index k = 1; k < bins.count; ++k) {
      const auto at = static_cast<std::size_t>(std::round(record_.spectra.omega()[bins.first + k] / step));
      power[std::min(at, power.size() - 1)] += std::norm(clean[bins.first + k]) / density_[bins.first + k];
    }
  }
  std::vector<double> lines;
  for (std::size_t i = 0; i < count; ++i) {
    const auto strongest = std::ranges::max_element(power);
    const auto at = static_cast<std::size_t>(strongest - power.begin());
    lines.push_back(static_cast<double>(at) * step / (2 * std::numbers::pi));
    for (std::size_t k = at > 2 ? at - 2 : 0; k < std::min(power.size(), at + 3); ++k) power[k] = 0;
  }
  return lines;
}

namespace {

/// Frequencies near the strongest lines of what is left, in steps that keep the phase over the whole record.
void spread_over_lines(const SpectralRecord& record, const LinearScan& scan, Hypothesis::Starts& starts) {
  const std::vector<double> unit = starts.values.front();
  starts.values.clear();
  const double step_hz = 0.4 / std::clamp(record.motion.time_s.back(), 4.0, 120.0);
  const double width_hz =
      0.6 * record.spectra.omega()[record.spectra.blocks().front().first + 1] / (2 * std::numbers::pi);
  for (const double line_hz : scan.strongest_lines(3)) {
    for (double f = line_hz - width_hz; f <= line_hz + width_hz; f += step_hz) {
      if (f < 0.05) continue;
      std::vector<double> values = unit;
      values[1] = f;
      starts.values.push_back(values);
    }
  }
}

Candidate tried(const Hypothesis& hypothesis, const SpectralRecord& record, const SearchOrigin& origin,
                const Hypothesis::Starts& starts, const std::vector<double>& values, std::vector<double>& first,
                std::vector<double>& second) {
  if (!hypothesis.acts()) return {0, values};
  const WheelArm wheel = wheel_of(origin.from);
  const auto torque = [&](const std::vector<double>& of, std::vector<double>& out) {
    hypothesis.torque(wheel, of.data(), record.record, record.motion, out);
  };
  torque(values, first);
  LinearScan::Gain gain;
  if (starts.phase >= 0) {
    std::vector<double> quarter = values;
    quarter[static_cast<std::size_t>(starts.phase)] += std::numbers::pi / 2;
    torque(quarter, second);
    gain = origin.scan.of(first, second);
  } else {
    gain = origin.scan.of(first);
  }
  // Nothing to scale: the gain counts as far as the factor wanted is one.
  if (starts.scaled == -1) {
    return {gain.first > 0 ? gain.nats / (1 + std::pow(std::log(gain.first), 2)) : 0.0, values};
  }
  const bool one_sided = starts.scaled >= 0 && starts.phase < 0 && hypothesis.type().parameters[0].low >= 0;
  if (one_sided && gain.first < 0) gain = {0, 0.01, 0};
  return {gain.nats, scaled(starts, values, gain, hypothesis.type())};
}

/// The most promising starting points of a hypothesis around one origin.
std::vector<Eigen::VectorXd> starting_points(const Hypothesis& hypothesis, const SpectralRecord& record,
                                             const SearchOrigin& origin) {
  Hypothesis::Starts starts = hypothesis.starts(wheel_of(origin.from), record.record, record.motion);
  if (starts.by_line) spread_over_lines(record, origin.scan, starts);
  std::vector<Candidate> candidates;
  std::vector<double> first(record.record.size());
  std::vector<double> second(record.record.size());
  for (const std::vector<double>& values : starts.values) {
    candidates.push_back(tried(hypothesis, record, origin, starts, values, first, second));
  }
  std::ranges::stable_sort(candidates, [](const Candidate& a, const Candidate& b) { return a.nats > b.nats; });
  if (hypothesis.acts() && candidates.size() > starts.keep) candidates.resize(starts.keep);
  std::vector<Eigen::VectorXd> points;
  for (const Candidate& one : candidates) {
    Eigen::VectorXd point(origin.from.size() + static_cast<Eigen::Index>(one.values.size()));
    point << origin.from, Eigen::Map<const Eigen::VectorXd>(one.values.data(), std::ssize(one.values));
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace

std::vector<const EffectType*> types_of(const SpectralModel::Parts& parts) {
  std::vector<const EffectType*> types;
  for (const Hypothesis* part : parts) types.push_back(&part->type());
  return types;
}

Whittle::Fit search(const Hypothesis& hypothesis, const SearchSetting& setting) {
  constexpr int kBudget = 150;
  constexpr std::size_t kFits = 3;
  SpectralModel::Parts parts = setting.parts;
  parts.push_back(&hypothesis);
  const std::vector<Fitted> fitted = fitted_parameters(setting.sim, setting.refit, types_of(parts));
  SpectralModel model(setting.record, parts, setting.offset);
  std::vector<Whittle::Fit> starts;
  for (const SearchOrigin& origin : setting.origins) {
    for (Eigen::VectorXd& point : starting_points(hypothesis, setting.record, origin)) {
      starts.emplace_back().x = std::move(point);
    }
  }
  const auto cost = [&](const Whittle::Fit& fit) { return fit.cost(setting.roles); };
  if (hypothesis.acts() && starts.size() > kFits) {
    for (Whittle::Fit& one : starts) {
      one = setting.whittle.judge(model, one.x, fitted, setting.roles, setting.slow);
    }
    std::ranges::sort(starts, {}, cost);
    starts.resize(kFits);
  }
  const auto refined = [&](const Whittle::Fit& from) {
    return setting.whittle.fit(model, from.x, fitted, setting.roles, setting.slow, kBudget);
  };
  for (Whittle::Fit& one : starts) one = refined(one);
  Whittle::Fit best = *std::ranges::min_element(starts, {}, cost);
  // A changed response is cheap to work out and its valleys are narrow: on until nothing is gained any more.
  constexpr int kAgain = 4;
  for (int again = 0; again < kAgain && !hypothesis.acts(); ++again) {
    Whittle::Fit next = refined(best);
    if (!(cost(next) < cost(best) - 0.1)) break;
    best = std::move(next);
  }
  const auto own = static_cast<std::ptrdiff_t>(hypothesis.type().parameters.size());
  const std::vector<double> found(best.x.end() - own, best.x.end());
  std::optional<Whittle::Fit> other;
  for (const std::vector<double>& values : hypothesis.missed(found, setting.record.motion)) {
    Eigen::VectorXd point = best.x;
    point << setting.origins.back().from, Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
    Whittle::Fit fit = setting.whittle.judge(model, point, fitted, setting.roles, setting.slow);
    if (!other || cost(fit) < cost(*other)) other = std::move(fit);
  }
  if (!other) return best;
  *other = refined(*other);
  return cost(*other) < cost(best) ? *other : best;
}

}  // namespace steerid
