// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether an identification is credible: what stands above every number that `steerid identify` gives.
//
//   credible true    what is called valid is credible; a reason beside it asks for caution: an alternative moves a
//                    parameter out of its interval, by less than what makes it wrong
//   credible false   the record contradicts the model or its own columns: the values are wrong however small their
//                    deviations
//   credible null    the record holds nothing that the answer could be held against: it lacks the driver's own torque,
//                    and a probe that has driven anything; there is a reason to be cautious
//
// What decides: a doubt of the first look (first_look.hpp), and the alternatives of fit/model_check.hpp that move a
// parameter out of its interval and by more than 10 %. Where the driver's own torque is not measured, whether an arm
// explains what the probe has driven (fit/probe_misfit.hpp); without a probe a value can be valid only because the
// driver did next to nothing, and then the alternatives are tried with a driver's torque of zero.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/first_look.hpp"
#include "fit/model_check.hpp"
#include "fit/probe_misfit.hpp"
#include "port/equation.hpp"

namespace steerid {

struct Credibility {
  std::optional<bool> credible = true;
  std::vector<std::string> reasons;  ///< whole clauses, the strongest first; why not, or why with caution
  std::string next;                  ///< the command to run next; empty for none
};

/// What an answer is held against.
struct Evidence {
  ModelCheck check{};                  ///< of the model's alternatives, where all torque is known or taken for so
  std::optional<ProbeMisfit> probe{};  ///< where the driver's own torque is not known; nothing without a probe
  bool probe_recorded = false;         ///< a channel of it, which changes
  bool anything_valid = false;         ///< of the answer
  bool record_tells = false;           ///< a parameter is valid by the probe over the whole record
};

/// "dry friction of 0.2 Nm"
[[nodiscard]] std::string alternative_words(const Alternative& one);

/// `log` names the record in the next command.
[[nodiscard]] Credibility credibility(const std::string& log, Equation equation, const FirstLook& look,
                                      const Evidence& evidence);

/// "not credible: ...", "with caution: ..." and "next: ...", a line each; empty when there is nothing to say.
[[nodiscard]] std::string credibility_lines(const Credibility& credibility);

}  // namespace steerid
