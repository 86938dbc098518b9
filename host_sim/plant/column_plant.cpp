// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/column_plant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steerid {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

int sign(double x) { return (x > 0) - (x < 0); }

}  // namespace

ColumnInputs ColumnInputs::shifted(double tau_s) const {
  return {voluntary_nm.shifted(tau_s), probe_nm.shifted(tau_s),    road_nm.shifted(tau_s),
          inertia_kgm2.shifted(tau_s), damping_nms.shifted(tau_s), stiffness_nm.shifted(tau_s)};
}

void ColumnPlant::start(const ColumnState& state) {
  x_ = {state.angle_rad, state.rate_rad_s, state.column_angle_rad, state.column_rate_rad_s};
  regime_ = {.slip = {sign(state.rate_rad_s), sign(state.column_rate_rad_s)}};
}

double ColumnPlant::bar_nm(const State& x) const {
  return column_.bar_stiffness_nm_per_rad * (x[0] - x[2]) + column_.bar_damping_nms_per_rad * (x[1] - x[3]);
}

/// Assist and probe together, before the limit.
double ColumnPlant::asked_of_motor_nm(double tau, double bar) const {
  const double beyond = regime_.assist == 0 ? 0 : bar - regime_.assist * column_.assist_dead_zone_nm;
  return column_.assist_gain * beyond + inputs_.probe_nm.at(tau);
}

double ColumnPlant::motor_nm(double tau, double bar) const {
  return regime_.clip == 0 ? asked_of_motor_nm(tau, bar) : regime_.clip * column_.motor_limit_nm;
}

/// All that acts on a mass but its friction.
double ColumnPlant::pull_nm(Mass mass, double tau, const State& x) const {
  const double bar = bar_nm(x);
  if (mass == kWheel) {
    return inputs_.voluntary_nm.at(tau) - bar - inputs_.damping_nms.at(tau) * x[1] -
           inputs_.stiffness_nm.at(tau) * x[0];
  }
  return bar + motor_nm(tau, bar) + inputs_.road_nm.at(tau) - column_.aligning_stiffness_nm_per_rad * x[2] -
         column_.column_damping_nms_per_rad * x[3];
}

/// Of a mass on which `pull` acts besides.
double ColumnPlant::friction_nm(Mass mass, double pull) const {
  return held(mass) ? pull : regime_.slip[mass] * dry_nm(mass);
}

double ColumnPlant::acceleration_rad_s2(Mass mass, double tau, const State& x) const {
  const double pull = pull_nm(mass, tau, x);
  const double inertia = mass == kWheel ? inputs_.inertia_kgm2.at(tau) : column_.column_inertia_kgm2;
  return (pull - friction_nm(mass, pull)) / inertia;
}

ColumnPlant::State ColumnPlant::slope(double tau, const State& x) const {
  return {x[1], acceleration_rad_s2(kWheel, tau, x), x[3], acceleration_rad_s2(kColumn, tau, x)};
}

/// Runge and Kutta's step of h from `tau` on, in the present regime.
ColumnPlant::State ColumnPlant::after(double tau, double h) const {
  const auto from = [&](const State& k, double s) {
    State x = x_;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += s * k[i];
    return x;
  };
  const State k1 = slope(tau, x_);
  const State k2 = slope(tau + h / 2, from(k1, h / 2));
  const State k3 = slope(tau + h / 2, from(k2, h / 2));
  const State k4 = slope(tau + h, from(k3, h));
  State next = x_;
  for (std::size_t i = 0; i < next.size(); ++i) next[i] += h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
  return next;
}

ColumnPlant::Margins ColumnPlant::margins(double tau, const State& x) const {
  Margins margins{kFar, kFar, {kFar, kFar}};
  const double bar = bar_nm(x);
  if (kinked()) {
    const double edge = column_.assist_dead_zone_nm;
    margins.assist = regime_.assist == 0 ? edge - std::abs(bar) : regime_.assist * bar - edge;
  }
  const double asked = asked_of_motor_nm(tau, bar);
  margins.clip =
      regime_.clip == 0 ? column_.motor_limit_nm - std::abs(asked) : regime_.clip * asked - column_.motor_limit_nm;
  for (const Mass mass : kMasses) {
    if (dry_nm(mass) == 0) continue;
    margins.slip[mass] =
        held(mass) ? dry_nm(mass) - std::abs(pull_nm(mass, tau, x)) : regime_.slip[mass] * x[rate_of(mass)];
  }
  return margins;
}

