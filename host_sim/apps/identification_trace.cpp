// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identification_trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/identification.hpp"

namespace steerid {
namespace {

constexpr int kMicroDigits = 6;     // stamps are whole microseconds
constexpr double kHalfBand = 1.96;  // standard deviations of a 95 % interval

/// A parameter in the record's units, and how many digits it has: the firmware publishes whole micro-units.
struct Published {
  IdentifiedParameter parameter;
  int digits;

  Published(const ParameterEstimate& published, const PortUnits& units)
      : parameter(from_published(published, units.parameter())),
        digits(std::max(0, kMicroDigits - static_cast<int>(std::lround(std::log10(units.parameter()))))) {}
};

}  // namespace

void write_trace(const std::filesystem::path& target, const FirmwareRun& run, McapMessages messages) {
  const auto table = open_table(
      target, {.what = kTraceTable,
               .columns = {"time_s", "inertia_kgm2", "inertia_sd_kgm2", "inertia_state", "damping_nms_per_rad",
                           "damping_sd_nms_per_rad", "damping_state", "stiffness_nm_per_rad", "stiffness_sd_nm_per_rad",
                           "stiffness_state", "driver_state", "hands", "inertia_low_kgm2", "inertia_high_kgm2",
                           "damping_low_nms_per_rad", "damping_high_nms_per_rad", "stiffness_low_nm_per_rad",
                           "stiffness_high_nm_per_rad"},
               .messages = messages});
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const Estimate& estimate = run.estimates[i];
    table->cell(run.time_s[i], kMicroDigits);
    const std::array parameters = {Published(estimate.inertia, run.units), Published(estimate.damping, run.units),
                                   Published(estimate.stiffness, run.units)};
    for (const auto& [parameter, digits] : parameters) {
      table->cell(parameter.value, digits).cell(parameter.sd, digits).cell(name(parameter.state));
    }
    table->cell(name(estimate.driver)).cell(name(estimate.hands));
    for (const auto& [parameter, digits] : parameters) {
      for (const double side : {-1.0, 1.0}) table->cell(parameter.value + side * kHalfBand * parameter.sd, digits);
    }
    table->end_row();
  }
  table->commit();
}

}  // namespace steerid
