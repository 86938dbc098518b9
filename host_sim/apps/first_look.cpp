#include "apps/first_look.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fit/gauss_newton.hpp"

namespace steerid {
namespace {

BatchFit fit_with_offset(const Record& record) {
  FitOptions options;
  options.torque_offset = true;
  options.convergence_factor = false;
  return fit_batch(record, options);
}

/// An inertia without damping beside it may be a line in the noise that an undamped model rings along with.
bool shows_inertia(const BatchFit& fit) {
  return fit.inertia.state == ParameterState::kValid && fit.damping.state == ParameterState::kValid;
}

Record turned_round(Record record) {
  for (double& torque_nm : record.torque_driver_nm) torque_nm = -torque_nm;
  for (double& torque_nm : record.torque_motor_nm) torque_nm = -torque_nm;
  return record;
}

}  // namespace

FirstLook first_look(const Record& record, std::optional<bool> torque_offset) {
  FirstLook look;
  const BatchFit fit = fit_with_offset(record);
  const bool inertia = shows_inertia(fit);
  if (inertia) look.units = port_units_for(record, fit.inertia.value);
  if (!inertia && shows_inertia(fit_with_offset(turned_round(record)))) {
    look.notes.push_back(
        "with the torque turned round this record shows an inertia, as it stands it does not: if positive torque is "
        "to turn the wheel towards positive angles, use --sign -1");
  }
  if (torque_offset) {
    look.torque_offset = *torque_offset;
  } else if (fit.torque_offset && std::abs(fit.torque_offset->value) > kOffsetInSd * fit.torque_offset->sd) {
    look.torque_offset = true;
    look.notes.push_back(fmt::format(
        "a constant torque of {:.3g} +- {:.2g} Nm acts on this machine; the batch fit and the free runs allow for it "
        "(--torque-offset no forbids that)",
        fit.torque_offset->value, fit.torque_offset->sd));
  }
  return look;
}

}  // namespace steerid
