// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/model/straightened_model.hpp"
#include "parallel/work_in_parallel.hpp"

namespace steerid::gap {
namespace {

/// Torques that are fitted together: their spectra, before the response.
using Family = std::vector<Spectrum>;

double largest(const std::vector<double>& x) {
  double most = 1e-12;
  for (const double value : x) most = std::max(most, std::abs(value));
  return most;
}

/// Torques of the angle and the rate, both over their largest value.
Family surface(const SpectralRecord& record) {
  const MeasuredMotion& motion = record.motion;
  const double angle = largest(motion.angle_rad);
  const double rate = largest(motion.rate_rad_s);
  Family out;
  std::vector<double> torque(motion.angle_rad.size());
  const auto add = [&](auto shape) {
    for (std::size_t i = 0; i < torque.size(); ++i) {
      torque[i] = shape(motion.angle_rad[i] / angle, motion.rate_rad_s[i] / rate);
    }
    out.push_back(record.made(torque));
  };
  add([](double q, double) { return q * q; });
  add([](double q, double) { return q * q * q; });
  add([](double q, double) { return std::abs(q); });
  add([](double q, double) { return std::max(q - 0.5, 0.0); });
  add([](double q, double) { return std::min(q + 0.5, 0.0); });
  add([](double, double v) { return v * v; });
  add([](double, double v) { return v * std::abs(v); });
  add([](double, double v) { return std::tanh(v / 0.05); });
  add([](double q, double v) { return q * q * v; });
  add([](double q, double v) { return q * v; });
  return out;
}

/// J, B, C, dry friction and a torque that change through the record.
Family course(const SpectralRecord& record) {
  const MeasuredMotion& motion = record.motion;
  const double length_s = std::max(motion.length_s(), 1e-9);
  Family out;
  const double rate = largest(motion.rate_rad_s);
  std::vector<double> torque(motion.angle_rad.size());
  std::vector<double> friction(motion.angle_rad.size());
  for (std::size_t i = 0; i < friction.size(); ++i) friction[i] = std::tanh(motion.rate_rad_s[i] / (0.05 * rate));
  const auto add = [&](const std::vector<double>& of, auto shape) {
    for (std::size_t i = 0; i < torque.size(); ++i) {
      torque[i] = shape(2 * (motion.time_s[i] - motion.time_s.front()) / length_s - 1) * of[i];
    }
    out.push_back(record.made(torque));
  };
  for (const auto* of : {&motion.angle_rad, &motion.rate_rad_s, &motion.acceleration_rad_s2}) {
    add(*of, [](double t) { return t; });
    add(*of, [](double t) { return 1.5 * t * t - 0.5; });
    add(*of, [](double t) { return t > 0 ? 1.0 : -1.0; });
  }
  add(friction, [](double t) { return t; });
  const std::vector<double> constant(torque.size(), 1.0);
  constexpr double kSettles = 3;  // times the half of the record: by then e^-6 is left
  add(constant, [](double t) { return std::exp(-kSettles * (t + 1)); });
  add(constant, [](double) { return 1.0; });
  add(constant, [](double t) { return t; });
  add(constant, [](double t) { return 1.5 * t * t - 0.5; });
  return out;
}

/// Power of a line over that of the torque sensor's noise from which on it speaks of a torque that drove the wheel. A
/// shape that holds the noise, which is in what is left, too, would explain it with the wrong sign. Of lines of noise
/// one in e^25 is as large.
constexpr double kAboveNoise = 25;

/// (i w)^p on the predicted angle, over the size that it has at 2 Hz.
Family dynamics(const SpectralRecord& record, const NoiseFloor& floor, const Spectrum& gain, Spectrum predicted) {
  const Eigen::VectorXd& omega = record.spectra.omega();
  for (Eigen::Index k = 0; k < omega.size(); ++k) {
    const double noise = std::norm(gain[k]) * floor.torque_variance;
    if (std::norm(predicted[k]) < kAboveNoise * noise) predicted[k] = 0;
  }
  Family out;
  for (const double power : {-0.5, 0.5, 1.5, 3.0, 4.0}) {
    Spectrum torque(omega.size());
    for (Eigen::Index k = 0; k < omega.size(); ++k) {
      const double w = omega[k] / (4 * std::numbers::pi);
      torque[k] = w > 0 ? std::pow(Complex(0, w), power) * predicted[k] : Complex(0);
    }
    out.push_back(std::move(torque));
  }
  return out;
}

/// Another gain of the driver's torque sensor, and the time by which it is late (the motor's gain follows from J, B and
/// C being free).
Family channel(const SpectralRecord& record, const NoiseFloor& floor) {
  Spectrum driver = record.spectra.of(record.record.torque_driver_nm);
  Spectrum late(driver.size());
  for (Eigen::Index k = 0; k < driver.size(); ++k) {
    if (std::norm(driver[k]) < kAboveNoise * floor.torque_variance) driver[k] = 0;
    late[k] = Complex(0, record.spectra.omega()[k]) * driver[k];
  }
  return {std::move(driver), std::move(late)};
}

}  // namespace

double rival_nats(const SpectralRecord& record, const Whittle& whittle, ResidualModel& model,
                  std::vector<Spectrum> slopes, const Whittle::Fit& at, const std::vector<Fitted>& fitted,
                  SlowTorque slow, unsigned threads) {
  StraightenedModel straight(model, at.x, fitted, std::move(slopes));
  const auto fit = [&](StraightenedModel& of, SlowTorque as) {
    constexpr int kBudget = 400;
    return whittle.fit(of, of.start(), of.fitted(), kFitted, as, kBudget);
  };
  const auto of = [](const Whittle::Fit& one, Block::Role role) { return one.misfit[static_cast<std::size_t>(role)]; };
  const Whittle::Fit alone = fit(straight, slow);
  double left = 0;  // what there is to explain
  for (const Block::Role role : kSeen) left += of(alone, role).chi - of(alone, role).lines;
  // Every family, and every one of its shapes by itself.
  std::vector<Family> offered;
  const Spectrum predicted = record.angle - straight.residual();
  for (const Family& family : {surface(record), course(record), dynamics(record, at.floor, straight.gain(), predicted),
                               channel(record, at.floor)}) {
    offered.push_back(family);
    for (const Spectrum& torque : family) offered.push_back({torque});
  }
  const double lines = at.over(kSeen).lines;
  const double among = std::log(static_cast<double>(offered.size()));
  std::vector<double> nats(offered.size());
  work_in_parallel(offered.size(), threads, [&](std::size_t i) {
    StraightenedModel beside = straight;
    beside.stand_beside(offered[i]);
    double by_fit = 0;
    double by_choice = 0;  // with the coefficients of the fitted blocks
    const auto gains = [&](const Whittle::Fit& with) {
      const double gained = alone.cost(kFitted) - with.cost(kFitted);
      if (gained <= by_fit) return;
      by_fit = gained;
      by_choice = of(alone, Block::Role::kChoose).cost - of(with, Block::Role::kChoose).cost;
    };
    gains(fit(beside, slow));
    // What follows a shape is no slow torque: what is left of that may be the usual one.
    if (slow == SlowTorque::kCause) gains(fit(beside, SlowTorque::kFloor));
    // A quarter of the record beside the half that it was fitted on: half the gain, if it is real.
    const double gained = 1.5 * std::min(by_fit, 2 * by_choice);
    const double price = static_cast<double>(offered[i].size()) * std::log(std::max(lines, 2.0)) / 2 + among;
    nats[i] = (gained - price) / (1 + std::max(0.0, left) / lines);
  });
  return std::max(0.0, std::ranges::max(nats));
}

}  // namespace steerid::gap
