// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "blind/dormand_prince.hpp"

namespace steerid::blind {
namespace {

constexpr double kLongestStepS = 5e-3;
constexpr double kEventS = 1e-12;
constexpr double kSmallestStepS = 1e-9;
constexpr int kMostCrossingsAtOnce = 50;
constexpr double kMostStepsPerS = 1e5;
constexpr double kFarthestRad = 50;  // a wheel that has turned eight times has run away

enum ChannelNumber : std::size_t { kAngle, kDriver, kMotor, kChannelCount };
enum Noise : std::uint64_t { kNoise = 900, kConvert = 910 };

class Wheel {
 public:
  Wheel(const Arm& arm, const Torques& torques, const Elements& elements, double corner_hz)
      : arm_(arm), torques_(torques), elements_(elements), corner_(2 * std::numbers::pi * corner_hz) {
    std::size_t at = 2;
    for (const auto& element : elements_) {
      first_.push_back(at);
      at += element->states();
    }
    filters_ = at;
    states_ = at + 2 * kChannelCount;
  }

  [[nodiscard]] std::size_t states() const { return states_; }
  [[nodiscard]] double filtered(ChannelNumber channel, std::span<const double> state) const {
    return state[filters_ + 2 * channel];
  }

  void start(double time_s, std::span<double> state) const {
    for (std::size_t i = 0; i < elements_.size(); ++i) elements_[i]->start(instant(time_s, state), own(i, state));
  }

  void rates(double time_s, std::span<const double> state, std::span<double> slope) const {
    std::fill(slope.begin(), slope.end(), 0.0);
    const Instant now = instant(time_s, state);
    const double driver_nm = torques_.driver.at(time_s);
    const double motor_nm = torques_.motor.at(time_s);
    Balance balance{arm_.inertia_kgm2, arm_.damping_nms_per_rad,  arm_.stiffness_nm_per_rad, now.angle_rad, driver_nm,
                    motor_nm,          torques_.unseen.at(time_s)};
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      elements_[i]->act(now, own(i, state), own(i, slope), balance);
    }
    slope[0] = now.rate_rad_s;
    slope[1] =
        (balance.driver_nm - balance.motor_nm + balance.torque_nm - balance.damping_nms_per_rad * now.rate_rad_s -
         balance.stiffness_nm_per_rad * balance.spring_angle_rad) /
        balance.inertia_kgm2;
    Shown shown{driver_nm, motor_nm, now.angle_rad};
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      elements_[i]->show(now, own(i, state), own(i, slope), shown);
    }
    filter(kAngle, shown.angle_rad, state, slope);
    filter(kDriver, shown.driver_nm, state, slope);
    filter(kMotor, shown.motor_nm, state, slope);
  }

  /// True when some element's mode no longer holds in this state.
  [[nodiscard]] bool crossed(double time_s, std::span<const double> state) const {
    const Instant now = instant(time_s, state);
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      if (elements_[i]->guard(now, own(i, state)) < 0) return true;
    }
    return false;
  }

  void cross(double time_s, std::span<double> state) const {
    const Instant now = instant(time_s, state);
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      if (elements_[i]->guard(now, own(i, state)) < 0) elements_[i]->cross(now, own(i, state));
    }
  }

  [[nodiscard]] double next_time_s(double time_s) const {
    double next = std::numeric_limits<double>::infinity();
    for (const auto& element : elements_) next = std::min(next, element->next_time_s(time_s));
    return next;
  }
  void at_time(double time_s) const {
    for (const auto& element : elements_) element->at_time(time_s);
  }
  void passed(double time_s, std::span<const double> state, double acceleration) const {
    for (const auto& element : elements_) element->passed(instant(time_s, state), acceleration);
  }

 private:
  [[nodiscard]] static Instant instant(double time_s, std::span<const double> state) {
    return {time_s, state[0], state[1]};
  }
  template <class T>
  [[nodiscard]] std::span<T> own(std::size_t i, std::span<T> state) const {
    return state.subspan(first_[i], elements_[i]->states());
  }
  void filter(ChannelNumber channel, double input, std::span<const double> state, std::span<double> slope) const {
    const std::size_t k = filters_ + 2 * channel;
    slope[k] = state[k + 1];
    slope[k + 1] = corner_ * (corner_ * (input - state[k]) - std::numbers::sqrt2 * state[k + 1]);
  }

  const Arm& arm_;
  const Torques& torques_;
  const Elements& elements_;
  double corner_;
  std::vector<std::size_t> first_;  // state of each element
  std::size_t filters_ = 0;
  std::size_t states_ = 0;
};

