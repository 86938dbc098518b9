// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where free runs stay above the floor: fits of other kinds, in their place where they are much better.
//
// A free run knows everything but the torque that nobody measured. Where that moves the wheel otherwise than it would a
// linear one, there are two more kinds of fit:
//   carried   on the motion that the run carries and the measurement corrects (gap/model/carried_record.hpp): an
//             effect that depends smoothly on where the wheel is
//   moved     by runs with the slow torque in them (gap/model/slow_course.hpp): a wheel that sticks, has play or is let
//             go
// One of another kind is believed where it is better by 30 nats over the excess and J, B and C stay: with a stiffer
// spring an effect that undoes it follows the measurement wherever it goes.
#pragma once

#include "gap/comparison/comparison.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid {

/// Evaluations of a fit by free runs.
inline constexpr int kRunBudget = 30;
/// Of one on the measured motion.
inline constexpr int kMotionBudget = 150;

/// Whether the wheel sticks, with the candidate or what is there.
[[nodiscard]] bool sticks(const ComparedParts& there, const Candidate& one);

/// Whether the hand leaves.
[[nodiscard]] bool leaves(const ComparedParts& there, const Candidate& one);

/// The carried motion's fit in place of the candidate's, where that is better. Not where the wheel sticks.
void prefer_motion(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one);

/// A fit by runs with the slow torque in them in place of the candidate's, likewise. Some 200 runs, half of that where
/// the candidate has a course already.
void prefer_slow_course(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one);

}  // namespace steerid
