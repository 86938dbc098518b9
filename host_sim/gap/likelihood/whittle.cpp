// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/whittle.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "gap/hypotheses/slow_share.hpp"
#include "gap/likelihood/torque_lines.hpp"
#include "log/resample.hpp"

namespace steerid::gap {
namespace {

double prior_cost(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  double cost = 0;
  for (std::size_t i = 0; i < fitted.size(); ++i) cost += fitted[i].prior.cost(x[static_cast<Eigen::Index>(i)]);
  return cost;
}

/// Of the numbers of a given size.
double shift_cost(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  double cost = 0;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const Prior& prior = fitted[i].prior;
    if (prior.law == Prior::Law::kOfGivenSize) cost += prior.cost(x[static_cast<Eigen::Index>(i)]);
  }
  return cost;
}

Eigen::MatrixXd columns_of(const std::vector<Spectrum>& slopes, const Whittle::Whitened& whitened) {
  Eigen::MatrixXd jacobian(whitened.rows(), std::ssize(slopes));
  Eigen::Index column = 0;
  for (const Spectrum& along : slopes) jacobian.col(column++) = whitened(along);
  return jacobian;
}

/// Broyden's update: slopes that give what the residual did along the last step (Broyden, Mathematics of Computation
/// 19, 1965), in a metric that `scale` makes free of units.
void mend(Eigen::MatrixXd& jacobian, const Eigen::VectorXd& step, const Eigen::VectorXd& change,
          const Eigen::VectorXd& scale) {
  const Eigen::VectorXd dual = scale.cwiseProduct(step);
  const double length = dual.dot(step);
  if (length > 0) jacobian += (change - jacobian * step) * (dual / length).transpose();
}

/// What a step is solved from: J'J and J'r of the rows and the priors.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;

  NormalEquations(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& rows, const Eigen::VectorXd& x,
                  const std::vector<Fitted>& fitted)
      : matrix(2 * jacobian.transpose() * jacobian), gradient(2 * jacobian.transpose() * rows) {
    for (std::size_t k = 0; k < fitted.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      matrix(i, i) += fitted[k].prior.weight(x[i]);
      gradient[i] += fitted[k].prior.slope(x[i]);
    }
  }

  /// Where a damped step from x leads. A choice stays, and so does a number at a limit that it is pulled beyond, which
  /// is pulled no more from then on.
  [[nodiscard]] Eigen::VectorXd step(const Eigen::VectorXd& x, double damping, const std::vector<Fitted>& fitted) {
    Eigen::MatrixXd damped = matrix;
    for (std::size_t k = 0; k < fitted.size(); ++k) {
      const Fitted& one = fitted[k];
      const auto i = static_cast<Eigen::Index>(k);
      const bool choice = !(one.scale > 0);
      damped(i, i) += damping * matrix(i, i) + (choice ? 1.0 : 1e-6 / (one.scale * one.scale));
      const bool held = choice || (x[i] <= one.low && gradient[i] > 0) || (x[i] >= one.high && gradient[i] < 0);
      if (!held) continue;
      damped.row(i).setZero();
      damped.col(i).setZero();
      damped(i, i) = 1;
      gradient[i] = 0;
    }
    return within(x - damped.ldlt().solve(gradient), fitted);
  }
};

}  // namespace

std::vector<Spectrum> ResidualModel::residuals_at(std::span<const Eigen::VectorXd> points) {
  std::vector<Spectrum> all(points.size());
  Response response;
  for (std::size_t i = 0; i < points.size(); ++i) evaluate(points[i], all[i], response);
  return all;
}

std::vector<Spectrum> differences(ResidualModel& model, const Eigen::VectorXd& x, const Spectrum& here,
                                  const std::vector<Fitted>& fitted) {
  std::vector<Spectrum> along(fitted.size(), Spectrum::Zero(here.size()));
  std::vector<std::size_t> numbers;
  std::vector<Eigen::VectorXd> beside;
  std::vector<double> steps;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!(fitted[i].scale > 0)) continue;
    double& value = beside.emplace_back(x)[static_cast<Eigen::Index>(i)];
    steps.push_back(difference_step(fitted[i], value));
    value += steps.back();
    numbers.push_back(i);
  }
  const std::vector<Spectrum> moved = model.residuals_at(beside);
  for (std::size_t k = 0; k < numbers.size(); ++k) along[numbers[k]] = (moved[k] - here) / steps[k];
  return along;
}

std::vector<Spectrum> differences(ResidualModel& model, const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  Spectrum here;
  Response response;
  model.evaluate(x, here, response);
  return differences(model, x, here, fitted);
}

