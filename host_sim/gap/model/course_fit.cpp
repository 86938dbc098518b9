// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/course_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

constexpr double kSupport = 2;  // of one coefficient, knots before its own and behind

}  // namespace

CourseFit::CourseFit(CourseRecord where, std::vector<Effect> effects, const WheelArm& wheel, const SlowPrior& prior)
    : where_(std::move(where)),
      wheel_(wheel),
      effects_(std::move(effects)),
      torque_(effect::unmeasured_torque),
      knots_(static_cast<Eigen::Index>(
                 std::ceil((where_.record.time_s.back() - where_.record.time_s.front()) / where_.knots_s)) +
             2),
      coefficient_variance_(prior.rms_nm * prior.rms_nm / kSplinePower),
      angle_variance_(prior.angle_variance_rad2) {
  const double forgotten_s = std::clamp(8 * memory_s(wheel), 2.0, 5.0);
  apart_ = static_cast<Eigen::Index>(std::ceil(forgotten_s / where_.knots_s + 2 * kSupport));
  torque_.at("knot_interval_s") = where_.knots_s;
  torque_.at("rms_nm") = prior.rms_nm;
  for (unsigned i = 0; i < threads_of(where_.threads); ++i)
    runs_.emplace_back(where_.record, where_.stretches, where_.between);
}

Eigen::VectorXd CourseFit::fit(Eigen::VectorXd course, int rounds) {
  constexpr int kHalvings = 6;
  constexpr double kWorth = 1e-3;
  std::vector<double> run = angle_with(course, runs_.front());
  double cost = cost_of(run, course);
  for (int round = 0; round < rounds && std::isfinite(cost); ++round) {
    const Eigen::VectorXd step = step_from(course, run);
    bool moved = false;
    const double before = cost;
    double share = 1;
    for (int halving = 0; halving < kHalvings && !moved; ++halving, share /= 2) {
      const Eigen::VectorXd next = course + share * step;
      std::vector<double> angle = angle_with(next, runs_.front());
      const double next_cost = cost_of(angle, next);
      if (!(next_cost < cost)) continue;
      course = next;
      run = std::move(angle);
      cost = next_cost;
      moved = true;
    }
    if (!moved || before - cost < kWorth * before) break;
  }
  return course;
}

Effect CourseFit::torque(const Eigen::VectorXd& course) const {
  Effect torque = torque_;
  torque.time_course_nm.assign(course.begin(), course.end());
  return torque;
}

std::vector<double> CourseFit::angle_of(const WheelArm& wheel, std::vector<Effect> effects,
                                        const Eigen::VectorXd& course, RestartedRun& run) const {
  effects.push_back(torque(course));
  const std::span<const double> angle = run(wheel, effects);
  if (!run.finite()) return {};
  return {angle.begin(), angle.end()};
}

std::vector<double> CourseFit::angle_with(const Eigen::VectorXd& course, RestartedRun& run) const {
  return angle_of(wheel_, effects_, course, run);
}

void CourseFit::share(std::size_t count, const std::function<void(std::size_t, RestartedRun&)>& task) {
  share_among(std::min(runs_.size(), count), count, [&](std::size_t worker, std::size_t i) { task(i, runs_[worker]); });
}

std::vector<double> CourseFit::slope(const std::vector<double>& run, const std::vector<double>& other,
                                     double step) const {
  std::vector<double> out(run.size(), 0.0);
  for (std::size_t i = 0; i < other.size(); ++i) {
    const double by = (other[i] - run[i]) / step;
    if (looks_at(i) && std::isfinite(by)) out[i] = by;
  }
  return out;
}

double CourseFit::rest(const std::vector<double>& run, std::size_t sample) const {
  const double rest = where_.record.angle_rad[sample] - run[sample];
  return looks_at(sample) && std::isfinite(rest) ? rest : 0;
}

double CourseFit::cost_of(const std::vector<double>& run, const Eigen::VectorXd& course) const {
  if (run.empty()) return std::numeric_limits<double>::infinity();
  double squares = 0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const double left = rest(run, i);
    squares += left * left;
  }
  return squares / angle_variance_ + course.squaredNorm() / coefficient_variance_;
}

