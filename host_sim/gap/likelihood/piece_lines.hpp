// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The Fourier lines of a record's torque and angle in short windowed pieces: what they hold in a narrow band, on
// average over the record. Pieces of 2 s at 100 Hz overlap by half; none spans a gap.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "log/record.hpp"

namespace steerid::gap {

inline constexpr std::size_t kPieceRows = 200;

/// Line k stands at k/kPieceRows of the sampling rate. White noise of variance v has E|line|^2 = v.
using EachPiece = std::function<void(const Eigen::VectorXcd& torque, const Eigen::VectorXcd& angle)>;

/// One value a row of the record in both.
void for_each_piece(const Record& record, const std::vector<double>& torque, const std::vector<double>& angle,
                    const EachPiece& visit);

}  // namespace steerid::gap
