// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the firmware costs on a Cortex-M, in instructions: an image that runs the task over a drive and passes a pair of
// marker functions around each part. tests/bench/target/count.py counts between them.
//
// The wheel is a little simulation of this file's own, outside the markers: 60 s of a probe of three tones, and noise
// of the port's size from a linear congruential generator.
#include <cstdint>
#include <new>

#include "app/task.hpp"
#include "base/fixed.hpp"
#include "base/square_root.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "link/frame.hpp"

#define STEERID_MARK(name)                             \
  extern "C" [[gnu::noinline, gnu::used]] void name(); \
  extern "C" void name() {                             \
    asm volatile("" ::: "memory");                     \
    asm volatile("nop @ " #name);                      \
  }
STEERID_MARK(empty_begin)
STEERID_MARK(empty_end)
STEERID_MARK(core_begin)
STEERID_MARK(core_end)
STEERID_MARK(update_begin)
STEERID_MARK(update_end)
STEERID_MARK(take_begin)
STEERID_MARK(take_end)
STEERID_MARK(by_bar_begin)
STEERID_MARK(by_bar_end)
STEERID_MARK(estimate_begin)
STEERID_MARK(estimate_end)
STEERID_MARK(frame_begin)
STEERID_MARK(frame_end)
STEERID_MARK(root_begin)
STEERID_MARK(root_end)
STEERID_MARK(quotient_begin)
STEERID_MARK(quotient_end)

namespace {

using namespace steerid;
#ifdef __ARM_FP
using Number = float;
#else
using Number = Fixed;
#endif

/// Keeps a value where the compiler cannot see through it.
template <class T>
void hide(T& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

/// J 0.11, B 1.5, C 22.7 in steps of 1 ms; Euler forward in rate, then angle.
class Wheel {
 public:
  Sample next() {
    // Tones of 0.4, 1.3 and 3.1 Hz turn by a fixed angle a tick.
    static constexpr float kTurn[3][2] = {
        {0.99968418F, 0.02513010F}, {0.99666469F, 0.08160527F}, {0.98109233F, 0.19353947F}};
    float torque = 0;
    for (int i = 0; i < 3; ++i) {
      const float x = x_[i] * kTurn[i][0] - y_[i] * kTurn[i][1];
      y_[i] = x_[i] * kTurn[i][1] + y_[i] * kTurn[i][0];
      x_[i] = x;
      torque += x;
    }
    for (int i = 0; i < 10; ++i) {
      const float share = (static_cast<float>(i) + 0.5F) * 0.1F;
      rate_ += 0.001F * (torque_ + (torque - torque_) * share - 1.5F * rate_ - 22.7F * angle_) / 0.11F;
      angle_ += 0.001F * rate_;
    }
    torque_ = torque;
    Sample sample;
    sample.stamp_us = stamp_us_ += kTickPeriodUs;
    sample.angle_urad = static_cast<std::int32_t>(angle_ * 1e6F) + noise(1200);
    sample.torque_driver_mnm = static_cast<std::int32_t>(torque * 1e3F) + noise(50);
    return sample;
  }

 private:
  std::int32_t noise(std::int32_t most) {
    state_ = state_ * 1664525U + 1013904223U;
    return static_cast<std::int32_t>(state_ >> 16U) % (2 * most + 1) - most;
  }
  float x_[3] = {1, 1, 1};
  float y_[3] = {0, 0, 0};
  float torque_ = 0;
  float rate_ = 0;
  float angle_ = 0;
  std::uint32_t state_ = 1;
  std::int64_t stamp_us_ = 0;
};

/// The measurement update of the UD covariance with its step of the parameters, and nothing else.
[[gnu::noinline]] void core(UdCovariance<Number>& covariance, ParameterSum<Number>& p, const Vector3<Number>& z,
                            const Number& residual) {
  p.add(covariance.observe(z, residual));
}

/// Semihosting: the emulator ends.
[[noreturn]] void leave() {
  register std::uint32_t operation asm("r0") = 0x18;
  register std::uint32_t reason asm("r1") = 0x20026;
  asm volatile("bkpt 0xAB" : : "r"(operation), "r"(reason) : "memory");
  for (;;) {
  }
}

}  // namespace

extern "C" void run_ecu() {
  static Wheel wheel;
  static IdentificationTask<Number> task;
  static Identifier<Number> identifier;
  static link::FrameWriter writer;
  static UdCovariance<Number> covariance(Vector3<Number>(Number(0.1), Number(2), Number(30)));
  static ParameterSum<Number> p(Vector3<Number>(Number(0.08), Number(1.5), Number(15)));
  for (int tick = 0; tick < 3000; ++tick) {
    const Sample sample = wheel.next();
    empty_begin();
    empty_end();
    take_begin();
    task.take(sample);
    take_end();
    estimate_begin();
    Estimate estimate = task.estimate();
    estimate_end();
    hide(estimate);
    frame_begin();
    auto frame = writer.frame(link::Type::kEstimate, estimate);
    frame_end();
    hide(frame);
    Number torque = Number(static_cast<std::int32_t>(sample.torque_driver_mnm)) * Number(1e-3);
    Number angle = Number(static_cast<std::int32_t>(sample.angle_urad)) * Number(1e-6);
    hide(torque);
    update_begin();
    identifier.update(torque, angle);
    update_end();
    Vector3<Number> z(angle * Number(30), angle * Number(5), angle);
    Number residual = torque * Number(0.01);
    hide(z);
    core_begin();
    core(covariance, p, z, residual);
    core_end();
    Number root = torque * torque + Number(1);
    hide(root);
    root_begin();
    root = square_root(root);
    hide(root);
    root_end();
    quotient_begin();
    root = torque / root;
    hide(root);
    quotient_end();
  }
  // The same motion as a torsion bar tells of it, under a probe that is all of the torque. In the first task's place:
  // there is no memory for a second one.
  new (&task) IdentificationTask<Number>();
  for (int tick = 0; tick < 3000; ++tick) {
    Sample sample = wheel.next();
    sample.torque_bar_mnm = -sample.torque_driver_mnm;
    sample.probe_mnm = sample.torque_driver_mnm;
    sample.torque_driver_mnm = 0;
    sample.valid_bits = kAngleValid | kTorqueBarValid | kProbeValid;
    by_bar_begin();
    task.take(sample);
    by_bar_end();
  }
  leave();
}
