// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The machine-readable answer of `steerid identify --json`, schema "steerid.identify/1".
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "apps/identification.hpp"

namespace steerid {

/// {"schema":"steerid.identify/1","method":..,"inertia_kgm2":{"value":,"sd":,"state":},..} with the batch answer, when
/// there is one, under "batch" in the same form. What is not known is null, never left out; "natural_frequency_hz"
/// has a "reason" when its value is null.
nlohmann::ordered_json identification_json(const Identification& recursive, const std::optional<Identification>& batch);

/// {"value":,"sd":,"state":}; what is not finite is null.
nlohmann::ordered_json parameter_json(const IdentifiedParameter& parameter);

}  // namespace steerid