/// The samples that a coefficient is taken to move, until one of the same group begins; no values yet.
CourseFit::Moved CourseFit::reach_of(Eigen::Index knot) const {
  const std::vector<double>& time_s = where_.record.time_s;
  const auto sample = [&](Eigen::Index k) {
    const double from_s = time_s.front() + (static_cast<double>(k) - kSupport) * where_.knots_s;
    return static_cast<std::size_t>(std::ranges::lower_bound(time_s, from_s) - time_s.begin());
  };
  Moved out{sample(knot), {}};
  out.by.resize(sample(knot + apart_) - out.first);
  return out;
}

std::vector<CourseFit::Moved> CourseFit::derivatives(const Eigen::VectorXd& course, const std::vector<double>& run) {
  const double h = 0.1 * std::sqrt(coefficient_variance_);
  std::vector<Moved> moved(static_cast<std::size_t>(knots_));
  share(static_cast<std::size_t>(std::min(apart_, knots_)), [&](std::size_t group, RestartedRun& own_run) {
    Eigen::VectorXd other = course;
    const auto first = static_cast<Eigen::Index>(group);
    for (Eigen::Index k = first; k < knots_; k += apart_) other[k] += h;
    const std::vector<double> by = slope(run, angle_with(other, own_run), h);
    for (Eigen::Index k = first; k < knots_; k += apart_) {
      Moved own = reach_of(k);
      for (std::size_t i = own.first; i < own.last(); ++i) own.by[i - own.first] = by[i];
      moved[static_cast<std::size_t>(k)] = std::move(own);
    }
  });
  return moved;
}

std::unique_ptr<const CourseFit::Information> CourseFit::information_of(const std::vector<Moved>& moved) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index k = 0; k < knots_; ++k) {
    const Moved& own = moved[static_cast<std::size_t>(k)];
    for (Eigen::Index m = k; m < std::min(knots_, k + apart_); ++m) {
      const Moved& with = moved[static_cast<std::size_t>(m)];
      double sum = 0;
      for (std::size_t i = with.first; i < std::min(own.last(), with.last()); ++i) sum += own.at(i) * with.at(i);
      sum /= angle_variance_;
      entries.emplace_back(k, m, m == k ? sum + 1 / coefficient_variance_ : sum);
      if (m != k) entries.emplace_back(m, k, sum);
    }
  }
  Eigen::SparseMatrix<double> information(knots_, knots_);
  information.setFromTriplets(entries.begin(), entries.end());
  return std::make_unique<const Information>(information);
}

Eigen::VectorXd CourseFit::along(const std::vector<Moved>& moved, const std::vector<double>& motion) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(knots_);
  for (Eigen::Index k = 0; k < knots_; ++k) {
    const Moved& own = moved[static_cast<std::size_t>(k)];
    for (std::size_t i = own.first; i < own.last(); ++i) out[k] += own.at(i) * motion[i] / angle_variance_;
  }
  return out;
}

Eigen::VectorXd CourseFit::step_from(const Eigen::VectorXd& course, const std::vector<double>& run) {
  const std::vector<Moved> moved = derivatives(course, run);
  std::vector<double> left(run.size());
  for (std::size_t i = 0; i < run.size(); ++i) left[i] = rest(run, i);
  return information_of(moved)->solve(along(moved, left) - course / coefficient_variance_);
}

CourseFit::Follows CourseFit::follows(const Eigen::VectorXd& course, std::span<const Beside> beside) {
  const std::vector<double> run = angle_with(course, runs_.front());
  Follows out{.course_nm = Eigen::MatrixXd::Zero(knots_, std::ssize(beside)), .angle_rad = {}};
  out.angle_rad.assign(beside.size(), std::vector<double>(where_.record.size(), 0.0));
  if (run.empty()) return out;
  const std::vector<Moved> moved = derivatives(course, run);
  const std::unique_ptr<const Information> information = information_of(moved);
  share(beside.size(), [&](std::size_t n, RestartedRun& own_run) {
    const auto& [wheel, effects, step] = beside[n];
    if (step == 0) return;
    const std::vector<double> other = angle_of(wheel, effects, course, own_run);
    const Eigen::VectorXd given_up = -information->solve(along(moved, slope(run, other, step)));
    out.course_nm.col(static_cast<Eigen::Index>(n)) = given_up;
    for (Eigen::Index k = 0; k < knots_; ++k) {
      const Moved& own = moved[static_cast<std::size_t>(k)];
      for (std::size_t i = own.first; i < own.last(); ++i) out.angle_rad[n][i] += own.at(i) * given_up[k];
    }
  });
  return out;
}

}  // namespace steerid::gap