/// Moves the wheel on, stopping at corners.
class Course {
 public:
  Course(const Wheel& wheel, const Run& run)
      : wheel_(wheel),
        solver_(
            wheel.states(),
            [&wheel](double t, std::span<const double> y, std::span<double> slope) { wheel.rates(t, y, slope); },
            run.relative_tolerance, run.absolute_tolerance),
        most_steps_(static_cast<std::size_t>(kMostStepsPerS * (run.lead_in_s + run.duration_s + 1))),
        time_s_(-run.lead_in_s),
        state_(wheel.states()),
        probe_(wheel.states()),
        slope_(wheel.states()) {
    wheel_.start(time_s_, state_);
    note();
  }

  void go_to(double stop_s) {
    while (time_s_ < stop_s) {
      const double jump_s = wheel_.next_time_s(time_s_);
      const double until_s = std::min(stop_s, jump_s);
      while (time_s_ < until_s) step(until_s);
      if (jump_s <= stop_s) {
        wheel_.at_time(jump_s);
        solver_.restart();
      }
    }
  }

  [[nodiscard]] std::span<const double> state() const { return state_; }
  [[nodiscard]] std::size_t events() const { return events_; }
  [[nodiscard]] std::size_t steps() const { return steps_; }

 private:
  void step(double until_s) {
    settle_modes();
    double step = std::min({step_s_, kLongestStepS, until_s - time_s_});
    double error = solver_.attempt(time_s_, state_, step);
    while (error > 1 && step > kSmallestStepS) {
      step = DormandPrince::better_step(step, error);
      error = solver_.attempt(time_s_, state_, step);
    }
    if (!(std::abs(solver_.end()[0]) < kFarthestRad)) throw std::runtime_error("the wheel runs away");
    if (++steps_ > most_steps_) throw std::runtime_error("the wheel's events do not come to an end");
    // A step cut short by a sample says nothing about the next one.
    step_s_ = std::max(DormandPrince::better_step(step, error), std::min(step_s_, kLongestStepS) * 0.2);
    double good = 0;
    const double bad = first_crossing(step, good);
    if (bad > 1) {
      time_s_ = step == until_s - time_s_ ? until_s : time_s_ + step;
      std::copy(solver_.end().begin(), solver_.end().end(), state_.begin());
      solver_.go_on();
    } else {
      const double event = locate(step, good, bad);
      solver_.within(event, probe_);
      state_ = probe_;
      time_s_ += event * step;
      ++events_;
      wheel_.cross(time_s_, state_);
      solver_.restart();
    }
    note();
  }

  /// The first of a few places in the step where a mode no longer holds, `good` the last one where all do; above 1 when
  /// they hold throughout.
  double first_crossing(double step, double& good) {
    for (const double fraction : {0.25, 0.5, 0.75}) {
      solver_.within(fraction, probe_);
      if (wheel_.crossed(time_s_ + fraction * step, probe_)) return fraction;
      good = fraction;
    }
    return wheel_.crossed(time_s_ + step, solver_.end()) ? 1.0 : 2.0;
  }

  /// Bisection down to kEventS; the answer lies just behind the corner.
  double locate(double step, double good, double bad) {
    while ((bad - good) * step > kEventS) {
      const double middle = 0.5 * (good + bad);
      solver_.within(middle, probe_);
      (wheel_.crossed(time_s_ + middle * step, probe_) ? bad : good) = middle;
    }
    return bad;
  }

