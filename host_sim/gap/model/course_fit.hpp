// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The course in time of a torque that no sensor sees, in the runs that it moves: a cubic spline by Gauss-Newton on the
// measured angle with the run's own derivatives, against a prior of the torque's size. What a coefficient moves is over
// when the wheel has forgotten it, so that coefficients that are far apart share a run: ten to twenty runs tell all
// derivatives.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "gap/model/restarted_run.hpp"
#include "plant/effects/effect.hpp"
#include "plant/torque_signal.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

/// What is known of the slow torque and of the angle before the record is looked at.
struct SlowPrior {
  double rms_nm = 0;
  double angle_variance_rad2 = 0;
};

/// The mean square of a uniform cubic spline over that of its coefficients.
inline constexpr double kSplinePower = 151.0 / 315.0;

/// What a course is looked for in.
struct CourseRecord {
  const Record& record;
  std::vector<RunStretch> stretches;
  TorqueSignal::Between between = TorqueSignal::Between::kBandLimited;
  double knots_s = 0.5;
  std::vector<char> use{};  ///< one a sample: whether it is looked at; empty: all of them
  unsigned threads = 1;     ///< that runs share (0: one a core)
};

/// The wheel and the effects with one number moved by `step`.
struct Beside {
  WheelArm wheel;
  std::vector<Effect> effects;
  double step = 0;  ///< 0: the number is held, and nothing follows it
};

class CourseFit {
 public:
  /// `effects` act besides.
  CourseFit(CourseRecord where, std::vector<Effect> effects, const WheelArm& wheel, const SlowPrior& prior);

  /// From a course on, one coefficient a knot. A run that diverges ends the search where it is.
  [[nodiscard]] Eigen::VectorXd fit(Eigen::VectorXd course, int rounds);

  /// How the best course moves with numbers that move the run, to first order: what they move is taken off it as far as
  /// a course can make it (variable projection; Golub and Pereyra, SIAM Journal on Numerical Analysis 10, 1973, in
  /// Kaufman's form, BIT 15, 1975).
  struct Follows {
    Eigen::MatrixXd course_nm;                   ///< a row a coefficient, a column a number
    std::vector<std::vector<double>> angle_rad;  ///< what of the run's motion that is: one a number, one value a sample
  };
  /// One a number.
  [[nodiscard]] Follows follows(const Eigen::VectorXd& course, std::span<const Beside> beside);

  /// Twice minus log of the posterior; infinite where the run diverges.
  [[nodiscard]] double cost(const Eigen::VectorXd& course) {
    return cost_of(angle_with(course, runs_.front()), course);
  }

  [[nodiscard]] Eigen::Index knots() const { return knots_; }
  [[nodiscard]] Effect torque(const Eigen::VectorXd& course) const;

 private:
  /// What a coefficient moves: the angle's derivative, one value a sample from `first` on.
  struct Moved {
    std::size_t first = 0;
    std::vector<double> by;
    [[nodiscard]] std::size_t last() const { return first + by.size(); }
    [[nodiscard]] double at(std::size_t sample) const { return by[sample - first]; }
  };

  /// One angle a sample; none where the run diverges.
  [[nodiscard]] std::vector<double> angle_with(const Eigen::VectorXd& course, RestartedRun& run) const;
  [[nodiscard]] std::vector<double> angle_of(const WheelArm& wheel, std::vector<Effect> effects,
                                             const Eigen::VectorXd& course, RestartedRun& run) const;
  /// Every task below `count`, each with a run that no other one has meanwhile.
  void share(std::size_t count, const std::function<void(std::size_t, RestartedRun&)>& task);
  /// How the angle moves from `run` to `other`, per `step`; zero where it is not known or not looked at.
  [[nodiscard]] std::vector<double> slope(const std::vector<double>& run, const std::vector<double>& other,
                                          double step) const;
  [[nodiscard]] double cost_of(const std::vector<double>& run, const Eigen::VectorXd& course) const;
  [[nodiscard]] bool looks_at(std::size_t sample) const { return where_.use.empty() || where_.use[sample] != 0; }
  /// Measured minus run; 0 where either is not known or not looked at.
  [[nodiscard]] double rest(const std::vector<double>& run, std::size_t sample) const;
  [[nodiscard]] Moved reach_of(Eigen::Index knot) const;
  [[nodiscard]] std::vector<Moved> derivatives(const Eigen::VectorXd& course, const std::vector<double>& run);
  /// The posterior's information of the coefficients, for one set of derivatives.
  using Information = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;
  [[nodiscard]] std::unique_ptr<const Information> information_of(const std::vector<Moved>& moved) const;
  /// What every coefficient moves, times a motion: over the angle's variance.
  [[nodiscard]] Eigen::VectorXd along(const std::vector<Moved>& moved, const std::vector<double>& motion) const;
  [[nodiscard]] Eigen::VectorXd step_from(const Eigen::VectorXd& course, const std::vector<double>& run);

  CourseRecord where_;
  WheelArm wheel_;
  std::vector<Effect> effects_;
  Effect torque_;                   // without a course
  std::vector<RestartedRun> runs_;  // one a thread
  Eigen::Index knots_;
  Eigen::Index apart_ = 1;  // knots between two of a group
  double coefficient_variance_;
  double angle_variance_;
};

}  // namespace steerid::gap
