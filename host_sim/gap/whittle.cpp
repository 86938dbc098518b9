#include "gap/whittle.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace steerid {
namespace {

bool among(const Whittle::Roles& roles, Block::Role role) { return std::ranges::find(roles, role) != roles.end(); }

double prior_cost(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  double cost = 0;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!(fitted[i].prior_sd > 0)) continue;
    const double off = (x[static_cast<Eigen::Index>(i)] - fitted[i].prior_mean) / fitted[i].prior_sd;
    cost += off * off / 2;
  }
  return cost;
}

Eigen::VectorXd within(Eigen::VectorXd x, const std::vector<Fitted>& fitted) {
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    auto& value = x[static_cast<Eigen::Index>(i)];
    value = std::clamp(value, fitted[i].low, fitted[i].high);
  }
  return x;
}

/// The whitened residual's derivatives by differences. `here`: the model's own rows at x, if they are known.
Eigen::MatrixXd slope_of(ResidualModel& model, const Eigen::VectorXd& x, const Eigen::VectorXd* here,
                         const Whittle::Whitened& whitened, const std::vector<Fitted>& fitted) {
  const auto count = static_cast<Eigen::Index>(fitted.size());
  Spectrum residual;
  Response response;
  Eigen::VectorXd rows;
  if (here == nullptr) {
    model.evaluate(x, residual, response);
    rows = whitened(residual);
    here = &rows;
  }
  Eigen::MatrixXd jacobian(whitened.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Fitted& one = fitted[static_cast<std::size_t>(i)];
    if (!(one.scale > 0)) {  // a choice, not a number
      jacobian.col(i).setZero();
      continue;
    }
    Eigen::VectorXd moved = x;
    const double h = difference_step(one, x[i]);
    moved[i] += h;
    model.evaluate(moved, residual, response);
    jacobian.col(i) = (whitened(residual) - *here) / h;
  }
  return jacobian;
}

}  // namespace

Whittle::Whitened::Whitened(const BlockSpectra& spectra, const Response& response, const NoiseFloor& floor,
                            const Roles& roles)
    : weight_(spectra.bins()) {
  const Eigen::VectorXd density = floor.density(spectra.omega(), response.gain.cwiseAbs2());
  weight_ = density.cwiseSqrt().cwiseInverse();
  const double highest = 2 * std::numbers::pi * kHighest_hz;
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    if (!among(roles, bins.block.role)) continue;
    weight_[bins.first] *= std::numbers::sqrt2 / 2;  // the line at zero is real: half a line
    const Eigen::Index n = bins.count;
    Eigen::MatrixXd ends(2 * n, kEnds);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index bin = bins.first + k;
      std::complex<double> term = weight_[bin] * response.ends[bin];
      for (int power = 0; power < kEnds; ++power) {
        ends(k, power) = term.real();
        ends(n + k, power) = term.imag();
        term *= std::complex<double>(0, spectra.omega()[bin] / highest);
      }
    }
    for (int power = 0; power < kEnds; ++power) ends.col(power).normalize();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(ends);
    parts_.push_back({bins, qr.householderQ() * Eigen::MatrixXd::Identity(2 * n, kEnds)});
    rows_ += 2 * n;
    lines_ += static_cast<double>(n) - 0.5 - kEnds / 2.0;
    sum_log_density_ += density.segment(bins.first, n).array().log().sum() - std::log(density[bins.first]) / 2;
  }
}

Eigen::VectorXd Whittle::Whitened::operator()(const Spectrum& signal) const {
  Eigen::VectorXd out(rows_);
  Eigen::Index at = 0;
  for (const Part& part : parts_) {
    const Eigen::Index n = part.bins.count;
    auto rows = out.segment(at, 2 * n);
    const auto weight = weight_.segment(part.bins.first, n);
    rows.head(n) = weight.cwiseProduct(signal.segment(part.bins.first, n).real());
    rows.tail(n) = weight.cwiseProduct(signal.segment(part.bins.first, n).imag());
    rows -= part.ends * (part.ends.transpose() * rows).eval();
    at += 2 * n;
  }
  return out;
}

double Whittle::slow_penalty(double share, SlowTorque slow) const {
  constexpr double kFloorShare = 0.022;
  constexpr double kCauseShare = 0.045;
  constexpr double kSlack = 0.003;
  constexpr double kMostShare = 0.25;  // beyond it the driver would be steering, not restless
  const double beyond = slow == SlowTorque::kFloor ? share - kFloorShare
                        : share > kMostShare       ? share - kMostShare
                                                   : kCauseShare - share;
  return beyond > 0 ? beyond * beyond / (2 * kSlack * kSlack) : 0;
}

Spectrum Whittle::Whitened::without_ends(const Spectrum& signal) const {
  Spectrum out = Spectrum::Zero(signal.size());
  const Eigen::VectorXd rows = (*this)(signal);
  Eigen::Index at = 0;
  for (const Part& part : parts_) {
    const Eigen::Index n = part.bins.count;
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index bin = part.bins.first + k;
      out[bin] = std::complex<double>(rows[at + k], rows[at + n + k]) / weight_[bin];
    }
    at += 2 * n;
  }
  return out;
}

