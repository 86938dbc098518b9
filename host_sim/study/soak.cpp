// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/soak.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "app/task.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "parallel/work_in_parallel.hpp"
#include "study/soak_drive.hpp"

namespace steerid {
namespace {

constexpr Stretch kOrder[] = {Stretch::kExcited, Stretch::kQuiet, Stretch::kExcited, Stretch::kHeld,
                              Stretch::kFaulty,  Stretch::kZero,  Stretch::kFaulty};
constexpr std::uint64_t kTicks = 2'000;        ///< of a stretch
constexpr std::uint64_t kLongTicks = 180'000;  ///< of nothing, once in twenty times

double real(float x) { return static_cast<double>(x); }
double real(Fixed x) { return std::ldexp(x.mantissa(), x.exponent()); }

struct Sums {
  double updates = 0, unsound = 0, not_finite = 0, excited = 0, right = 0, valid = 0, overflows = 0;
  double least_d = std::numeric_limits<double>::infinity();
};

template <class Scalar>
bool all_finite(const WheelIdentifier<Scalar>& identifier) {
  const auto finite = [](const Vector3<Scalar>& v) {
    return std::isfinite(real(v(0))) && std::isfinite(real(v(1))) && std::isfinite(real(v(2)));
  };
  return finite(identifier.value()) && finite(identifier.standard_deviation()) &&
         std::isfinite(real(identifier.noise_nm()));
}

template <class Scalar>
void look(const IdentificationTask<Scalar>& task, Sums& sums) {
  const WheelIdentifier<Scalar>& identifier = task.identifier();
  sums.updates += 1;
  sums.unsound += !identifier.sound();
  sums.not_finite += !all_finite(identifier);
  sums.least_d = std::min(sums.least_d, real(identifier.steady().least_of_d()));
}

template <class Scalar>
bool right_again(const IdentificationTask<Scalar>& task) {
  const auto near = [&task](int i, double truth) {
    return std::abs(real(task.identifier().value()(i)) / truth - 1) < 0.05;
  };
  constexpr WheelArm kArm = SoakDrive::kArm;
  return task.valid() && near(kInertia, kArm.inertia_kgm2) && near(kDamping, kArm.damping_nms_per_rad) &&
         near(kStiffness, kArm.stiffness_nm_per_rad);
}

template <class Scalar>
Sums soak(std::uint64_t updates, std::uint64_t seed) {
  SoakDrive drive(seed);
  IdentificationTask<Scalar> task;
  Sums sums;
  std::uint64_t done = 0;
  for (std::size_t turn = 0; done < updates; ++turn) {
    const Stretch stretch = kOrder[turn % std::size(kOrder)];
    const std::uint64_t length = stretch == Stretch::kZero && drive.chance(20) ? kLongTicks : kTicks;
    for (std::uint64_t k = 0; k < length; ++k, ++done) {
      if (stretch == Stretch::kFaulty && drive.chance(4)) {
        task.idle();
      } else {
        task.take(drive.next(stretch));
      }
      look(task, sums);
    }
    if (stretch != Stretch::kExcited) continue;
    sums.excited += 1;
    sums.right += right_again(task);
  }
  return sums;
}

template <class Scalar>
Sums zeros(std::uint64_t updates) {
  IdentificationTask<Scalar> task;
  Sums sums;
  Sample sample;
  for (std::uint64_t k = 0; k < updates; ++k) {
    sample.stamp_us = static_cast<std::int64_t>(k) * kTickPeriodUs;
    task.take(sample);
    look(task, sums);
    sums.valid += task.valid();
  }
  return sums;
}

FoundTable table_of(const char* name, const char* title) {
  FoundTable table{name, title, "", {word_column("number", "number")}, {}};
  for (const FoundColumn& column : {number_column("hours", "hours", "h"), number_column("unsound", "unsound"),
                                    number_column("not_finite", "not finite"), number_column("least_d", "least D"),
                                    number_column("overflows", "overflows")}) {
    table.columns.push_back(column);
  }
  return table;
}

std::vector<report::Cell> row_of(const std::string& kind, const Sums& sums) {
  return {kind, sums.updates * kTickS / 3600, sums.unsound, sums.not_finite, sums.least_d, sums.overflows};
}

}  // namespace

Findings run_soak_study(const SoakStudy& study, const StudyProgress& at) {
  const std::uint64_t idle = study.updates / 5;
  std::array<Sums, 4> sums;
  // Only the fixed-point runs touch the image's one overflow counter, so that they follow each other on one thread.
  work_in_parallel(
      2, 0, [&](std::size_t done) { at(done, 2); },
      [&](std::size_t job) {
        if (job == 0) {
          sums[0] = soak<float>(study.updates, study.seed);
          sums[1] = zeros<float>(idle);
          return;
        }
        Fixed::clear_overflow_count();
        sums[2] = soak<Fixed>(study.updates, study.seed);
        sums[2].overflows = Fixed::overflow_count();
        Fixed::clear_overflow_count();
        sums[3] = zeros<Fixed>(idle);
        sums[3].overflows = Fixed::overflow_count();
      });

  Findings found;
  found.study = "soak";
  found.title = "Millions of updates, and hours of nothing";
  found.how = fmt::format(
      "{} updates of the firmware's task of each kind of number over excited, quiet, held, switched-off and faulty "
      "stretches, then {} of exactly zero input; seed {}.",
      study.updates, idle, study.seed);
  found.command = fmt::format("steerid study soak --updates {} --seed {}", study.updates, study.seed);
  FoundTable mixed = table_of("soak", "Mixed stretches");
  mixed.columns.push_back(number_column("excited", "excited stretches"));
  mixed.columns.push_back(number_column("right_percent", "of them right again", "%"));
  FoundTable nothing = table_of("zeros", "Exactly zero input from the start");
  nothing.columns.push_back(number_column("valid", "valid"));
  constexpr const char* kKinds[] = {"float", "fixed"};
  for (std::size_t i = 0; i < 2; ++i) {
    const Sums& one = sums[2 * i];
    const Sums& zero = sums[2 * i + 1];
    const std::string kind = kKinds[i];
    mixed.rows.push_back(row_of(kind, one));
    mixed.rows.back().insert(mixed.rows.back().end(), {one.excited, 100 * one.right / one.excited});
    nothing.rows.push_back(row_of(kind, zero));
    nothing.rows.back().emplace_back(zero.valid);
    found.asked.push_back(
        {kind + ": updates that leave a number that is not finite", "", one.not_finite + zero.not_finite, 0});
    found.asked.push_back({kind + ": updates that leave D not positive or a parameter outside its limits", "",
                           one.unsound + zero.unsound, 0});
    found.asked.push_back({kind + ": excited stretches that end right and valid", "%", 100 * one.right / one.excited,
                           95, AskedFigure::Limit::kAtLeast});
    found.asked.push_back({kind + ": updates called valid on exactly nothing", "", zero.valid, 0});
  }
  found.asked.push_back({"fixed: operations out of range", "", sums[2].overflows + sums[3].overflows, 0});
  found.tables = {std::move(mixed), std::move(nothing)};
  return found;
}

}  // namespace steerid
