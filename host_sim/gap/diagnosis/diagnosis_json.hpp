// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// diagnosis.json, schema steerid.diagnosis/1: the machine-readable answer of `steerid diagnose`.
//
// Beside the contract's keys: "notes" (sentences), "axes" (all that was localised), "gap"/"torque" (the shrinkage in
// torque), "surrogate" (true when the causes stand in for something unknown) and every cause's "ci95". A number that
// is not finite is null.
#pragma once

#include <nlohmann/json.hpp>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/together.hpp"

namespace steerid::gap {

[[nodiscard]] nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis);

/// What several records of a wheel say together: what diagnosis.json of the first one holds beside its own answer.
///   "records": one a record, with what is its own; "together": every number in all of them, and whether it differs
[[nodiscard]] nlohmann::ordered_json together_json(const Together& together, std::span<const NamedRecord> records);

}  // namespace steerid::gap