/// The cost is worked out for sizes in steps of a fifth, on the lines below 2 Hz, where it makes a difference. The
/// ends' leakage would pass for slow torque, so it is taken out first, at a size near the one wanted.
double Whittle::fit_slow(const Spectrum& residual, const Response& response, const Roles& roles, SlowTorque slow,
                         NoiseFloor& floor) const {
  constexpr double kTop_rad_s = 2 * std::numbers::pi * 2.0;
  if (!(floor.slow_variance > 0)) {
    floor.slow_variance = std::pow((slow == SlowTorque::kFloor ? 0.01 : 0.07) * applied_rms_nm_, 2);
  }
  const Spectrum clean = Whitened(spectra_, response, floor, roles).without_ends(residual);
  double best = std::numeric_limits<double>::infinity();
  double penalty = 0;
  for (double share = 0.0007; share < 0.7; share *= 1.2) {
    const double variance = std::pow(share * applied_rms_nm_, 2);
    double cost = slow_penalty(share, slow);
    for (const BlockSpectra::Bins& bins : spectra_.blocks()) {
      if (!among(roles, bins.block.role)) continue;
      for (Eigen::Index k = 0; k < bins.count; ++k) {
        const Eigen::Index bin = bins.first + k;
        const double w = spectra_.omega()[bin];
        if (w > kTop_rad_s) break;
        const double slow_density = variance * floor.slow_shape(w / (2 * std::numbers::pi));
        const double density =
            floor.angle_variance + std::norm(response.gain[bin]) * (floor.torque_variance + slow_density);
        cost += (k == 0 ? 0.5 : 1.0) * (std::log(density) + std::norm(clean[bin]) / density);
      }
    }
    if (cost < best) {
      best = cost;
      floor.slow_variance = variance;
      penalty = slow_penalty(share, slow);
    }
  }
  return penalty;
}

Whittle::Fit Whittle::judge(ResidualModel& model, const Eigen::VectorXd& x, const std::vector<Fitted>& fitted,
                            const Roles& roles, SlowTorque slow) const {
  Fit out;
  out.x = x;
  out.floor = white_;
  Spectrum residual;
  Response response;
  model.evaluate(x, residual, response);
  fit_slow(residual, response, roles, slow, out.floor);
  out.penalty = prior_cost(x, fitted) + fit_slow(residual, response, roles, slow, out.floor);
  for (const Block::Role role : {Block::Role::kFit, Block::Role::kChoose, Block::Role::kReport}) {
    const Whitened whitened(spectra_, response, out.floor, {role});
    Misfit& misfit = out.misfit[static_cast<std::size_t>(role)];
    misfit.chi = whitened(residual).squaredNorm();
    misfit.cost = misfit.chi + whitened.sum_log_density();
    misfit.lines = whitened.lines();
  }
  return out;
}

Whittle::Fit Whittle::fit(ResidualModel& model, const Eigen::VectorXd& start, const std::vector<Fitted>& fitted,
                          const Roles& roles, SlowTorque slow, int budget, ResidualModel* slopes) const {
  const auto count = static_cast<Eigen::Index>(fitted.size());
  Eigen::VectorXd x = within(start, fitted);
  NoiseFloor floor = white_;
  Spectrum residual;
  Response response;
  Spectrum trial_residual;
  Response trial_response;
  int evaluations = 1;
  model.evaluate(x, residual, response);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  double damping = 1e-4;
  bool trust_slopes = true;
  constexpr int kRounds = 4;  // of a new floor
  for (int round = 0; round < kRounds; ++round) {
    fit_slow(residual, response, roles, slow, floor);
    const Whitened whitened(spectra_, response, floor, roles);
    const Eigen::VectorXd at_round = x;
    Eigen::VectorXd rows = whitened(residual);
    double cost = rows.squaredNorm() + prior_cost(x, fitted);
    for (int step = 0; step < 6 && evaluations < budget; ++step) {
      const bool own = slopes == nullptr || !trust_slopes;
      const Eigen::MatrixXd jacobian = slope_of(own ? model : *slopes, x, own ? &rows : nullptr, whitened, fitted);
      if (own) evaluations += static_cast<int>(count);
      information = 2 * jacobian.transpose() * jacobian;
      Eigen::VectorXd gradient = 2 * jacobian.transpose() * rows;
      for (Eigen::Index i = 0; i < count; ++i) {
        const Fitted& one = fitted[static_cast<std::size_t>(i)];
        if (!(one.prior_sd > 0)) continue;
        const double weight = 1 / (one.prior_sd * one.prior_sd);
        information(i, i) += weight;
        gradient[i] += weight * (x[i] - one.prior_mean);
      }
      bool moved_on = false;
      double gained = 0;
      for (int attempt = 0; attempt < 6 && evaluations < budget; ++attempt) {
        Eigen::MatrixXd damped = information;
        for (Eigen::Index i = 0; i < count; ++i) {
          const Fitted& one = fitted[static_cast<std::size_t>(i)];
          const bool choice = !(one.scale > 0);
          damped(i, i) += damping * information(i, i) + (choice ? 1.0 : 1e-6 / (one.scale * one.scale));
          const bool held = choice || (x[i] <= one.low && gradient[i] > 0) || (x[i] >= one.high && gradient[i] < 0);
          if (!held) continue;
          damped.row(i).setZero();
          damped.col(i).setZero();
          damped(i, i) = 1;
          gradient[i] = 0;
        }
        const Eigen::VectorXd next = within(x - damped.ldlt().solve(gradient), fitted);
        model.evaluate(next, trial_residual, trial_response);
        ++evaluations;
        const Eigen::VectorXd next_rows = whitened(trial_residual);
        const double next_cost = next_rows.squaredNorm() + prior_cost(next, fitted);
        if (next_cost < cost) {
          gained = cost - next_cost;
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
      if (!own && (!moved_on || gained < 0.5 + 1e-4 * cost)) {  // at the end of what the cheap slopes can find
        trust_slopes = false;
        continue;
      }
      if (!moved_on || gained < 0.01 + 1e-5 * cost) break;
    }
    if (evaluations >= budget) break;
    if (round > 0 && (x - at_round).cwiseAbs().maxCoeff() == 0) break;
  }
  Fit out = judge(model, x, fitted, roles, slow);
  out.information = information;
  out.evaluations = evaluations;
  return out;
}

}  // namespace steerid