  /// After an event the next mode must hold; one that does not is left at once.
  void settle_modes() {
    for (int i = 0; wheel_.crossed(time_s_, state_); ++i) {
      if (i == kMostCrossingsAtOnce) throw std::runtime_error("an element finds no mode that holds");
      wheel_.cross(time_s_, state_);
      solver_.restart();
    }
  }

  void note() {
    wheel_.rates(time_s_, state_, slope_);
    wheel_.passed(time_s_, state_, slope_[1]);
  }

  const Wheel& wheel_;
  DormandPrince solver_;
  std::size_t most_steps_;
  double time_s_;
  double step_s_ = 1e-3;
  std::vector<double> state_;
  std::vector<double> probe_;
  std::vector<double> slope_;
  std::size_t events_ = 0;
  std::size_t steps_ = 0;
};

/// One thing to be sampled: a stamp's angle or its torques.
struct Sampling {
  double time_s = 0;
  std::size_t sample = 0;
  bool angle = false;
};

std::vector<Sampling> samplings(const Elements& elements, std::span<const double> stamps_s) {
  std::vector<Sampling> all;
  for (std::size_t k = 0; k < stamps_s.size(); ++k) {
    double late_s = 0;
    for (const auto& element : elements) late_s += element->late_s(stamps_s[k]);
    all.push_back({stamps_s[k] - std::max(late_s, 0.0), k, true});
    all.push_back({stamps_s[k] - std::max(-late_s, 0.0), k, false});
  }
  std::stable_sort(all.begin(), all.end(), [](const Sampling& a, const Sampling& b) { return a.time_s < b.time_s; });
  return all;
}

void convert(std::vector<double>& column, double noise, double step, Draw& draw) {
  for (double& value : column) {
    value += noise * draw.normal();
    if (step > 0) value = step * std::round(value / step);
  }
}

}  // namespace

Drive simulate(const Arm& arm, const Torques& torques, const Elements& elements, const Sensors& sensors, const Run& run,
               std::uint64_t seed) {
  const Wheel wheel(arm, torques, elements, sensors.corner_hz);
  Course course(wheel, run);
  const auto count = static_cast<std::size_t>(std::lround(run.duration_s * run.rate_hz));
  Drive drive;
  for (std::size_t k = 0; k < count; ++k) drive.record.time_s.push_back(static_cast<double>(k) / run.rate_hz);
  Columns columns{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count)};
  for (const Sampling& sampling : samplings(elements, drive.record.time_s)) {
    course.go_to(sampling.time_s);
    if (sampling.angle) {
      columns.angle_rad[sampling.sample] = wheel.filtered(kAngle, course.state());
    } else {
      columns.driver_nm[sampling.sample] = wheel.filtered(kDriver, course.state());
      columns.motor_nm[sampling.sample] = wheel.filtered(kMotor, course.state());
    }
  }
  for (const auto& element : elements) element->write(columns);
  for (const auto& [column, noise, step, stream] :
       {std::tuple{&columns.driver_nm, sensors.driver_noise_nm, sensors.driver_step_nm, kNoise + 0},
        std::tuple{&columns.motor_nm, sensors.motor_noise_nm, sensors.motor_step_nm, kNoise + 1},
        std::tuple{&columns.angle_rad, sensors.angle_noise_rad, sensors.angle_step_rad, kNoise + 2}}) {
    Draw draw(seed, static_cast<std::uint64_t>(stream));
    convert(*column, noise, step, draw);
  }
  Draw draw(seed, kConvert);
  for (const auto& element : elements) element->convert(columns, draw);
  drive.record.torque_driver_nm = std::move(columns.driver_nm);
  drive.record.torque_motor_nm = std::move(columns.motor_nm);
  drive.record.angle_rad = std::move(columns.angle_rad);
  drive.events = course.events();
  drive.steps = course.steps();
  return drive;
}

}  // namespace steerid::blind
