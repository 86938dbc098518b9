// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/firmware_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "app/run_loop.hpp"
#include "app/task.hpp"
#include "backend/replayed.hpp"
#include "fit/column_settings.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "identifier/parameters.hpp"

namespace steerid {
namespace {

constexpr double kLargestAngle = 3.0;  // in the port's radians: its limits and resolution were chosen for such angles

double power_of_ten(double value) { return std::pow(10.0, value); }

template <class T>
FirmwareRun run(const Record& record, const PortUnits& units, double friction_nm) {
  ReplayedHal hal(record, units.torque_nm, units.angle_rad);
  const ClosedLoopSettings<T> column = column_with_friction<T>(friction_nm);
  IdentificationTask<T> task(kSteeringWheel<T>, InputSupervision::kSteeringWheel, Probe::kGentle, column);
  if (run_loop(hal, task) != Status::kOk) throw std::logic_error("a replayed record ended otherwise than by its end");
  FirmwareRun result{hal.estimates(), {}, units};
  const std::int64_t start_us = std::llround(record.time_s.front() * 1e6);  // the back end counts from the first row
  for (const std::int64_t time_us : hal.times_us()) {
    result.time_s.push_back(static_cast<double>(start_us + time_us) * 1e-6);
  }
  return result;
}

}  // namespace

PortUnits port_units_for(const Record& record, double inertia_kgm2) {
  const Prior<double> wheel;
  if (inertia_kgm2 >= wheel.lowest(kInertia) && inertia_kgm2 <= wheel.highest(kInertia)) return {};

  const double parameter = power_of_ten(std::round(std::log10(inertia_kgm2 / wheel.value(kInertia))));
  const auto [lowest, highest] = std::minmax_element(record.angle_rad.begin(), record.angle_rad.end());
  const double largest = std::max(std::abs(*lowest), std::abs(*highest));
  const double angle = power_of_ten(std::ceil(std::log10(largest / kLargestAngle)));
  return {parameter * angle, angle};
}

FirmwareRun run_firmware(const Record& record, Scalar scalar, const PortUnits& units, double friction_nm) {
  switch (scalar) {
    case Scalar::kFloat:
      return run<float>(record, units, friction_nm);
    case Scalar::kFixed:
      return run<Fixed>(record, units, friction_nm);
    case Scalar::kDouble:
      return run<double>(record, units, friction_nm);
  }
  throw std::logic_error("no such arithmetic");
}

}  // namespace steerid