Eigen::VectorXd within(Eigen::VectorXd x, const std::vector<Fitted>& fitted) {
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    auto& value = x[static_cast<Eigen::Index>(i)];
    value = std::clamp(value, fitted[i].low, fitted[i].high);
  }
  return x;
}

double slow_penalty(double share, SlowTorque slow) {
  constexpr double kSlack = 0.003;
  constexpr double kDeviations = 1.7;  // by which the least that is a cause may be estimated too small for nothing
  const double beyond = slow == SlowTorque::kFloor   ? share - kUsualSlowShare
                        : share > kSteeringSlowShare ? share - kSteeringSlowShare
                                                     : kCauseSlowShare - kDeviations * kSlack - share;
  return beyond > 0 ? beyond * beyond / (2 * kSlack * kSlack) : 0;
}

namespace {

/// From noise that hardly changes within a block to noise that is nearly white up to its end at 1 Hz.
constexpr std::array kSlowColours = {SlowColour{0.1, 1},  SlowColour{0.2, 1}, SlowColour{0.4, 1},
                                     SlowColour{0.15, 2}, SlowColour{0.3, 2}, SlowColour{0.6, 2}};

/// What is left of a steering driver's torque falls with the square or with the fourth power of the frequency, as
/// behind two or four poles.
std::vector<SlowColour> colours_of(const NoiseFloor& floor) {
  if (!(floor.lowest_hz > 0)) return {kSlowColours.begin(), kSlowColours.end()};
  return {SlowColour{floor.lowest_hz, 2, false}, SlowColour{floor.lowest_hz, 4, false}};
}

}  // namespace

/// The ends' leakage would pass for slow torque, so it is taken out first, at a size near the one wanted. Colours are
/// compared at sizes in coarse steps, then the best one's size is found in steps of a fifth.
double Whittle::fit_slow(const Spectrum& residual, const Response& response, const Roles& roles, SlowTorque slow,
                         NoiseFloor& floor) const {
  constexpr double kCoarse = kSlowShareStep * kSlowShareStep * kSlowShareStep;
  if (!(floor.slow_variance > 0)) {
    floor.slow_variance = std::pow((slow == SlowTorque::kFloor ? 0.01 : 0.07) * applied_rms_nm_, 2);
  }
  const Whitened whitened(spectra_, response, floor, roles);
  const double top_hz = floor.slow_top_hz();
  const TorqueLines lines(spectra_, roles, floor, response, whitened.without_ends(residual).cwiseAbs2(),
                          whitened.known(spectra_, 2 * std::numbers::pi * top_hz), top_hz);
  double best = std::numeric_limits<double>::infinity();
  double best_share = kSmallestSlowShare;
  Eigen::ArrayXd density;
  const auto penalty = [&](double share) {
    if (!(floor.lowest_hz > 0)) return slow_penalty(share, slow);
    const double tail = share * applied_rms_nm_ / floor.steering_tail_nm;
    return slow_penalty(tail * kUsualSlowShare, SlowTorque::kFloor);  // known as well as what others have
  };
  const auto look = [&](double share) {
    const double cost = lines.cost(std::pow(share * applied_rms_nm_, 2) * density) + penalty(share);
    if (!(cost < best)) return false;
    best = cost;
    best_share = share;
    return true;
  };
  const auto take = [&](const SlowColour& colour) { density = kResampledRateHz / 2 * colour.density(lines.f_hz); };
  for (const SlowColour& colour : colours_of(floor)) {
    take(colour);
    for (double share = kSmallestSlowShare; share < kLargestSlowShare; share *= kCoarse) {
      if (look(share)) floor.slow_colour = colour;
    }
  }
  take(floor.slow_colour);
  for (const double share : {best_share / kSlowShareStep, best_share * kSlowShareStep}) look(share);
  floor.slow_variance = std::pow(best_share * applied_rms_nm_, 2);
  return penalty(best_share);
}

Eigen::MatrixXd Whittle::information(const Fit& fit, const std::vector<Spectrum>& slopes,
                                     const std::vector<Fitted>& fitted, const Roles& roles) const {
  const Whitened whitened(spectra_, fit.response, fit.floor, roles);
  return NormalEquations(columns_of(slopes, whitened), whitened(fit.residual), fit.x, fitted).matrix;
}

Whittle::Fit Whittle::judge(ResidualModel& model, const Eigen::VectorXd& x, const std::vector<Fitted>& fitted,
                            const Roles& roles, SlowTorque slow) const {
  Fit out{.x = x};
  model.evaluate(x, out.residual, out.response);
  return judged(std::move(out), fitted, roles, slow);
}

