// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A layout for PlotJuggler (3.x) that opens the file of --trace: J, B and C over time, each with its 95 % interval.
//
//   plotjuggler --layout LAYOUT.xml
#pragma once

#include <filesystem>

namespace steerid {

/// `trace` is named relative to the layout where it lies beside it. Throws BadInput where the file cannot be written.
void write_layout(const std::filesystem::path& target, const std::filesystem::path& trace);

}  // namespace steerid
