// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Drawn cases as files: what a diagnosis may see in one folder, what it must not see in one file.
//
//   CASES/case000/log.csv, sim.json     the record, and the simulation as it was before it met the record
//   KEY                                 {"case000":{"label":"reflex","effects":["reflex"],"plant":{...},..},..}
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "blind/drawn_case.hpp"

namespace steerid::blind {

[[nodiscard]] std::string case_name(std::size_t number);

/// The seed of one case of a set: cases do not depend on how many there are.
[[nodiscard]] std::uint64_t case_seed(std::uint64_t seed, std::size_t number);

/// Draws every case on all cores and writes it; the answer is the key's text. `done` is called from one thread at a
/// time with the number of cases that are finished. `held`: by a position loop, all of them. Throws BadInput where a
/// file cannot be written.
[[nodiscard]] std::string draw_and_write(std::span<const Contents> contents, std::uint64_t seed, bool held,
                                         const std::filesystem::path& cases,
                                         const std::function<void(std::size_t)>& done);

}  // namespace steerid::blind
