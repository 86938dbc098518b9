#include "apps/first_look.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fit/gauss_newton.hpp"
#include "fit/sign_check.hpp"

namespace steerid {
namespace {

constexpr double kHardlyAnything = 0.5;  // of the angle's power left unexplained

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

/// What is to be said of the signs; nothing when they seem right.
std::string sign_words(const SignCheck& check) {
  const bool both = check.torque_driver && check.torque_motor;
  const char* channels = both ? "both torques" : (check.torque_driver ? "torque_driver" : "torque_motor");
  const char* option = both ? "-1" : (check.torque_driver ? "torque_driver=-1" : "torque_motor=-1");
  return fmt::format(
      "{} seem{} to have the wrong sign: as the record stands the best wheel leaves {:.2g} % of the angle's power "
      "unexplained, turned round {:.2g} %. Positive driver's torque turns the wheel towards positive angles, positive "
      "motor torque turns it back; if the log is written otherwise, use --sign {}",
      channels, both ? "" : "s", 100 * check.unexplained, 100 * check.unexplained_turned, option);
}

}  // namespace

FirstLook first_look(const Record& record, std::optional<bool> torque_offset) {
  FirstLook look;
  const BatchFit fit = fit_with_offset(record);
  const bool inertia = shows_inertia(fit);
  if (inertia) look.units = port_units_for(record, fit.inertia.value);
  const SignCheck signs = check_signs(record, torque_offset.value_or(true));
  if (signs.doubtful()) {
    look.doubt = sign_words(signs);
  } else if (!inertia && signs.unexplained > kHardlyAnything && shows_inertia(fit_with_offset(turned_round(record)))) {
    look.notes.push_back(
        "with the torque turned round this record shows an inertia, as it stands it does not: if positive torque is to "
        "turn the wheel towards positive angles, use --sign -1");
  } else if (signs.unexplained > kHardlyAnything) {
    look.notes.push_back(
        fmt::format("no wheel explains more than {:.3g} % of this record's angle, whichever way its torques are "
                    "turned: what follows "
                    "is worth little. Are columns and units right, and is all torque in the log?",
                    100 * (1 - signs.unexplained)));
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
