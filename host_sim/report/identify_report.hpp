// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page of one identification: what the record holds, what J, B and C came out of it and in which state each was
// when, how the model runs free beside the measurement, and the amplitude curve of figure 7 (Lv et al. 2018).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/page.hpp"

namespace steerid::report {

struct Quantity {
  std::string label;
  std::string unit;
};

/// One parameter through the run. value, sd and the trace's time_s have equal lengths.
struct ParameterTrace {
  std::vector<double> value;
  std::vector<double> sd;
  std::vector<StateSpan> states;  ///< see state_spans()
};

struct ParameterAnswer {
  double value = 0;
  double sd = 0;      ///< one standard deviation; NaN when there is none
  std::string state;  ///< "valid", "holding", "not excited", ...
};

/// A parameter over time as the whole record shows it; of equal lengths, or empty.
struct SmoothedCourse {
  std::vector<double> time_s;
  std::vector<double> value;
  std::vector<double> sd;
};

struct IdentifiedParameter {
  std::string symbol;  ///< "J", "B" or "C"
  Quantity quantity;
  ParameterAnswer recursive;  ///< at the end of the record
  std::optional<ParameterAnswer> batch = {};
  std::optional<double> published = {};  ///< what others published about this machine
  ParameterTrace trace = {};
  SmoothedCourse smoothed = {};
};

/// Figure 7: amplitudes of the measured and the modelled output over frequency.
struct AmplitudeCurves {
  std::vector<double> frequency_hz;
  std::vector<double> measured;
  std::vector<double> model;
  double fit_percent = 0;
  double limit_hz = 5;  ///< the fit is taken up to here
};

/// What was told of the driver from `from` to `to`.
struct DriverSpan {
  double from = 0;
  double to = 0;
  std::string state;  ///< "hands_off", "relaxed", "braced", "unknown"
  std::string hands;  ///< "none", "one", "two", "unknown"
};

struct IdentifyReport {
  std::string record_name;  ///< as the reader knows it, for example the log's file name
  std::string subtitle;
  Quantity angle = {"Angle", "rad"};
  Quantity torque = {"Torque", "Nm"};

  // The record, of equal lengths; a channel that is absent is empty.
  std::vector<double> time_s;
  std::vector<double> torque_driver_nm;
  std::vector<double> torque_motor_nm;
  std::vector<double> torque_bar_nm = {};
  std::vector<double> torque_rim_nm = {};
  std::vector<double> angle_rad;

  std::vector<double> trace_time_s;
  IdentifiedParameter inertia{.symbol = "J", .quantity = {"Inertia", "kg m\u00b2"}, .recursive = {}};
  IdentifiedParameter damping{.symbol = "B", .quantity = {"Damping", "Nms/rad"}, .recursive = {}};
  IdentifiedParameter stiffness{.symbol = "C", .quantity = {"Stiffness", "Nm/rad"}, .recursive = {}};

  std::vector<DriverSpan> driver = {};  ///< in order, without a hole; empty where nothing is told of one

  std::optional<double> natural_frequency_hz;
  std::string natural_frequency_reason;  ///< why there is none
  std::optional<double> damping_ratio;

  std::vector<double> free_run_angle_rad;  ///< the model's own run on the record's torques; as long as time_s, or empty
  std::optional<double> free_run_nrmse;
  std::string fit_sentence;  ///< in place of the free run where one would lack the driver's own torque
  std::optional<AmplitudeCurves> amplitude;
  std::vector<Note> notes;
  std::vector<std::string> refused = {};   ///< why none of it is credible; empty when it may be
  std::vector<std::string> cautions = {};  ///< why it is to be taken with caution
};

Page identify_page(const IdentifyReport& report);

}  // namespace steerid::report
