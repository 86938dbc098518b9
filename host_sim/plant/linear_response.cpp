// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/linear_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace steerid {
namespace {

constexpr int kIntegrals = 5;  // 0 to 4 integrations: the response to a cubic needs four

// A signal of the impulse-response kind at one instant: its derivative, itself, its integral, ... 4-fold integral.
struct Integrals {
  double derivative = 0;
  std::array<double, kIntegrals> fold{};
};

// Adds the series term `term` = f_n dt^n / n! of a function f to its derivative and integrals.
void add_term(Integrals& sum, double term, int n, double dt) {
  sum.derivative += n * term / dt;
  for (int k = 0; k < kIntegrals; ++k) {
    sum.fold[static_cast<std::size_t>(k)] += term;
    term *= dt / (n + k + 1);
  }
}

// Terms after which x^n/n! is below the last bit of the first.
int series_length(double x) {
  int n = 4;
  for (double term = x * x * x * x / 24; term > 1e-19; ++n) term *= x / (n + 1);
  return n + 2;
}

// Upper bound on the magnitude of the wheel's poles.
double fastest_pole(const WheelArm& wheel) {
  const double half = std::abs(wheel.damping_nms_per_rad) / (2 * wheel.inertia_kgm2);
  return half + std::sqrt(half * half + std::abs(wheel.stiffness_nm_per_rad) / wheel.inertia_kgm2);
}

// The step by power series, for |pole| dt <= 1.
void series_step(const WheelArm& wheel, double dt, double pole_dt, LinearStep& step) {
  const double inertia = wheel.inertia_kgm2;
  const double b = wheel.damping_nms_per_rad * dt / inertia;
  const double c = wheel.stiffness_nm_per_rad * dt * dt / inertia;
  Integrals g;  // impulse response: J g'' + B g' + C g = 0, g(0) = 0, g'(0) = 1/J
  Integrals q;  // g * g:            J q'' + B q' + C q = g, q(0) = 0, q'(0) = 0
  double g0 = 0;
  double g1 = dt / inertia;
  double q0 = 0;
  double q1 = 0;
  add_term(g, g1, 1, dt);
  const int terms = series_length(pole_dt);
  for (int n = 0; n < terms; ++n) {
    const double g2 = -(b * g1 + c * g0 / (n + 1)) / (n + 2);
    const double q2 = -(b * q1 + (c * q0 - dt * dt / inertia * g0) / (n + 1)) / (n + 2);
    add_term(g, g2, n + 2, dt);
    add_term(q, q2, n + 2, dt);
    g0 = g1;
    g1 = g2;
    q0 = q1;
    q1 = q2;
  }

  const double damping = wheel.damping_nms_per_rad;
  const double stiffness = wheel.stiffness_nm_per_rad;
  Eigen::Matrix2d free;                                                       // columns h1, h2; rows angle, rate
  free << inertia * g.derivative + damping * g.fold[0], inertia * g.fold[0],  //
      -stiffness * g.fold[0], inertia * g.derivative;
  step.transition.setZero();
  step.transition.topLeftCorner<2, 2>() = free;
  step.transition.bottomRightCorner<2, 2>() = free;
  step.transition.bottomLeftCorner<2, 2>() << inertia * q.derivative + damping * q.fold[0], inertia * q.fold[0],
      g.fold[0] - stiffness * q.fold[0], inertia * q.derivative;
  double factorial = 1;
  for (int k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (k > 1) factorial *= k;
    step.input.col(k) << g.fold[i + 1], g.fold[i], q.fold[i + 1], q.fold[i];
    step.input.col(k) *= factorial;
  }
}

// The step over 2 dt from the step over dt: the torque polynomial's origin moves along with the second half.
void double_step(double dt, LinearStep& step) {
  Eigen::Matrix4d shift;
  shift << 1, dt, dt * dt, dt * dt * dt,  //
      0, 1, 2 * dt, 3 * dt * dt,          //
      0, 0, 1, 3 * dt,                    //
      0, 0, 0, 1;
  step.input = (step.transition * step.input + step.input * shift).eval();
  step.transition = (step.transition * step.transition).eval();
}

// Steps a wheel along a torque signal. Matrices are kept as long as the spacing stays the same; the stamps of a
// record are rounded decimals, so "the same" allows for that rounding, which moves a sample by some 1e-11 s.
class Walk {
 public:
  Walk(const WheelArm& wheel, const TorqueSignal& torque, double start_s, double offset_nm)
      : wheel_(wheel), torque_(torque), now_s_(start_s), offset_nm_(offset_nm) {}

  // Calls advance(step, coefficients) once for every piece of torque between now and `until_s`.
  template <class Advance>
  void to(double until_s, Advance&& advance) {
    while (now_s_ < until_s) {
      const TorqueSignal::Local local = local_torque();
      const double next_s = std::min(until_s, local.until_s);
      prepare(next_s - now_s_);
      advance(*step_, Eigen::Vector4d(local.cubic.c0 + offset_nm_, local.cubic.c1, local.cubic.c2, local.cubic.c3));
      now_s_ = next_s;
    }
  }

 private:
  // The usual case, a record on the signal's own samples, needs no search.
  TorqueSignal::Local local_torque() {
    const std::size_t next = piece_ + 1;
    if (next < torque_.pieces() && torque_.knot_s(next) == now_s_) {
      piece_ = next;
      return {torque_.piece(next), torque_.knot_s(next + 1)};
    }
    while (piece_ < torque_.pieces() && torque_.knot_s(piece_ + 1) <= now_s_) ++piece_;
    return torque_.local(now_s_);
  }

  void prepare(double dt) {
    if (step_ && std::abs(dt - dt_s_) <= 1e-9 * dt_s_) return;
    step_.emplace(wheel_, dt);
    dt_s_ = dt;
  }

