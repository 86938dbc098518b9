// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What an effect of the plant does on a motion that is known: its own law, sample by sample. Where it is divided and
// has states of its own (an arm behind a gap), these are linear in themselves within a region, and are led along the
// motion by their transition over a sample; regions change at samples, and a rate that jumps there is a torque of one
// sample.
#pragma once

#include <vector>

#include "gap/hypotheses/measured_motion.hpp"
#include "log/record.hpp"
#include "plant/effects/effect.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

/// The torque beside that of `wheel` and the applied one, Nm, one value a sample of `motion` into `torque_nm`, which
/// has the record's size.
void torque_on_motion(PlantEffect& effect, const WheelArm& wheel, const Record& record, const MeasuredMotion& motion,
                      std::vector<double>& torque_nm);

}  // namespace steerid::gap
