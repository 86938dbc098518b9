// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/drawn_case.hpp"

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

enum Stream : std::uint64_t { kDeck = 1, kWheel, kDriveStream, kEffects, kStrength, kSimulation, kLoopStream };

constexpr double kSmallestGap = 1.5;
constexpr double kLargestGap = 25;
constexpr double kLargestNrmse = 0.5;  // beyond it there is hardly a wheel left to diagnose

void shuffle(std::vector<Contents>& deck, Draw& draw) {
  for (std::size_t i = deck.size(); i > 1; --i) std::swap(deck[i - 1], deck[draw.index(i)]);
}

Task draw_task(const Contents& contents, Draw& draw) {
  for (const std::string& id : contents) {
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

/// Brings the effect to the wanted gap: what it adds to the floor's square grows about with the square of its size.
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
  if (contents.front() == "none") return arm;
  const bool parameters = contents.front() == "parameters";
  const double low = parameters ? 0.2 : 0.0;
  const double high = parameters ? 0.6 : 0.08;
  return {arm.inertia_kgm2 * off_by(draw, low, high), arm.damping_nms_per_rad * off_by(draw, low, high),
          arm.stiffness_nm_per_rad * off_by(draw, low, high)};
}

std::string label_of(const Contents& contents) {
  const std::string& first = contents.front();
  return first == "none" || first == "parameters" || is_known(first) ? first : "unknown";
}

bool linear(const Contents& contents) { return contents.front() == "none" || contents.front() == "parameters"; }

/// One draw; false when its effects cannot be brought to a gap worth a diagnosis in this drive.
bool try_to_draw(const Contents& contents, std::uint64_t seed, bool held, DrawnCase& out) {
  out = DrawnCase{};
  out.seed = seed;
  out.label = label_of(contents);
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
  std::vector<DrawnEffect> all;
  for (const std::string& id : contents) {
    const double wanted =
        contents.size() == 1 ? strength.log_between(kSmallestGap, kLargestGap) : strength.log_between(4, kLargestGap);
    if (!set_strength(bench, out, {id, kind_called(id).draw(effects, bench.setting())}, wanted)) return false;
    all.push_back(out.effects.front());
  }
  out.effects = all;
  return contents.size() == 1 || bench.drive(all);
}

}  // namespace

std::vector<Contents> draw_contents(std::size_t count, std::uint64_t seed) {
  Draw draw(seed, kDeck);
  std::vector<Contents> all;
  while (all.size() < count) {
    std::vector<Contents> deck(4, {"none"});
    deck.insert(deck.end(), 4, {"parameters"});
    for (const Kind* kind : vocabulary()) deck.insert(deck.end(), 2, {std::string(kind->id)});
    for (const Kind* kind : outside()) deck.push_back({std::string(kind->id)});
    shuffle(deck, draw);
    all.insert(all.end(), deck.begin(), deck.end());
  }
  all.resize(count);
  return all;
}

namespace {

/// An offset b of the torque beside dry friction of F+ and F-, sliding or stuck, is dry friction of F+ + b and F- - b,
/// which is one effect while b is the smaller.
bool is_one_effect(const Contents& pair) {
  return pair.back() == "torque_bias" && (pair.front() == "coulomb_friction" || pair.front() == "asymmetric_friction");
}

}  // namespace

std::vector<Contents> draw_pairs(std::size_t count, std::uint64_t seed) {
  Draw draw(seed, kDeck);
  const auto families = std::array{friction_kinds(), joint_kinds(), torque_kinds(), record_kinds()};
  std::vector<Contents> all;
  while (all.size() < count) {
    // Families in their order: what a sensor adds it adds to whatever it measures, a hand that is away too.
    const std::size_t drawn = draw.index(families.size());
    const std::size_t beside = (drawn + 1 + draw.index(families.size() - 1)) % families.size();
    const auto one = families[std::min(drawn, beside)];
    const auto other = families[std::max(drawn, beside)];
    Contents pair = {std::string(one[draw.index(one.size())].id), std::string(other[draw.index(other.size())].id)};
    if (!is_one_effect(pair)) all.push_back(std::move(pair));
  }
  return all;
}

DrawnCase draw_case(const Contents& contents, std::uint64_t seed, bool held) {
  constexpr std::uint64_t kTries = 1000;  // of some effects one drive in ten has the strength that was drawn
  DrawnCase out;
  for (std::uint64_t i = 0; i < kTries; ++i) {
    if (try_to_draw(contents, seed + 0x9e3779b9ULL * i, held, out)) return out;
  }
  throw std::runtime_error("no drive shows " + contents.front());
}

}  // namespace steerid::blind