Whittle::Fit Whittle::judged(Fit fit, const std::vector<Fitted>& fitted, const Roles& roles, SlowTorque slow) const {
  fit.floor = white_;
  fit_slow(fit.residual, fit.response, roles, slow, fit.floor);
  fit.shift = shift_cost(fit.x, fitted);
  fit.penalty = prior_cost(fit.x, fitted) + fit_slow(fit.residual, fit.response, roles, slow, fit.floor);
  fit.misfit = Whitened(spectra_, fit.response, fit.floor, kAllRoles).misfits(fit.residual);
  return fit;
}

Whittle::Fit Whittle::fit(ResidualModel& model, const Eigen::VectorXd& start, const std::vector<Fitted>& fitted,
                          const Roles& roles, SlowTorque slow, int budget, const Slopes& slopes) const {
  const auto count = static_cast<Eigen::Index>(fitted.size());
  Eigen::VectorXd x = within(start, fitted);
  NoiseFloor floor = white_;
  Spectrum residual;
  Response response;
  Spectrum trial_residual;
  Response trial_response;
  int evaluations = 1;
  model.evaluate(x, residual, response);
  const auto here = [&] { return judged({.x = x, .residual = residual, .response = response}, fitted, roles, slow); };
  std::optional<Fit> begun;  // where the end is held to it
  if (slopes) begun = here();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  double damping = 1e-4;
  bool trust_slopes = true;
  // Of a new floor; more while it still changes. A fit by runs is begun again from where it ends, and a floor that is
  // known from above only would be sought where it is lower.
  constexpr int kRounds = 4;
  const int most_rounds = !slopes && !white_.at_most ? 20 : kRounds;
  constexpr double kSettled = 0.1;  // nats
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const double penalty = fit_slow(residual, response, roles, slow, floor);
    const Whitened whitened(spectra_, response, floor, roles);
    const Eigen::VectorXd at_round = x;
    Eigen::VectorXd rows = whitened(residual);
    double cost = rows.squaredNorm() + prior_cost(x, fitted);
    const double all = cost + whitened.sum_log_density() + penalty;
    if (round >= kRounds && std::abs(before - all) < kSettled) break;
    before = all;
    Eigen::MatrixXd jacobian;
    bool secant = false;  // the next step goes along the last ones' slopes, as what was evaluated since mends them
    for (int step = 0; step < 6 && evaluations < budget; step += secant ? 0 : 1) {
      const bool own = !slopes || !trust_slopes;
      if (!secant) {
        jacobian = columns_of(own ? differences(model, x, residual, fitted) : slopes(x, fitted), whitened);
        if (own) evaluations += static_cast<int>(count);
      }
      NormalEquations normal(jacobian, rows, x, fitted);
      if (!secant) information = normal.matrix;
      bool moved_on = false;
      double gained = 0;
      const int attempts = secant ? 2 : 6;
      for (int attempt = 0; attempt < attempts && evaluations < budget; ++attempt) {
        const Eigen::VectorXd next = normal.step(x, damping, fitted);
        model.evaluate(next, trial_residual, trial_response);
        ++evaluations;
        const Eigen::VectorXd next_rows = whitened(trial_residual);
        const double next_cost = next_rows.squaredNorm() + prior_cost(next, fitted);
        if (next_cost < cost) {
          gained = cost - next_cost;
          if (own) mend(jacobian, next - x, next_rows - rows, normal.matrix.diagonal());
          cost = next_cost;
          x = next;
          rows = next_rows;
          residual.swap(trial_residual);
          std::swap(response, trial_response);
          damping = std::max(damping / 10, 1e-7);
          moved_on = true;
          break;
        }
        damping = std::max(damping * 10, 1e-3);
      }
      if (!moved_on) damping = 1e-3;
      const bool much = moved_on && gained > 0.5 + 1e-4 * cost;
      if (!own && !much) {  // at the end of what the cheap slopes can find
        trust_slopes = false;
        continue;
      }
      if (!secant && (!moved_on || gained < 0.01 + 1e-5 * cost)) break;
      secant = own && much;
    }
    if (evaluations >= budget) break;
    if ((x - at_round).cwiseAbs().maxCoeff() == 0) break;
  }
  Fit end = here();
  if (begun && end.cost(roles) > begun->cost(roles)) end = std::move(*begun);
  end.information = information;
  return end;
}

}  // namespace steerid::gap
