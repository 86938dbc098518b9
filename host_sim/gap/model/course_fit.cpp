// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/course_fit.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

constexpr double kSupport = 2;  // of one coefficient, knots before its own and behind

}  // namespace

CourseFit::CourseFit(CourseRecord where, std::vector<Effect> effects, const WheelArm& wheel, const SlowPrior& prior)
    : where_(std::move(where)),
      wheel_(wheel),
      effects_(std::move(effects)),
      run_(where_.record, where_.stretches, where_.between),
      knots_(static_cast<Eigen::Index>(
                 std::ceil((where_.record.time_s.back() - where_.record.time_s.front()) / where_.knots_s)) +
             2),
      coefficient_variance_(prior.rms_nm * prior.rms_nm / kSplinePower),
      angle_variance_(prior.angle_variance_rad2) {
  const double forgotten_s = std::clamp(8 * memory_s(wheel), 2.0, 5.0);
  apart_ = static_cast<Eigen::Index>(std::ceil(forgotten_s / where_.knots_s + 2 * kSupport));
  effects_.emplace_back(effect::unmeasured_torque);
  effects_.back().at("knot_interval_s") = where_.knots_s;
  effects_.back().at("rms_nm") = prior.rms_nm;
}

Eigen::VectorXd CourseFit::fit(Eigen::VectorXd course, int rounds) {
  constexpr int kHalvings = 6;
  constexpr double kWorth = 1e-3;
  std::vector<double> run = angle_with(course);
  double cost = cost_of(run, course);
  for (int round = 0; round < rounds && std::isfinite(cost); ++round) {
    const Eigen::VectorXd step = step_from(course, run);
    bool moved = false;
    const double before = cost;
    double share = 1;
    for (int halving = 0; halving < kHalvings && !moved; ++halving, share /= 2) {
      const Eigen::VectorXd next = course + share * step;
      std::vector<double> angle = angle_with(next);
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
  Effect torque = effects_.back();
  torque.time_course_nm.assign(course.begin(), course.end());
  return torque;
}

std::vector<double> CourseFit::angle_with(const Eigen::VectorXd& course) {
  effects_.back().time_course_nm.assign(course.begin(), course.end());
  const std::span<const double> angle = run_(wheel_, effects_);
  return {angle.begin(), angle.end()};
}

double CourseFit::rest(const std::vector<double>& run, std::size_t sample) const {
  const double rest = where_.record.angle_rad[sample] - run[sample];
  return looks_at(sample) && std::isfinite(rest) ? rest : 0;
}

double CourseFit::cost_of(const std::vector<double>& run, const Eigen::VectorXd& course) const {
  if (!run_.finite()) return std::numeric_limits<double>::infinity();
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
  for (Eigen::Index group = 0; group < std::min(apart_, knots_); ++group) {
    Eigen::VectorXd other = course;
    for (Eigen::Index k = group; k < knots_; k += apart_) other[k] += h;
    const std::vector<double> angle = angle_with(other);
    for (Eigen::Index k = group; k < knots_; k += apart_) {
      Moved own = reach_of(k);
      for (std::size_t i = own.first; i < own.last(); ++i) {
        const double by = (angle[i] - run[i]) / h;
        own.by[i - own.first] = looks_at(i) && std::isfinite(by) ? by : 0;
      }
      moved[static_cast<std::size_t>(k)] = std::move(own);
    }
  }
  return moved;
}

Eigen::VectorXd CourseFit::step_from(const Eigen::VectorXd& course, const std::vector<double>& run) {
  const std::vector<Moved> moved = derivatives(course, run);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = -course / coefficient_variance_;
  for (Eigen::Index k = 0; k < knots_; ++k) {
    const Moved& own = moved[static_cast<std::size_t>(k)];
    for (std::size_t i = own.first; i < own.last(); ++i) right[k] += own.at(i) * rest(run, i) / angle_variance_;
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
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(information).solve(right);
}

}  // namespace steerid::gap
