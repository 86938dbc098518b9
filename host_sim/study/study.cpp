// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/study.hpp"

#include <numbers>

#include "parallel/work_in_parallel.hpp"
#include "study/cramer_rao.hpp"

namespace steerid {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Arm {
  const char* name;
  WheelArm wheel;
};

/// From lightly held to braced: the range of tables I and II of Lv et al. 2018.
constexpr Arm kArms[] = {{"relaxed", {0.06, 0.4, 2.0}}, {"nominal", {0.11, 1.5, 22.7}}, {"braced", {0.11, 2.1, 45.9}}};

template <class Change>
void add_cases(StudyPlan& plan, const std::string& noise, Change change) {
  for (const Arm& arm : kArms) {
    StudyCase one{arm.name, noise, {}};
    one.drive.wheel = arm.wheel;
    change(one.drive);
    plan.cases.push_back(one);
  }
}

}  // namespace

StudyPlan efficiency_study() {
  StudyPlan plan{"efficiency",
                 "Root mean square error over the Cramer-Rao bound",
                 {},
                 {Method::kBatch, Method::kRecursiveFloat, Method::kRecursiveDouble, Method::kStateVariableFilter,
                  Method::kArx, Method::kCentralDifferences}};
  add_cases(plan, "angle 0.03 degree", [](SteadyDrive& drive) { drive.angle_noise_rad = 0.03 * kDegree; });
  add_cases(plan, "angle 0.1 degree", [](SteadyDrive& drive) { drive.angle_noise_rad = 0.1 * kDegree; });
  return plan;
}

StudyPlan uncertainty_study() {
  StudyPlan plan{"uncertainty",
                 "Whether a stated standard deviation is one",
                 {},
                 {Method::kBatch, Method::kRecursiveFloat, Method::kRecursiveDouble}};
  const auto white = [](SteadyDrive& drive) { drive.angle_noise_rad = 0.03 * kDegree; };
  add_cases(plan, "white", white);
  add_cases(plan, "resolution 0.1 degree", [](SteadyDrive& drive) { drive.angle_step_rad = 0.1 * kDegree; });
  for (const int percent : {2, 10}) {
    add_cases(plan, "unmeasured torque " + std::to_string(percent) + " %", [&](SteadyDrive& drive) {
      white(drive);
      drive.unmeasured_torque_nm = 0.01 * percent * drive.probe_rms_nm;
    });
  }
  add_cases(plan, "unmeasured torque 10 % behind one low pass", [&](SteadyDrive& drive) {
    white(drive);
    drive.unmeasured_torque_nm = 0.1 * drive.probe_rms_nm;
    drive.unmeasured_low_passes = 1;
  });
  return plan;
}

std::vector<StudyPlan> all_studies() { return {efficiency_study(), uncertainty_study()}; }

StudyResult run_study(const StudyPlan& plan, std::size_t drives, std::uint64_t seed, unsigned threads,
                      const std::function<void(std::size_t done)>& at_drive) {
  using Answers = std::vector<std::optional<MethodAnswer>>;
  const std::size_t methods = plan.methods.size();
  std::vector<Answers> answers(plan.cases.size() * methods, Answers(drives));
  work_in_parallel(plan.cases.size() * drives, threads, at_drive, [&](std::size_t job) {
    const std::size_t which = job / drives;
    const std::size_t number = job % drives;
    // Every case has noise of its own; a study of more drives begins with those of a smaller one.
    const Record record = record_of(plan.cases[which].drive, seed, number * plan.cases.size() + which);
    for (std::size_t m = 0; m < methods; ++m) answers[which * methods + m][number] = estimate(plan.methods[m], record);
  });

  StudyResult result{plan, drives, seed, {}};
  for (std::size_t which = 0; which < plan.cases.size(); ++which) {
    CaseResult one{plan.cases[which], {}};
    const SteadyDrive& drive = one.what.drive;
    const Eigen::Vector3d truth(drive.wheel.inertia_kgm2, drive.wheel.damping_nms_per_rad,
                                drive.wheel.stiffness_nm_per_rad);
    const Eigen::Matrix3d bound = cramer_rao_bound(drive);
    for (std::size_t m = 0; m < methods; ++m) one.scores.push_back(score(truth, bound, answers[which * methods + m]));
    result.cases.push_back(one);
  }
  return result;
}

}  // namespace steerid
