// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Prints the CRC-32 of every estimate's bytes over the samples on standard input, in float and in fixed point: one
// number that is the same wherever the bits are. One sample a line: stamp, angle, driver's torque, motor's torque.
#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "app/task.hpp"
#include "base/crc32.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "link/messages.hpp"

namespace {

template <class Scalar>
void digest(const char* title, const std::vector<steerid::Sample>& samples) {
  steerid::IdentificationTask<Scalar> task;
  std::vector<std::uint8_t> bytes;
  for (const steerid::Sample& sample : samples) {
    task.take(sample);
    const auto payload = steerid::link::payload(task.estimate());
    bytes.insert(bytes.end(), payload.bytes().begin(), payload.bytes().end());
  }
  std::printf("%s %zu estimates %08lX\n", title, samples.size(), static_cast<unsigned long>(steerid::crc32(bytes)));
}

}  // namespace

int main() {
  std::vector<steerid::Sample> samples;
  steerid::Sample sample;
  long long stamp = 0;
  int angle = 0;
  int driver = 0;
  int motor = 0;
  while (std::scanf("%lld,%d,%d,%d", &stamp, &angle, &driver, &motor) == 4) {
    sample.stamp_us = stamp;
    sample.angle_urad = angle;
    sample.torque_driver_mnm = driver;
    sample.torque_motor_mnm = motor;
    samples.push_back(sample);
  }
  digest<float>("float", samples);
  digest<steerid::Fixed>("fixed", samples);
  return samples.empty() ? 1 : 0;
}
