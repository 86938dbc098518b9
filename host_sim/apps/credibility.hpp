// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether an identification is credible: what stands above every number that `steerid identify` gives.
//
//   credible true    what is called valid is credible; a reason beside it asks for caution
//   credible false   the record contradicts the model or its own columns: the values are wrong however small their
//                    deviations
//   credible null    the record holds nothing that the answer could be held against: it lacks the driver's own torque,
//                    and a probe
//
// What decides: a doubt of the first look (first_look.hpp), and the alternatives of fit/model_check.hpp that move a
// parameter out of its interval and by more than 10 %; where the driver's own torque is not measured, whether an arm
// explains what the probe has driven (fit/probe_misfit.hpp).
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

/// `log` names the record in the next command; `probe` is nothing without one, or where it is not needed.
[[nodiscard]] Credibility credibility(const std::string& log, Equation equation, const FirstLook& look,
                                      const ModelCheck& check, const std::optional<ProbeMisfit>& probe);

/// "not credible: ...", "with caution: ..." and "next: ...", a line each; empty when there is nothing to say.
[[nodiscard]] std::string credibility_lines(const Credibility& credibility);

}  // namespace steerid
