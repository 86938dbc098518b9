// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/grasp.hpp"

#include <cmath>
#include <numbers>

namespace steerid {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kShareSpread = 0.1;
constexpr double kOpposedSpread_n = 2.0;
constexpr double kPull_n = 5.0;  // the weight of a hand and a light hold
constexpr double kPullOfTangential = 0.3;
constexpr double kPullSpread = 0.25;
constexpr double kCorner_hz = 0.3;

constexpr double clock(double hours) { return kTurn * (3.0 - hours) / 12.0; }

}  // namespace

std::span<const double> grip_angles(HandPosition hands) {
  static constexpr std::array kRight3{clock(3)};
  static constexpr std::array kRight12{clock(0)};
  static constexpr std::array kRight130{clock(1.5)};
  static constexpr std::array kBoth3And9{clock(3), clock(9)};
  static constexpr std::array kBoth12And6{clock(0), clock(6)};
  // "The locations of the hour and ten past the hour": ten minutes are where the 2 is.
  static constexpr std::array kBoth10And10{clock(2), clock(10)};
  switch (hands) {
    case HandPosition::kRight3:
      return kRight3;
    case HandPosition::kRight12:
      return kRight12;
    case HandPosition::kRight130:
      return kRight130;
    case HandPosition::kBoth3And9:
      return kBoth3And9;
    case HandPosition::kBoth12And6:
      return kBoth12And6;
    case HandPosition::kBoth10And10:
      return kBoth10And10;
  }
  return {};
}

double grasp_moment_nm(HandPosition hands, std::span<const GraspForce> forces, double angle_rad) {
  const std::span<const double> grips = grip_angles(hands);
  double moment = 0;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    const double phi = grips[i] + angle_rad;
    moment += kWheelRadius_m * (std::cos(phi) * forces[i].y_n - std::sin(phi) * forces[i].x_n);
  }
  return moment;
}

void Grasp::Course::next() {
  const SignalPoint from = to;
  to = noise.next();
  piece = between(from, to, kTickS);
}

Grasp::Grasp(HandPosition hands, std::uint64_t seed, std::uint64_t first_stream)
    : grips_(grip_angles(hands)),
      share_{SmoothNoise({.rms = kShareSpread, .corner_hz = kCorner_hz}, seed, first_stream), {}, {}},
      opposed_n_{SmoothNoise({.rms = kOpposedSpread_n, .corner_hz = kCorner_hz}, seed, first_stream + 1), {}, {}},
      pull_{Course{SmoothNoise({.rms = kPullSpread, .corner_hz = kCorner_hz}, seed, first_stream + 2), {}, {}},
            Course{SmoothNoise({.rms = kPullSpread, .corner_hz = kCorner_hz}, seed, first_stream + 3), {}, {}}} {
  next();
}

void Grasp::next() {
  share_.next();
  opposed_n_.next();
  for (Course& pull : pull_) pull.next();
}

std::array<GraspForce, 2> Grasp::at(double tau_s, double torque_nm, double angle_rad) const {
  std::array<double, 2> tangential{torque_nm / kWheelRadius_m, 0};
  if (hands() == 2) {
    const double share = 0.5 + share_.piece.at(tau_s);
    const double opposed = opposed_n_.piece.at(tau_s);
    tangential = {share * tangential[0] + opposed, (1 - share) * tangential[0] - opposed};
  }
  std::array<GraspForce, 2> forces{};
  for (std::size_t i = 0; i < hands(); ++i) {
    const double phi = grips_[i] + angle_rad;
    const double pull = (kPull_n + kPullOfTangential * std::abs(tangential[i])) * (1 + pull_[i].piece.at(tau_s));
    forces[i] = {-tangential[i] * std::sin(phi) - pull * std::cos(phi),
                 tangential[i] * std::cos(phi) - pull * std::sin(phi)};
  }
  return forces;
}

}  // namespace steerid
