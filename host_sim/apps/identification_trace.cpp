// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identification_trace.hpp"

#include <algorithm>
#include <cmath>

#include "apps/identification.hpp"
#include "log/csv_writer.hpp"

namespace steerid {
namespace {

constexpr int kMicroDigits = 6;  // stamps are whole microseconds

void write_parameter(CsvWriter& csv, const ParameterEstimate& published, const PortUnits& units) {
  const IdentifiedParameter parameter = from_published(published, units.parameter());
  // The firmware publishes whole micro-units: more digits would be invented.
  const int digits = std::max(0, kMicroDigits - static_cast<int>(std::lround(std::log10(units.parameter()))));
  csv.cell(parameter.value, digits).cell(parameter.sd, digits).cell(name(parameter.state));
}

}  // namespace

void write_trace(const std::filesystem::path& target, const FirmwareRun& run) {
  CsvWriter csv(target, {"time_s", "inertia_kgm2", "inertia_sd_kgm2", "inertia_state", "damping_nms_per_rad",
                         "damping_sd_nms_per_rad", "damping_state", "stiffness_nm_per_rad", "stiffness_sd_nm_per_rad",
                         "stiffness_state", "driver_state", "hands"});
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const Estimate& estimate = run.estimates[i];
    csv.cell(run.time_s[i], kMicroDigits);
    write_parameter(csv, estimate.inertia, run.units);
    write_parameter(csv, estimate.damping, run.units);
    write_parameter(csv, estimate.stiffness, run.units);
    const bool driven = run.units.steering_wheel();
    csv.cell(name(driven ? estimate.driver : DriverState::kUnknown));
    csv.cell(name(driven ? estimate.hands : HandCount::kUnknown)).end_row();
  }
  csv.commit();
}

}  // namespace steerid
