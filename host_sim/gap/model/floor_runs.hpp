// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The noise level of a simulation whose effects are not linear: what noise leaves behind a hardening spring, dry
// friction or backlash is not what it leaves behind the linear wheel. Free runs with torques drawn from the noise model
// are compared with the run without them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gap/likelihood/noise_floor.hpp"
#include "gap/model/restarted_run.hpp"

namespace steerid::gap {

/// rms of the angle that the floor leaves, rad: the angle sensor's noise, and the mean over a few drawn runs and the
/// whole record of what the drawn torques move. Nothing where a run diverges. `undisturbed_rad` is the simulation's own
/// run over the stretches. Costs some half a dozen free runs.
[[nodiscard]] std::optional<double> floor_by_runs_rad(const Simulation& simulation, const Record& record,
                                                      const std::vector<RunStretch>& stretches,
                                                      const std::vector<double>& undisturbed_rad,
                                                      const NoiseFloor& floor, std::uint64_t seed);

}  // namespace steerid::gap
