// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "hil/hil_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <thread>

#include "hil/drive.hpp"

namespace steerid::hil {
namespace {

constexpr std::size_t kAhead =
    4;  ///< ticks on their way: their frames fit the ECU's 256 bytes of buffer, damaged ones too
constexpr std::size_t kTold = 10;  ///< differences

bool all_valid(const Estimate& e) {
  return e.inertia.state == ParameterState::kValid && e.damping.state == ParameterState::kValid &&
         e.stiffness.state == ParameterState::kValid;
}

double seconds(std::size_t ticks) { return static_cast<double>(ticks) * 1e-6 * kTickPeriodUs; }

Recovery recovery(const Ecu& ecu, std::size_t tick) {
  return {seconds(tick), ecu.identity().cause, ecu.identity().restored != 0, std::nullopt};
}

enum class Fault : std::uint8_t { kNone, kLost, kDamaged, kDelayed };

/// What happens to every tick's sample, drawn before anything is sent.
std::vector<Fault> draw(std::size_t ticks, const WireFaults& faults, std::mt19937_64& random) {
  std::vector<Fault> drawn(ticks, Fault::kNone);
  for (Fault& fault : drawn) {
    const double u = static_cast<double>(random() >> 11U) * 0x1p-53;
    if (u < faults.lose) {
      fault = Fault::kLost;
    } else if (u < faults.lose + faults.damage) {
      fault = Fault::kDamaged;
    } else if (u < faults.lose + faults.damage + faults.delay) {
      fault = Fault::kDelayed;
    }
  }
  return drawn;
}

/// One run in lock-step: what was sent, what came back.
class LockStep {
 public:
  LockStep(Ecu& ecu, const std::vector<std::optional<Sample>>& samples, const WireFaults& faults)
      : ecu_(&ecu),
        samples_(&samples),
        faults_(&faults),
        random_(faults.seed),
        drawn_(draw(samples.size(), faults, random_)) {
    for (const double at_s : faults.resets_s) {
      const double tick = std::round(at_s * 1e6 / kTickPeriodUs);
      if (tick > 0 && tick < static_cast<double>(samples.size())) resets_.push_back(static_cast<std::size_t>(tick));
    }
    std::sort(resets_.begin(), resets_.end());
  }

  HilResult run(Progress& progress) {
    ecu_->start(link::Pace::kLink);
    for (std::size_t k = 0; k < samples_->size(); ++k) {
      const bool reset = std::binary_search(resets_.begin(), resets_.end(), k);
      if (reset) restart(k);
      seen_.push_back({.sample = send(k), .reset_before = reset});
      while (seen_.size() - answers_.size() > kAhead) answers_.push_back(ecu_->estimate());
      progress.at(k);
    }
    drain();
    return judge();
  }

 private:
  void drain() {
    while (answers_.size() < seen_.size()) answers_.push_back(ecu_->estimate());
  }

  void restart(std::size_t tick) {
    drain();
    ecu_->reset(true);
    ecu_->start(link::Pace::kLink);
    result_.recoveries.push_back(recovery(*ecu_, tick));
  }

  /// Sends tick k's frames; returns the sample that reaches the ECU in it.
  std::optional<Sample> send(std::size_t k) {
    const auto behind = static_cast<std::size_t>(faults_->delay_ticks);
    const bool old_one = k >= behind && drawn_[k - behind] == Fault::kDelayed && (*samples_)[k - behind];
    const std::optional<Sample>& sample = (*samples_)[old_one ? k - behind : k];
    const Fault fault = old_one ? Fault::kNone : drawn_[k];
    if (old_one) ++result_.delayed;
    if (sample && fault == Fault::kNone) {
      ecu_->sample(*sample);
      return sample;
    }
    if (sample && fault == Fault::kLost) {
      ecu_->lost_sample(*sample);
      ++result_.lost;
    }
    if (sample && fault == Fault::kDamaged) {
      ecu_->damaged_sample(*sample, random_);
      ++result_.damaged;
    }
    ecu_->tick();
    return std::nullopt;
  }

