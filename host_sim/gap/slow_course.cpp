#include "gap/slow_course.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "gap/restarted_run.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

constexpr double kKnots_s = 0.5;  // half the power of a torque at 1 Hz is lost; hardly any slow torque has some there
constexpr double kSupport_s = 2 * kKnots_s;     // of one coefficient, before its knot and behind
constexpr double kSplinePower = 151.0 / 315.0;  // of the spline, for coefficients of unit variance

class CourseFit {
 public:
  CourseFit(const SpectralRecord& record, std::vector<Effect> effects, const WheelArm& wheel, const SlowPrior& prior)
      : record_(record),
        wheel_(wheel),
        effects_(std::move(effects)),
        run_(record.record, record.stretches, record.between()),
        knots_(static_cast<Eigen::Index>(std::ceil(record.motion.time_s.back() / kKnots_s)) + 2),
        coefficient_variance_(prior.rms_nm * prior.rms_nm / kSplinePower),
        angle_variance_(prior.angle_variance_rad2) {
    // What a coefficient moves is over when the wheel has forgotten it.
    const double reach_s = std::clamp(8 * memory_s(wheel), 2.0, 5.0) + 2 * kSupport_s;
    apart_ = static_cast<Eigen::Index>(std::ceil(reach_s / kKnots_s));
    effects_.emplace_back(effect::unmeasured_torque);
    effects_.back().at("knot_interval_s") = kKnots_s;
    effects_.back().at("rms_nm") = prior.rms_nm;
  }

  Eigen::VectorXd fit(Eigen::VectorXd course, int rounds) {
    constexpr int kHalvings = 6;
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
      constexpr double kWorth = 1e-3;
      if (!moved || before - cost < kWorth * before) break;
    }
    return course;
  }

  [[nodiscard]] Eigen::Index knots() const { return knots_; }
  [[nodiscard]] Effect torque(const Eigen::VectorXd& course) const {
    Effect torque = effects_.back();
    torque.time_course_nm.assign(course.begin(), course.end());
    return torque;
  }

 private:
  std::vector<double> angle_with(const Eigen::VectorXd& course) {
    effects_.back().time_course_nm.assign(course.begin(), course.end());
    const std::span<const double> angle = run_(wheel_, effects_);
    return {angle.begin(), angle.end()};
  }

  /// Twice minus log of the posterior; infinite where the run diverges.
  [[nodiscard]] double cost_of(const std::vector<double>& run, const Eigen::VectorXd& course) const {
    if (!run_.finite()) return std::numeric_limits<double>::infinity();
    double squares = 0;
    for (std::size_t i = 0; i < run.size(); ++i) {
      const double rest = record_.record.angle_rad[i] - run[i];
      if (std::isfinite(rest)) squares += rest * rest;
    }
    return squares / angle_variance_ + course.squaredNorm() / coefficient_variance_;
  }

  /// The samples that a coefficient is taken to move: until one of the same group begins.
  struct Reach {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  [[nodiscard]] Reach reach(Eigen::Index knot) const {
    const auto sample = [&](Eigen::Index k) {
      const double from_s = static_cast<double>(k) * kKnots_s - kSupport_s;
      const auto at = std::ranges::lower_bound(record_.motion.time_s, from_s);
      return static_cast<std::size_t>(at - record_.motion.time_s.begin());
    };
    return {sample(knot), sample(knot + apart_)};
  }

  /// What a coefficient moves: the angle's derivative, one value a sample from `first` on.
  struct Moved {
    std::size_t first = 0;
    std::vector<double> by;
    [[nodiscard]] std::size_t last() const { return first + by.size(); }
    [[nodiscard]] double at(std::size_t sample) const { return by[sample - first]; }
  };

  /// One a coefficient, by differences. Those that are far apart move different samples, so that one run tells the
  /// derivatives to all of a group.
  [[nodiscard]] std::vector<Moved> derivatives(const Eigen::VectorXd& course, const std::vector<double>& run) {
    const double h = 0.1 * std::sqrt(coefficient_variance_);
    std::vector<Moved> moved(static_cast<std::size_t>(knots_));
    for (Eigen::Index group = 0; group < std::min(apart_, knots_); ++group) {
      Eigen::VectorXd other = course;
      for (Eigen::Index k = group; k < knots_; k += apart_) other[k] += h;
      const std::vector<double> angle = angle_with(other);
      for (Eigen::Index k = group; k < knots_; k += apart_) {
        const Reach within = reach(k);
        Moved& own = moved[static_cast<std::size_t>(k)];
        own.first = within.first;
        own.by.resize(within.last - within.first);
        for (std::size_t i = within.first; i < within.last; ++i) {
          const double by = (angle[i] - run[i]) / h;
          own.by[i - within.first] = std::isfinite(by) ? by : 0;
        }
      }
    }
    return moved;
  }

  /// The Gauss-Newton step.
  [[nodiscard]] Eigen::VectorXd step_from(const Eigen::VectorXd& course, const std::vector<double>& run) {
    const std::vector<Moved> moved = derivatives(course, run);
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = -course / coefficient_variance_;
    for (Eigen::Index k = 0; k < knots_; ++k) {
      const Moved& own = moved[static_cast<std::size_t>(k)];
      for (std::size_t i = own.first; i < own.last(); ++i) {
        const double rest = record_.record.angle_rad[i] - run[i];
        if (std::isfinite(rest)) right[k] += own.at(i) * rest / angle_variance_;
      }
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

  const SpectralRecord& record_;
  WheelArm wheel_;
  std::vector<Effect> effects_;  // the slow torque last
  RestartedRun run_;
  Eigen::Index knots_;
  Eigen::Index apart_ = 1;  // knots between two of a group
  double coefficient_variance_;
  double angle_variance_;
};

/// The spectrum of the linear wheel's angle under a torque alone, from rest.
Spectrum linear_response(const SpectralRecord& record, const WheelArm& wheel, const Effect& torque) {
  Record still = record.record;
  std::ranges::fill(still.torque_driver_nm, 0.0);
  std::ranges::fill(still.torque_motor_nm, 0.0);
  std::vector<RunStretch> stretches = record.stretches;
  for (RunStretch& stretch : stretches) stretch.initial = WheelState{};
  RestartedRun run(still, stretches, TorqueSignal::Between::kHeld);
  const std::span<const double> angle = run(wheel, std::span(&torque, 1));
  std::vector<double> moved(angle.begin(), angle.end());
  for (double& value : moved) value = std::isfinite(value) ? value : 0;
  return record.spectra.of(moved);
}

}  // namespace

SlowCourse slow_course(const SpectralRecord& record, const std::vector<const EffectType*>& types,
                       const std::vector<Effect>& fixed, const Eigen::VectorXd& x, const SlowPrior& prior,
                       const SlowCourse* from) {
  constexpr int kRounds = 4;
  constexpr int kMoreRounds = 2;
  const WheelArm wheel = wheel_of(x);
  CourseFit fit(record, effects_at(x, types, fixed), wheel, prior);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(fit.knots());
  if (from != nullptr) {
    start = Eigen::Map<const Eigen::VectorXd>(from->torque.time_course_nm.data(), fit.knots());
  }
  const Eigen::VectorXd course = fit.fit(std::move(start), from == nullptr ? kRounds : kMoreRounds);
  SlowCourse out{.torque = fit.torque(course), .response = {}};
  out.response = linear_response(record, wheel, out.torque);
  return out;
}

}  // namespace steerid
