// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/simulate_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/option_kinds.hpp"

namespace steerid {
namespace {

bool is_number(const std::string& text) { return is_number_from(text, 0.0, 20.0); }

}  // namespace

std::string probe_complaint(const std::string& text) {
  std::error_code none;
  const bool a_file =
      text == "-" || (std::filesystem::exists(text, none) && !std::filesystem::is_directory(text, none));
  if (is_number(text) || a_file) return {};
  return fmt::format("expected Nm rms from 0 to 20 or the file of a probe, found {}, which is neither", text);
}

PlannedProbe planned_probe(const SimulateOptions& options, PlannedProbe usual) {
  if (is_number(options.probe)) {
    usual.multisine.rms_nm = std::stod(options.probe);
  } else if (!options.probe.empty()) {
    usual = load_probe(options.probe);
  }
  if (options.duration_s) usual.duration_s = *options.duration_s;
  return usual;
}

void write_simulated(const SimulateOptions& options, std::initializer_list<Channel> channels, const Record& record,
                     const std::vector<std::string>& comments) {
  // Digits: a microsecond, a tenth of a micronewton metre and a nanoradian, all far below any sensor.
  const auto digits = [](Channel channel) {
    const Quantity quantity = quantity_of(channel);
    return quantity == Quantity::kTime ? 6 : (quantity == Quantity::kTorque ? 7 : 9);
  };
  std::vector<std::string> columns;
  for (const Channel channel : channels) columns.emplace_back(contract_column(channel));
  const auto table = open_table(
      options.out, {.what = "record", .columns = columns, .comments = comments, .messages = options.messages});
  for (std::size_t i = 0; i < record.size(); ++i) {
    for (const Channel channel : channels) table->cell(values_of(record, channel)[i], digits(channel));
    table->end_row();
  }
  table->commit();
}

std::string estimate_text(const Estimate& estimate) {
  const auto text = [](std::string_view symbol, const ParameterEstimate& parameter, std::string_view unit) {
    return fmt::format("{} {:.4g} {} ({})", symbol, parameter.value_micro * 1e-6, unit, name(parameter.state));
  };
  return fmt::format("{}, {}, {}", text("J", estimate.inertia, "kg m2"), text("B", estimate.damping, "Nms/rad"),
                     text("C", estimate.stiffness, "Nm/rad"));
}

double rms_of(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace steerid
