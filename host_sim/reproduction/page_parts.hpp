// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The sections of the experiment's page, each in a file of its own, in the order of the page.
#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>
#include <utility>

#include "report/page.hpp"
#include "reproduction/experiment_results.hpp"

namespace steerid::page {

inline constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// "3 o'clock", as a reader says it.
[[nodiscard]] std::string spoken(HandPosition hands);
[[nodiscard]] std::string spoken(TaskKind task, HandPosition hands);
[[nodiscard]] inline std::string percent(double share, int digits = 1) {
  return fmt::format("{:.{}f} %", 100 * share, digits);
}

/// "27.8 [13.1, 80.2]": median and ends unless they are one, how many of how many when they are fewer; a dash for none.
[[nodiscard]] std::string written(const Spread& spread, int decimals, std::size_t of);

/// Columns of a table: words, and numbers in so many digits.
[[nodiscard]] inline report::Column words(std::string label, std::string unit = {}) {
  return {.label = std::move(label), .unit = std::move(unit), .numeric = false};
}
[[nodiscard]] inline report::Column numbers(std::string label, std::string unit, int digits) {
  return {.label = std::move(label), .unit = std::move(unit), .digits = digits};
}

void add_put_in(report::Page& page, const ExperimentResults& results);          ///< what was put in, what was found
void add_tables(report::Page& page, const ExperimentResults& results);          ///< tables I and II, equation 5
void add_contradictions(report::Page& page, const ExperimentResults& results);  ///< of the paper with itself
void add_records(report::Page& page, const ExperimentResults& results);         ///< figures 5 and 6, section IV.C
void add_accuracy(report::Page& page, const ExperimentResults& results);        ///< figure 7
void add_subjects(report::Page& page, const ExperimentResults& results);        ///< figures 8 and 9
void add_correlations(report::Page& page, const ExperimentResults& results);    ///< figure 10
void add_excitation(report::Page& page, const ExperimentResults& results);      ///< Cramer-Rao bounds
void add_convergence(report::Page& page, const ExperimentResults& results);     ///< section III.C
void add_driver_state(report::Page& page, const ExperimentResults& results);    ///< for the take-over function

}  // namespace steerid::page
