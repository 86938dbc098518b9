// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// print_can_frames SEED: packs random samples and estimates and prints, a JSON object a line, each frame's identifier
// and bytes beside the physical values that went in. decode_with_canmatrix.py reads them back with the DBC file alone.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "can/estimate_messages.hpp"
#include "can/sample_messages.hpp"

namespace {

using nlohmann::json;
using namespace steerid;

std::mt19937_64 random_source;

std::int64_t between(std::int64_t lowest, std::int64_t highest) {
  return lowest + static_cast<std::int64_t>(random_source() % static_cast<std::uint64_t>(highest - lowest + 1));
}

std::int32_t between32(std::int32_t lowest, std::int32_t highest) {
  return static_cast<std::int32_t>(between(lowest, highest));
}

std::uint16_t any16() { return static_cast<std::uint16_t>(random_source()); }

void print(const can::Frame& frame, const json& signals) {
  std::string bytes;
  for (const std::uint8_t byte : frame.data) {
    char text[3];
    std::snprintf(text, sizeof text, "%02x", byte);
    bytes += text;
  }
  std::puts(json{{"id", frame.id}, {"bytes", bytes}, {"signals", signals}}.dump().c_str());
}

void print_sample(int cycle) {
  Sample sample;
  sample.stamp_us = between(0, (std::int64_t{1} << 48) - 1);
  sample.angle_urad = between32(-20'000'000, 20'000'000);
  sample.torque_driver_mnm = between32(-100'000, 100'000);
  sample.torque_motor_mnm = between32(-100'000, 100'000);
  sample.sequence = any16();
  sample.torque_bar_mnm = between32(-32'768, 32'767);
  sample.torque_rim_mnm = between32(-32'768, 32'767);
  sample.probe_mnm = between32(-32'768, 32'767);
  sample.valid_bits = static_cast<std::uint8_t>(between(0, 63));
  const int alive = cycle % 15;
  const auto frames = can::pack(sample, static_cast<std::uint8_t>(alive));
  const auto bit = [&sample](std::uint8_t mask) { return (sample.valid_bits & mask) != 0 ? 1 : 0; };
  print(frames[0], {{"AliveCounter", alive},
                    {"AngleValid", bit(kAngleValid)},
                    {"Angle", sample.angle_urad * 1e-6},
                    {"SampleNumber", sample.sequence}});
  print(frames[1], {{"AliveCounter", alive},
                    {"TorqueDriverValid", bit(kTorqueDriverValid)},
                    {"TorqueMotorValid", bit(kTorqueMotorValid)},
                    {"TorqueDriver", sample.torque_driver_mnm * 1e-3},
                    {"TorqueMotor", sample.torque_motor_mnm * 1e-3}});
  print(frames[2], {{"AliveCounter", alive},
                    {"ColumnSent", frames.size() == 4 ? 1 : 0},
                    {"SampleStamp", static_cast<double>(sample.stamp_us) * 1e-6}});
  if (frames.size() < 4) return;
  print(frames[3], {{"AliveCounter", alive},
                    {"TorqueBarValid", bit(kTorqueBarValid)},
                    {"TorqueRimValid", bit(kTorqueRimValid)},
                    {"ProbeValid", bit(kProbeValid)},
                    {"TorqueBar", sample.torque_bar_mnm * 1e-3},
                    {"TorqueRim", sample.torque_rim_mnm * 1e-3},
                    {"Probe", sample.probe_mnm * 1e-3}});
}

/// Deviations are drawn on the steps of their signals, so that what is decoded is what went in.
ParameterEstimate draw(std::int32_t highest_micro, std::int32_t step_micro) {
  return {between32(0, highest_micro), between32(0, 65535) * step_micro, static_cast<ParameterState>(between(0, 5))};
}

void print_estimate(can::EstimateMessages& messages, int cycle) {
  Estimate estimate;
  estimate.stamp_us = between(0, (std::int64_t{1} << 48) - 1);
  estimate.inertia = draw(600'000, 2);
  estimate.damping = draw(15'000'000, 50);
  estimate.stiffness = draw(300'000'000, 1000);
  estimate.driver = static_cast<DriverState>(between(0, 3));
  estimate.hands = static_cast<HandCount>(between(0, 3));
  estimate.counters = {any16(), any16(), any16(), any16(), any16(), any16(), any16(), any16()};
  const auto any12 = [] { return static_cast<std::uint16_t>(random_source() % 4096); };
  const can::SampleCounters bus{any12(), any12(), any12(), any12()};
  const auto frames = messages.next(estimate, bus);
  const char* const names[] = {"Inertia", "Damping", "Stiffness"};
  const ParameterEstimate* const parameters[] = {&estimate.inertia, &estimate.damping, &estimate.stiffness};
  bool all_valid = true;
  bool any_fault = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = names[i];
    const ParameterEstimate& parameter = *parameters[i];
    all_valid = all_valid && parameter.state == ParameterState::kValid;
    any_fault = any_fault || parameter.state == ParameterState::kFault;
    print(frames[i], {{"AliveCounter", cycle % 15},
                      {name + "State", steerid::name(parameter.state)},
                      {name, parameter.value_micro * 1e-6},
                      {name + "Deviation", parameter.sd_micro * 1e-6}});
  }
  print(frames[3], {{"AliveCounter", cycle % 15},
                    {"Valid", all_valid ? 1 : 0},
                    {"Fault", any_fault ? 1 : 0},
                    {"EstimateStamp", static_cast<double>(estimate.stamp_us) * 1e-6}});
  print(frames[4], {{"AliveCounter", cycle % 15},
                    {"DriverState", steerid::name(estimate.driver)},
                    {"HandCount", steerid::name(estimate.hands)}});
  if (frames.size() == 5) return;
  const InputCounters& counters = estimate.counters;
  const int alive = cycle / 10 % 15;
  print(frames[5], {{"AliveCounter", alive},
                    {"InvalidChannel", counters.invalid_channel},
                    {"OutOfRange", counters.out_of_range},
                    {"Spike", counters.spike}});
  print(frames[6], {{"AliveCounter", alive},
                    {"Repeated", counters.repeated},
                    {"OutOfOrder", counters.out_of_order},
                    {"LateTick", counters.late_tick}});
  print(frames[7],
        {{"AliveCounter", alive}, {"AcceptedAfterGap", counters.accepted_after_gap}, {"Stuck", counters.stuck}});
  print(frames[8], {{"AliveCounter", alive},
                    {"FramesCorrupt", bus.corrupt},
                    {"FramesRepeated", bus.repeated},
                    {"SamplesIncomplete", bus.incomplete},
                    {"SamplesRefused", bus.refused}});
}

}  // namespace

int main(int argc, char** argv) {
  random_source.seed(argc > 1 ? std::stoull(argv[1]) : 1);
  can::EstimateMessages messages;
  for (int cycle = 0; cycle < 200; ++cycle) {
    print_sample(cycle);
    print_estimate(messages, cycle);
    const std::int32_t torque_mnm = between32(-5'000, 5'000);
    print(can::probe_request(torque_mnm, static_cast<std::uint8_t>(cycle % 15)),
          {{"AliveCounter", cycle % 15}, {"ProbeTorque", torque_mnm * 1e-3}});
  }
}
