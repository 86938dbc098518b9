// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identification_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/channel_words.hpp"

namespace steerid {
namespace {

std::string figure_line(const char* title, std::optional<double> value, const char* unit, const std::string& why_none) {
  if (!value) return fmt::format("  {:<18}{:>12}  {}\n", title, "none", why_none);
  return fmt::format("  {:<18}{:>12.4g}  {}\n", title, *value, unit);
}

const char* method_title(const std::string& method) {
  if (method == "recursive") return "recursive, last estimate of the firmware loop";
  if (method == "batch_instrumental_variables") return "batch, instrumental variables by the probe";
  if (method == "batch_by_torque_alone") return "batch, by the torque alone: sd holds what stays unexplained of it";
  return "batch, output-error Gauss-Newton";
}

/// What a run free of the measurement, or of what the driver does, misses.
std::string fit_lines(const Identification& found) {
  if (voluntary_torque_known(found.equation)) {
    return figure_line("amplitude fit", found.amplitude_fit_percent, "% up to 5 Hz", "no amplitude curve") +
           figure_line("free-run NRMSE", found.free_run_nrmse, "of the angle's standard deviation",
                       "free run diverges");
  }
  std::string text;
  if (found.driven) {
    text += fmt::format("  {:<18}{:>12.2g}  of the torque that the probe drives; {:.2g} by noise alone\n",
                        "probe-driven NRMSE", found.driven->nrmse, found.driven->by_noise);
  } else {
    text += fmt::format("  {:<18}{:>12}  no arm, or no probe that drives the wheel\n", "probe-driven NRMSE", "none");
  }
  return text + figure_line("unmeasured torque", found.unmeasured_torque_nm,
                            "Nm rms below 6.6 Hz, mostly the driver's own", "not known");
}

}  // namespace

/// A parameter that was not identified shows no number: its value is
/// the prior, and a reader would take it for a result; where the record sets a limit, that is shown.
std::string parameter_line(const char* title, const char* unit, const IdentifiedParameter& parameter) {
  if (!is_identified(parameter.state) || !std::isfinite(parameter.value)) {
    const std::string value = parameter.at_most ? fmt::format("<= {:.3g}", *parameter.at_most) : "-";
    return fmt::format("  {:<18}{:>12}{:>12}  {:<8}  {}\n", title, value, "-", unit, name(parameter.state));
  }
  return fmt::format("  {:<18}{:>12.5g}{:>12.2g}  {:<8}  {}\n", title, parameter.value, parameter.sd, unit,
                     name(parameter.state));
}

std::string identification_table(const Identification& found) {
  const FrequencyAnswer frequency = frequency_answer(found);
  std::string text = fmt::format("{}\n  {:<18}{:>12}{:>12}  {:<8}  {}\n", method_title(found.method), "parameter",
                                 "value", "sd", "unit", "state");
  text += fmt::format("  {:<18}{}\n", "equation", equation_words(found.equation));
  text += parameter_line("inertia J", "kg m2", found.inertia_kgm2);
  text += parameter_line("damping B", "Nms/rad", found.damping_nms_per_rad);
  text += parameter_line("stiffness C", "Nm/rad", found.stiffness_nm_per_rad);
  if (found.friction_nm) {
    text += fmt::format("  {:<18}{:>12.3g}{:>12.2g}  {:<8}  {}\n", "wheel's friction", found.friction_nm->value,
                        found.friction_nm->sd, "Nm", "above the torsion bar; nobody holds the wheel");
  }
  text += figure_line("natural frequency", frequency.hz, "Hz", frequency.reason);
  text += figure_line("damping ratio", frequency.damping_ratio, "", frequency.reason);
  return text + fit_lines(found);
}

}  // namespace steerid
