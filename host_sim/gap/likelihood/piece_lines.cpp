// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/piece_lines.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "log/record_quality.hpp"

namespace steerid::gap {
namespace {

/// The lines of one windowed piece of a channel, without its mean.
class PieceLines {
 public:
  PieceLines() : window_(kPieceRows), piece_(kPieceRows) {
    for (std::size_t i = 0; i < kPieceRows; ++i) {
      const double s = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / kPieceRows);
      window_[static_cast<Eigen::Index>(i)] =
          s * s * s * s;  // side lobes fall fast: the drive is 60 dB above the noise
    }
    window_ /= window_.norm();
  }

  void operator()(const double* samples, Eigen::VectorXcd& lines) {
    piece_ = Eigen::Map<const Eigen::VectorXd>(samples, kPieceRows);
    piece_.array() -= piece_.mean();
    piece_.array() *= window_.array();
    transform_.fwd(lines, piece_);
  }

 private:
  Eigen::FFT<double> transform_;
  Eigen::VectorXd window_;
  Eigen::VectorXd piece_;
};

}  // namespace

void for_each_piece(const Record& record, const std::vector<double>& torque, const std::vector<double>& angle,
                    const EachPiece& visit) {
  PieceLines lines_of;
  Eigen::VectorXcd torque_lines;
  Eigen::VectorXcd angle_lines;
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    for (std::size_t first = rows.begin; first + kPieceRows <= rows.end; first += kPieceRows / 2) {
      lines_of(&torque[first], torque_lines);
      lines_of(&angle[first], angle_lines);
      visit(torque_lines, angle_lines);
    }
  }
}

}  // namespace steerid::gap
