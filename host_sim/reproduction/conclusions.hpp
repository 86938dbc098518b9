// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the experiment's numbers allow to be said. Every sentence of the page that judges is made here, from the numbers
// that stand beside it, and says the opposite when they do.
//
//   right    a parameter is right in a kind of record when at least half of its answers are valid, the error of all
//            answers is at most kVisible (10 % rms, the identifier's own limit), and the 95 % intervals of the valid
//            ones hold the truth as often as they claim: k of n, unless so few would happen by chance once in a hundred
//            (binomial)
//   works    a label works on a quantity when its analysis of variance is significant after Holm (correlations.hpp)
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "reproduction/experiment_results.hpp"

namespace steerid {

/// What keeps a parameter from being right.
enum class Fault { kNone, kSeldomValid, kError, kIntervals };
[[nodiscard]] Fault fault_of(const MeasuredErrors& errors, std::size_t parameter);

/// "C is right (0.6 % rms); J is off by 24 % rms; the 95 % intervals of B hold the truth in 42 % of its answers": of
/// each parameter what is worst over the tasks.
[[nodiscard]] std::string on_parameters(std::span<const MeasuredErrors> by_task);

/// Whether every parameter that is asked for is right in all tasks.
[[nodiscard]] bool right(std::span<const MeasuredErrors> by_task, std::span<const std::size_t> parameters);

inline constexpr double kPublishedFit_percent = 97;
[[nodiscard]] std::string on_fit(double pooled_percent);

/// The label's effect beside what the paper says of it (section VI.D and figure 10).
[[nodiscard]] std::string on_label(const LabelCorrelation& found);

/// The batch fit's errors by task, passive first.
[[nodiscard]] std::array<MeasuredErrors, 2> batch_errors(const std::vector<IdentifiedRecord>& records);

[[nodiscard]] std::string on_basin(double unit_share, double line_search_share);

/// What a bound of a task to the letter leaves unexcited.
[[nodiscard]] std::string on_excitation(const ExcitationRow& row);

/// How far the wheel turns in figure 5, beside what the motor's torque makes of the true stiffness.
[[nodiscard]] std::string on_figure_5(const ExperimentResults& results);

/// The headline's sentences.
[[nodiscard]] std::vector<std::string> conclusions(const ExperimentResults& results);

}  // namespace steerid
