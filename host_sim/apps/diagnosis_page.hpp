// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page of `steerid diagnose`: the verdict in a sentence, the record beside the simulation before and after, the
// ranking, where the gap lies, how far it shrinks, the parameters and the next experiment, in this order.
#pragma once

#include <string>

#include "gap/diagnosis/diagnosis.hpp"
#include "plant/simulation.hpp"
#include "report/page.hpp"

namespace steerid {

struct DiagnosisPageInput {
  std::string record_name;      ///< as the reader knows it, for example the log's file name
  std::string simulation_name;  ///< likewise
  const gap::Diagnosis& diagnosis;
  const Simulation& given;  ///< the simulation before it met the record
};

[[nodiscard]] report::Page diagnosis_page(const DiagnosisPageInput& input);

}  // namespace steerid
