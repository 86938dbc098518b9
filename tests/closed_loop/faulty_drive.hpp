// A simulated drive through the firmware's loop during which something is wrong for a while: with the sensors
// (host_sim/sensors) or with the bus between them and the task.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/run_loop.hpp"
#include "app/task.hpp"
#include "backend/simulated.hpp"
#include "port/port.hpp"

namespace steerid::test {

/// When it is wrong.
struct FaultTime {
  double onset_s = 20;
  double length_s = 5;

  [[nodiscard]] double end_s() const { return onset_s + length_s; }
  [[nodiscard]] sensor::During during() const { return {onset_s, length_s}; }
};

struct Fault {
  std::string name;
  /// Sets the sensors' defects, if there are any.
  std::function<void(SensorDefects&, const FaultTime&)> sensors = {};
  /// Spoils the sample number `k` since the onset on the bus, if the bus is at fault.
  std::function<void(Sample&, int k)> bus = {};
};

/// What the loop handed out at one tick.
struct Outcome {
  Estimate estimate;
  bool valid = false;
  bool fault = false;
};

/// The simulated back end with a faulty bus before it.
class FaultyBus {
 public:
  FaultyBus(const Scenario& scenario, const Fault& fault, const FaultTime& when)
      : hal_(scenario), fault_(&fault), when_(when.during()) {}

  Status wait_tick() {
    ++tick_;
    return hal_.wait_tick();
  }
  Status read_sample(Sample& sample) {
    const Status status = hal_.read_sample(sample);
    if (status == Status::kOk && fault_->bus && when_.covers(tick_ * kTickPeriodUs)) fault_->bus(sample, spoiled_++);
    return status;
  }
  Status publish(const Estimate& estimate) {
    outcomes.push_back({estimate});
    return hal_.publish(estimate);
  }
  Status request_probe_torque(std::int32_t torque_mnm) { return hal_.request_probe_torque(torque_mnm); }
  void set_valid(bool level) { outcomes.back().valid = level; }
  void set_fault(bool level) { outcomes.back().fault = level; }
  void kick_watchdog() { hal_.kick_watchdog(); }

  std::vector<Outcome> outcomes;

 private:
  SimulatedHal hal_;
  const Fault* fault_;
  sensor::During when_;
  std::int64_t tick_ = -1;
  int spoiled_ = 0;
};
static_assert(Hal<FaultyBus>);

/// A probe drive of `duration_s` with `fault` in it.
inline std::vector<Outcome> faulty_drive(const Fault& fault, const FaultTime& when, double duration_s,
                                         std::uint64_t seed, const WheelArm& wheel) {
  Scenario scenario;
  scenario.task = task_settings(TaskKind::kProbe, HandPosition::kBoth3And9, seed);
  scenario.task.arm = wheel;
  scenario.wheel = wheel;
  scenario.duration_s = duration_s;
  if (fault.sensors) fault.sensors(scenario.sensors, when);
  FaultyBus hal(scenario, fault, when);
  IdentificationTask<float> task;
  if (run_loop(hal, task) != Status::kOk) hal.outcomes.clear();
  return std::move(hal.outcomes);
}

/// The largest error of a parameter that is called valid, in its own standard deviations plus one percent of the truth
/// (the allowance for the probe task's bias and for chance at one of thousands of ticks).
inline double worst_valid_error(const Estimate& estimate, const WheelArm& truth) {
  double worst = 0;
  const auto look = [&worst](const ParameterEstimate& p, double true_value) {
    if (p.state != ParameterState::kValid) return;
    const double error = std::abs(p.value_micro * 1e-6 - true_value);
    worst = std::max(worst, error / (p.sd_micro * 1e-6 + 0.01 * true_value));
  };
  look(estimate.inertia, truth.inertia_kgm2);
  look(estimate.damping, truth.damping_nms_per_rad);
  look(estimate.stiffness, truth.stiffness_nm_per_rad);
  return worst;
}

}  // namespace steerid::test