/// Inputs may jump between two stretches.
void ColumnPlant::classify() {
  const double bar = bar_nm(x_);
  regime_.assist = kinked() && std::abs(bar) <= column_.assist_dead_zone_nm ? 0 : kinked() ? sign(bar) : 1;
  const double asked = asked_of_motor_nm(0, bar);
  regime_.clip = std::abs(asked) > column_.motor_limit_nm ? sign(asked) : 0;
  for (const Mass mass : kMasses) {
    if (x_[rate_of(mass)] == 0) settle_at_rest(mass, 0);
  }
}

/// Of a mass that stands still: held, or which way it starts.
void ColumnPlant::settle_at_rest(Mass mass, double tau) {
  const double pull = pull_nm(mass, tau, x_);
  regime_.slip[mass] = std::abs(pull) > dry_nm(mass) ? sign(pull) : 0;
}

/// One step, as far as h or the next event; returns how far it went.
double ColumnPlant::step(double tau, double h, int& events) {
  const State next = after(tau, h);
  if (events >= kMostEvents || margins(tau + h, next).inside()) {
    x_ = next;
    return h;
  }
  ++events;
  constexpr int kHalvings = 40;  // of a millisecond: to the last bit of a time in seconds
  double low = 0;
  double high = h;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (margins(tau + middle, after(tau, middle)).inside() ? low : high) = middle;
  }
  const State there = after(tau, high);
  const Margins left = margins(tau + high, there);
  x_ = there;
  if (left.assist < 0) regime_.assist = regime_.assist == 0 ? sign(bar_nm(x_)) : 0;
  if (left.clip < 0) regime_.clip = regime_.clip == 0 ? sign(asked_of_motor_nm(tau + high, bar_nm(x_))) : 0;
  for (const Mass mass : kMasses) {
    if (left.slip[mass] >= 0) continue;
    x_[rate_of(mass)] = 0;
    settle_at_rest(mass, tau + high);
  }
  return high;
}

/// A bound of how fast wheel and column swing, each held fast in turn, and of what damps them.
double ColumnPlant::fastest_per_s(double span_s) const {
  const double inertia = std::min(inputs_.inertia_kgm2.at(0), inputs_.inertia_kgm2.at(span_s));
  const double stiffness = std::max(inputs_.stiffness_nm.at(0), inputs_.stiffness_nm.at(span_s));
  const double damping = std::max(inputs_.damping_nms.at(0), inputs_.damping_nms.at(span_s));
  const double answered = 1 + column_.assist_gain;
  const double above = (stiffness + column_.bar_stiffness_nm_per_rad) / inertia;
  const double below = (column_.aligning_stiffness_nm_per_rad + answered * column_.bar_stiffness_nm_per_rad) /
                       column_.column_inertia_kgm2;
  const double damped =
      (damping + column_.bar_damping_nms_per_rad) / inertia +
      (column_.column_damping_nms_per_rad + answered * column_.bar_damping_nms_per_rad) / column_.column_inertia_kgm2;
  return std::sqrt(above + below) + damped;
}

void ColumnPlant::advance(const ColumnInputs& inputs, double span_s) {
  inputs_ = inputs;
  classify();
  const double steps = std::ceil(span_s * fastest_per_s(span_s) / kStepAngle) * refinement_;
  const double h = span_s / steps;
  int events = 0;
  double tau = 0;
  for (int i = 1; i <= static_cast<int>(steps); ++i) {
    const double target = h * i;
    while (tau < target) {
      const double left = target - tau;
      const double went = step(tau, left, events);
      tau = went == left ? target : tau + went;
    }
  }
  inputs_ = inputs_.shifted(span_s);
}

ColumnTorques ColumnPlant::torques(const ColumnInputs& inputs) const {
  ColumnPlant here = *this;
  here.inputs_ = inputs;
  here.classify();
  ColumnTorques torques;
  torques.bar_nm = bar_nm(x_);
  torques.motor_nm = here.motor_nm(0, torques.bar_nm);
  torques.wheel_friction_nm = here.friction_nm(kWheel, here.pull_nm(kWheel, 0, x_));
  torques.rack_friction_nm = here.friction_nm(kColumn, here.pull_nm(kColumn, 0, x_));
  torques.rim_nm = column_.wheel_inertia_kgm2 * here.acceleration_rad_s2(kWheel, 0, x_) +
                   column_.wheel_damping_nms_per_rad * x_[1] + torques.bar_nm + torques.wheel_friction_nm;
  return torques;
}

}  // namespace steerid
