// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/drawn_case.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "blind/catalogue.hpp"
#include "blind/linear_refit.hpp"
#include "blind/position_loop.hpp"
#include "blind/slow_torque.hpp"

namespace steerid::blind {
namespace {

enum Stream : std::uint64_t { kWheel = 2, kDriveStream, kEffects, kStrength, kSimulation, kLoopStream };

constexpr double kSmallestGap = 1.5;
constexpr double kLargestGap = 25;
constexpr double kLargestRemainder = 6;  // as the real machines of docs/real_records.md leave above their noise
constexpr double kLargestNrmse = 0.5;    // beyond it there is hardly a wheel left to diagnose

Task draw_task(const Contents& contents, Draw& draw) {
  for (const auto& [id, simulated] : contents) {
    if (id != "none" && id != "parameters" && kind_called(id).needs_large_angles) return Task::kActive;
  }
  constexpr std::array kTasks = {Task::kPassive, Task::kActive, Task::kProbe, Task::kProbe};
  return draw.one_of<Task>(kTasks);
}

/// Tables I and II of Lv et al. 2018: co-contraction is low when steering.
Arm draw_arm(Task task, Draw& draw) {
  const double inertia = draw.between(0.05, 0.17);
  if (task == Task::kActive || task == Task::kLoop) return {inertia, draw.log_between(0.4, 3.1), draw.between(4.5, 13)};
  return {inertia, draw.log_between(0.35, 4.4), draw.log_between(13, 60)};
}

Sensors draw_sensors(Draw& draw) {
  Sensors sensors;
  sensors.driver_noise_nm = draw.log_between(0.01, 0.045);
  sensors.motor_noise_nm = 0.1 * sensors.driver_noise_nm;  // the motor's torque is its own target, hardly measured
  sensors.angle_noise_rad = draw.log_between(3e-4, 1.2e-3);
  sensors.driver_step_nm = 5e-3;
  sensors.motor_step_nm = 1e-5;
  sensors.angle_step_rad = 5e-4;
  return sensors;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}
double peak(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

/// The effect's surroundings, read off its linear twin.
void measure(const Record& twin, Setting& setting) {
  std::vector<double> rate;
  for (std::size_t i = 2; i + 2 < twin.size(); ++i) {
    rate.push_back((twin.angle_rad[i + 2] - twin.angle_rad[i - 2]) / (twin.time_s[i + 2] - twin.time_s[i - 2]));
  }
  setting.torque_rms_nm = rms(twin.net_torque_nm());
  setting.torque_peak_nm = std::max(peak(twin.torque_driver_nm), peak(twin.torque_motor_nm));
  setting.angle_rms_rad = rms(twin.angle_rad);
  setting.angle_peak_rad = peak(twin.angle_rad);
  setting.rate_rms_rad_s = rms(rate);
}

/// The wheel's effects, but of this one what the simulation has; in the order of the contents, as elements act.
std::vector<DrawnEffect> with_simulated(const DrawnCase& what, const std::string& id) {
  std::vector<DrawnEffect> out;
  for (const Content& content : what.contents) {
    for (const DrawnEffect& one : content.id == id ? what.simulated : what.effects) {
      if (one.id == content.id) out.push_back(one);
    }
  }
  return out;
}

class Bench {
 public:
  Bench(DrawnCase& what, const Torques& torques, const Run& run, std::optional<PositionLoop> loop)
      : case_(what), torques_(torques), run_(run), loop_(std::move(loop)) {
    Drive twin = simulate(case_.arm, torques_, held(), case_.sensors, run_, case_.seed);
    const LinearRefit fit = refit(twin.record, case_.arm);
    floor_rad_ = fit.residual_rms_rad;
    setting_.task = case_.task;
    setting_.arm = case_.arm;
    setting_.wheel_inertia_share = case_.wheel_inertia_share;
    setting_.wheel_damping_share = case_.wheel_damping_share;
    setting_.duration_s = case_.duration_s;
    setting_.seed = case_.seed;
    measure(twin.record, setting_);
    note(std::move(twin.record), fit);
  }

  [[nodiscard]] const Setting& setting() const { return setting_; }

  /// Drives with these effects and notes what came of it; false when the wheel runs away.
  bool drive(const std::vector<DrawnEffect>& effects) {
    Elements elements = held();
    for (const DrawnEffect& effect : effects) elements.push_back(kind_called(effect.id).make(effect.numbers, setting_));
    try {
      Drive drive = simulate(case_.arm, torques_, elements, case_.sensors, run_, case_.seed);
      const LinearRefit fit = refit(drive.record, case_.arm);
      note(std::move(drive.record), fit);
    } catch (const std::runtime_error&) {
      return false;
    }
    return true;
  }

  /// Whether every change of the simulation shows in the drive that was noted; notes the gap of them all.
  bool shows_changes() {
    const auto angle = [&](const Arm& arm, const std::vector<DrawnEffect>& effects) {
      Elements elements = held();
      for (const DrawnEffect& one : effects) elements.push_back(kind_called(one.id).make(one.numbers, setting_));
      const Record record = simulate(arm, torques_, elements, case_.sensors, run_, case_.seed).record;
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(record.angle_rad.data(), std::ssize(record.angle_rad)));
    };
    const Eigen::VectorXd own =
        Eigen::Map<const Eigen::VectorXd>(case_.record.angle_rad.data(), std::ssize(case_.record.angle_rad));
    Eigen::MatrixXd moved(own.size(), 3);  // by J, B and C
    const auto gap_to = [&](const Eigen::VectorXd& other) {
      const Eigen::VectorXd apart = own - other;
      const Eigen::VectorXd rest = apart - moved * moved.colPivHouseholderQr().solve(apart);
      return std::hypot(1.0, std::sqrt(rest.squaredNorm() / static_cast<double>(rest.size())) / floor_rad_);
    };
    try {
      constexpr double kStep = 1.03;
      for (int i = 0; i < 3; ++i) {
        Arm arm = case_.arm;
        (i == 0 ? arm.inertia_kgm2 : i == 1 ? arm.damping_nms_per_rad : arm.stiffness_nm_per_rad) *= kStep;
        moved.col(i) = angle(arm, case_.effects) - own;
      }
      for (const Content& one : case_.contents) {
        if (one.simulated == Simulated::kAsItIs) continue;
        const Eigen::VectorXd other = angle(case_.arm, with_simulated(case_, one.id));
        // What changes the torques' channels leaves the angle as it is; it was given its strength by itself.
        if (other != own && gap_to(other) < kSmallestGap) return false;
      }
      case_.gap_over_floor = gap_to(angle(case_.arm, case_.simulated));
    } catch (const std::runtime_error&) {
      return false;
    }
    return true;
  }

 private:
  void note(Record record, const LinearRefit& fit) {
    case_.record = std::move(record);
    case_.linear_fit = fit.arm;
    case_.refit_nrmse = fit.nrmse;
    case_.floor_nrmse = fit.nrmse * floor_rad_ / fit.residual_rms_rad;
    case_.gap_over_floor = fit.residual_rms_rad / floor_rad_;
  }

  /// What acts before all effects.
  [[nodiscard]] Elements held() const {
    Elements elements;
    if (loop_) elements.push_back(held_by(*loop_, run_));
    return elements;
  }

  DrawnCase& case_;
  const Torques& torques_;
  const Run& run_;
  std::optional<PositionLoop> loop_;
  Setting setting_;
  double floor_rad_ = 0;
};

/// Brings the effect to the wanted gap: what it adds to the noise's square grows about with the square of its size.
/// False when it stays out of reach.
bool set_strength(Bench& bench, DrawnCase& what, DrawnEffect effect, double wanted) {
  constexpr int kTries = 5;
  constexpr double kNear = 1.12;  // of the wanted gap, either way
  const Kind& kind = kind_called(effect.id);
  for (int i = 0; i < kTries; ++i) {
    if (!bench.drive({effect})) {
      effect.numbers = scaled(kind, effect.numbers, 0.4);
      continue;
    }
    const double off = what.gap_over_floor / wanted;
    what.effects = {effect};
    if (kind.keeps_drawn_size) break;
    if (off < kNear && off > 1 / kNear) break;
    const double excess = std::max(what.gap_over_floor * what.gap_over_floor - 1, 1e-3);
    const double factor = std::clamp(std::sqrt((wanted * wanted - 1) / excess), 0.1, 6.0);
    effect.numbers = scaled(kind, effect.numbers, factor);
  }
  return what.effects.size() == 1 && what.gap_over_floor > kSmallestGap / kNear &&
         what.gap_over_floor < kLargestGap * 1.5 && what.refit_nrmse < kLargestNrmse;
}

double off_by(Draw& draw, double low, double high) { return 1 + draw.sign() * draw.between(low, high); }

Arm draw_simulation(const Contents& contents, const Arm& arm, Draw& draw) {
  if (contents.front().id == "none" || several_case(contents) == "exact") return arm;
  const bool parameters = contents.front().id == "parameters";
  const double low = parameters ? 0.2 : 0.0;
  const double high = parameters ? 0.6 : 0.08;
  return {arm.inertia_kgm2 * off_by(draw, low, high), arm.damping_nms_per_rad * off_by(draw, low, high),
          arm.stiffness_nm_per_rad * off_by(draw, low, high)};
}

std::string label_of(const Contents& contents) {
  if (several_case(contents) == "exact") return "none";
  const auto changed =
      std::ranges::find_if(contents, [](const Content& one) { return one.simulated != Simulated::kAsItIs; });
  const std::string& first = changed->id;
  return first == "none" || first == "parameters" || is_known(first) ? first : "unknown";
}

bool linear(const Contents& contents) { return contents.front().id == "none" || contents.front().id == "parameters"; }

/// One draw; false when its effects cannot be brought to a gap worth a diagnosis in this drive.
bool try_to_draw(const Contents& contents, std::uint64_t seed, bool held, DrawnCase& out) {
  out = DrawnCase{};
  out.seed = seed;
  out.label = label_of(contents);
  out.contents = contents;
  Draw wheel(seed, kWheel);
  out.task = held ? Task::kLoop : draw_task(contents, wheel);
  out.arm = draw_arm(out.task, wheel);
  out.sensors = draw_sensors(wheel);
  constexpr std::array kDurations = {60.0, 80.0, 100.0};
  out.duration_s = wheel.one_of<double>(kDurations);
  out.wheel_inertia_share = std::min(0.35, 0.035 / out.arm.inertia_kgm2);
  out.wheel_damping_share = wheel.between(0.05, 0.1) / out.arm.damping_nms_per_rad;
  const double unseen_share = wheel.chance(0.8) ? wheel.between(0.003, 0.02) : 0;
  Draw simulation(seed, kSimulation);
  out.simulation = draw_simulation(contents, out.arm, simulation);

  Run run;
  run.duration_s = out.duration_s;
  Draw drive_draw(seed, kDriveStream);
  Torques torques = draw_torques(out.task, out.arm, run, drive_draw);
  Signal net = torques.motor;
  net *= -1;
  net += torques.driver;
  std::optional<PositionLoop> loop;
  if (held) {
    Draw loop_draw(seed, kLoopStream);
    loop = draw_position_loop(out.arm, run, seed, loop_draw);
    net += torque_along(*loop, out.arm, run);
    out.sensors.angle_noise_rad = 0.1 * loop->noise_rad;  // most of it is what the loop answers
    out.sensors.angle_step_rad = 2e-5;
  }
  out.unseen_rms_nm = unseen_share * net.rms();
  if (out.unseen_rms_nm > 0) {
    torques.unseen = slow_torque(out.unseen_rms_nm, -run.lead_in_s - 1, run.duration_s + 1, seed + 1);
  }
  Bench bench(out, torques, run, std::move(loop));
  if (linear(contents)) return true;

  Draw effects(seed, kEffects);
  Draw strength(seed, kStrength);
  const bool bare = std::ranges::all_of(contents, [](const Content& one) { return one.simulated == Simulated::kNot; });
  const double least = !bare || contents.size() > 2 ? 2 : contents.size() == 2 ? 4 : kSmallestGap;
  const auto drawn_gap = [&](const Content& one) {
    if (contents.size() > 1 && !is_known(one.id)) return strength.log_between(kSmallestGap, kLargestRemainder);
    return strength.log_between(least, kLargestGap);
  };
  std::vector<DrawnEffect> all;
  for (const Content& one : contents) {
    const double wanted = drawn_gap(one);
    const Kind& kind = kind_called(one.id);
    if (!set_strength(bench, out, {one.id, kind.draw(effects, bench.setting())}, wanted)) return false;
    all.push_back(out.effects.front());
  }
  if (bare) {
    out.effects = all;
    return contents.size() == 1 || (bench.drive(all) && (contents.size() == 2 || bench.shows_changes()));
  }
  out.effects.clear();
  for (std::size_t i = 0; i < contents.size(); ++i) {
    const Simulated how = contents[i].simulated;
    if (how != Simulated::kAlone) out.effects.push_back(all[i]);
    if (how == Simulated::kNot) continue;
    out.simulated.push_back(all[i]);
    if (how != Simulated::kResized) continue;
    const double factor = simulation.chance(0.5) ? simulation.between(0.4, 0.65) : simulation.between(1.5, 2.5);
    out.simulated.back().numbers = scaled(kind_called(contents[i].id), all[i].numbers, factor);
    const auto size = [&](const DrawnEffect& one) { return one.numbers[kind_called(one.id).sizes.front().name]; };
    const double off = size(out.simulated.back()) / size(all[i]);
    if (off > 0.7 && off < 1.4) return false;  // what is physical ends there
  }
  return bench.drive(out.effects) && bench.shows_changes();
}

}  // namespace

DrawnCase draw_case(const Contents& contents, std::uint64_t seed, bool held) {
  constexpr std::uint64_t kTries = 1000;  // of some effects one drive in ten has the strength that was drawn
  DrawnCase out;
  for (std::uint64_t i = 0; i < kTries; ++i) {
    if (try_to_draw(contents, seed + 0x9e3779b9ULL * i, held, out)) return out;
  }
  throw std::runtime_error("no drive shows " + contents.front().id);
}

}  // namespace steerid::blind