  HilResult judge() {
    const std::vector<Estimate> expected = in_process(seen_, ecu_->identity().number);
    result_.ticks = answers_.size();
    result_.last = answers_.back();
    result_.health = ecu_->health();
    for (std::size_t k = 0; k < answers_.size(); ++k) {
      if (same_bits(answers_[k], expected[k])) continue;
      ++result_.different;
      if (result_.differences.size() < kTold) result_.differences.push_back({k, answers_[k], expected[k]});
    }
    for (Recovery& recovery : result_.recoveries) {
      const auto from = static_cast<std::size_t>(std::llround(recovery.at_s * 1e6 / kTickPeriodUs));
      for (std::size_t k = from; k < answers_.size() && !recovery.valid_again_s; ++k) {
        if (all_valid(answers_[k])) recovery.valid_again_s = seconds(k - from);
      }
    }
    return result_;
  }

  Ecu* ecu_;
  const std::vector<std::optional<Sample>>* samples_;
  const WireFaults* faults_;
  std::mt19937_64 random_;
  std::vector<Fault> drawn_;
  std::vector<std::size_t> resets_;
  std::vector<TickInput> seen_;
  std::vector<Estimate> answers_;
  HilResult result_;
};

bool same_parameters(const Estimate& a, const Estimate& b) {
  const auto same = [](const ParameterEstimate& x, const ParameterEstimate& y) {
    return x.value_micro == y.value_micro && x.sd_micro == y.sd_micro && x.state == y.state;
  };
  return same(a.inertia, b.inertia) && same(a.damping, b.damping) && same(a.stiffness, b.stiffness);
}

/// One run by the ECU's own clock, and by the host's.
class RealTime {
 public:
  RealTime(Ecu& ecu, const std::vector<Estimate>& expected) : ecu_(&ecu), expected_(expected) {
    for (const Estimate& estimate : expected_) by_stamp_.emplace(estimate.stamp_us, &estimate);
  }

  HilResult run(const std::vector<std::optional<Sample>>& samples, Progress& progress) {
    using Clock = std::chrono::steady_clock;
    ecu_->start(link::Pace::kTimer);
    auto due = Clock::now();
    for (tick_ = 0; tick_ < samples.size(); ++tick_) {
      if (samples[tick_]) ecu_->sample(*samples[tick_]);
      due += std::chrono::microseconds(kTickPeriodUs);
      while (const auto estimate = ecu_->estimate_if_any(0)) take(*estimate);
      if (ecu_->started_again()) {
        result_.recoveries.push_back(recovery(*ecu_, tick_));
        ecu_->start(link::Pace::kTimer);
      }
      progress.at(tick_);
      std::this_thread::sleep_until(due);
    }
    const auto last = Clock::now() + std::chrono::milliseconds(200);
    while (Clock::now() < last) {
      if (const auto estimate = ecu_->estimate_if_any(20)) take(*estimate);
    }
    result_.health = ecu_->health();
    return result_;
  }

 private:
  void take(const Estimate& estimate) {
    if (estimate.stamp_us == last_stamp_) return;  // a tick without a new sample
    last_stamp_ = estimate.stamp_us;
    result_.last = estimate;
    if (result_.recoveries.empty()) return compare(estimate);
    Recovery& latest = result_.recoveries.back();
    if (!latest.valid_again_s && all_valid(estimate)) latest.valid_again_s = seconds(tick_) - latest.at_s;
  }

  void compare(const Estimate& estimate) {
    ++result_.ticks;
    const auto match = by_stamp_.find(estimate.stamp_us);
    if (match == by_stamp_.end() || same_parameters(estimate, *match->second)) return;
    ++result_.different;
    if (result_.differences.size() == kTold) return;
    result_.differences.push_back(
        {static_cast<std::size_t>(estimate.stamp_us / kTickPeriodUs), estimate, *match->second});
  }

  Ecu* ecu_;
  std::vector<Estimate> expected_;
  std::map<std::int64_t, const Estimate*> by_stamp_;
  std::size_t tick_ = 0;
  std::int64_t last_stamp_ = -1;
  HilResult result_;
};

}  // namespace

HilResult run_as_fast_as_it_goes(Ecu& ecu, const Record& record, const WireFaults& faults, Progress& progress) {
  const auto samples = samples_of(record);
  return LockStep(ecu, samples, faults).run(progress);
}

HilResult run_in_real_time(Ecu& ecu, const Record& record, Progress& progress) {
  const auto samples = samples_of(record);
  std::vector<TickInput> seen;
  for (const auto& sample : samples) seen.push_back({.sample = sample});
  return RealTime(ecu, in_process(seen, ecu.identity().number)).run(samples, progress);
}

}  // namespace steerid::hil