  const WheelArm& wheel_;
  const TorqueSignal& torque_;
  double now_s_;
  double offset_nm_;
  std::size_t piece_ = 0;
  double dt_s_ = 0;
  std::optional<LinearStep> step_;
};

}  // namespace

LinearStep::LinearStep(const WheelArm& wheel, double dt_s) {
  const double pole_dt = fastest_pole(wheel) * dt_s;
  int halvings = 0;
  double part = 1;
  while (pole_dt * part > 1) {
    part /= 2;
    ++halvings;
  }
  series_step(wheel, dt_s * part, pole_dt * part, *this);
  for (; halvings > 0; --halvings) {
    double_step(dt_s * part, *this);
    part *= 2;
  }
}

LinearStep::LinearStep(const Eigen::Matrix4d& rate, const Eigen::Vector4d& push, double dt_s) {
  // Power series over a part of the step so short that it falls below the last bit within kTerms, then doubled (scaling
  // and squaring; Moler and Van Loan, SIAM Review 45, 2003, method 3).
  constexpr double kShort = 0.5;
  constexpr int kTerms = 16;  // kShort^16/16! = 7e-19
  const double size = rate.norm();
  double part_s = dt_s;
  int halvings = 0;
  for (; size * part_s > kShort; ++halvings) part_s /= 2;
  transition.setIdentity();
  input.setZero();
  Eigen::Matrix4d power = Eigen::Matrix4d::Identity();      // (rate part)^n / n!
  Eigen::Vector4d pushed = push * part_s;                   // (rate part)^n push part
  Eigen::RowVector4d weight(1, 1.0 / 2, 1.0 / 3, 1.0 / 4);  // k!/(n + k + 1)! for the torque tau^k
  const Eigen::RowVector4d unit(1, part_s, part_s * part_s, part_s * part_s * part_s);
  for (int n = 0; n <= kTerms; ++n) {
    input += pushed * weight.cwiseProduct(unit);
    pushed = (rate * pushed * part_s).eval();
    power = (rate * power * (part_s / (n + 1))).eval();
    transition += power;
    for (int k = 0; k < 4; ++k) weight[k] /= n + k + 2;
  }
  for (; halvings > 0; --halvings) {
    double_step(part_s, *this);
    part_s *= 2;
  }
}

std::vector<WheelState> free_run_states(const WheelArm& wheel, const TorqueSignal& torque,
                                        std::span<const double> time_s, const WheelState& initial,
                                        double torque_offset_nm) {
  std::vector<WheelState> states;
  states.reserve(time_s.size());
  Eigen::Vector2d state(initial.angle_rad, initial.rate_rad_s);
  Walk walk(wheel, torque, time_s.empty() ? 0 : time_s.front(), torque_offset_nm);
  for (const double t : time_s) {
    walk.to(t, [&](const LinearStep& step, const Eigen::Vector4d& coefficients) {
      state = (step.transition.topLeftCorner<2, 2>() * state + step.input.topRows<2>() * coefficients).eval();
    });
    states.push_back({state[0], state[1]});
  }
  return states;
}

std::vector<double> free_run(const WheelArm& wheel, const TorqueSignal& torque, std::span<const double> time_s,
                             const WheelState& initial, double torque_offset_nm) {
  const std::vector<WheelState> states = free_run_states(wheel, torque, time_s, initial, torque_offset_nm);
  std::vector<double> angle_rad(states.size());
  std::transform(states.begin(), states.end(), angle_rad.begin(), [](const WheelState& s) { return s.angle_rad; });
  return angle_rad;
}

void free_run_sensitivities(const WheelArm& wheel, const TorqueSignal& torque, std::span<const double> time_s,
                            const WheelState& initial, double torque_offset_nm, FreeRunSensitivities& out) {
  const auto samples = static_cast<Eigen::Index>(time_s.size());
  out.angle_rad.resize(samples);
  out.by.resize(samples, kSensitivityColumns);
  const double inertia = wheel.inertia_kgm2;
  const double damping = wheel.damping_nms_per_rad;
  const double stiffness = wheel.stiffness_nm_per_rad;
  const double z2_initial = initial.angle_rad / inertia;
  const double z3_initial = (initial.rate_rad_s - damping * z2_initial) / inertia;

  Eigen::Vector4d state(initial.angle_rad, initial.rate_rad_s, 0, 0);  // th, th', z, z'
  Eigen::Matrix2d free;                                                // h2, h2' and unit-torque response, its rate
  free << 0, 0, 1, 0;
  Walk walk(wheel, torque, time_s.empty() ? 0 : time_s.front(), torque_offset_nm);
  for (Eigen::Index i = 0; i < samples; ++i) {
    walk.to(time_s[static_cast<std::size_t>(i)], [&](const LinearStep& step, const Eigen::Vector4d& coefficients) {
      state = (step.transition * state + step.input * coefficients).eval();
      free = (step.transition.topLeftCorner<2, 2>() * free).eval();
      free.col(1) += step.input.topLeftCorner<2, 1>();
    });
    const double z2 = (state[0] - damping * state[3] - stiffness * state[2]) / inertia;
    const double h2 = free(0, 0);
    const double h1 = free(1, 0) + damping / inertia * h2;
    out.angle_rad[i] = state[0];
    out.by(i, kByInertia) = -z2 + z2_initial * h1 + z3_initial * h2;
    out.by(i, kByDamping) = -state[3] + z2_initial * h2;
    out.by(i, kByStiffness) = -state[2];
    out.by(i, kByInitialAngle) = h1;
    out.by(i, kByInitialRate) = h2;
    out.by(i, kByTorqueOffset) = free(0, 1);
  }
}

}  // namespace steerid
