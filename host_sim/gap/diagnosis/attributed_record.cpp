// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/attributed_record.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "gap/attribution/attribution_coefficients.hpp"
#include "gap/attribution/what_is_left.hpp"
#include "gap/diagnosis/time_limit.hpp"
#include "gap/likelihood/noise_shape.hpp"
#include "gap/model/compared_parts.hpp"
#include "gap/model/simulated_model.hpp"

namespace steerid {
namespace {

/// No probabilities yet.
AttributedRecord compared(const PreparedRecord& prepared, const Simulation& simulation, const DiagnoseOptions& options,
                          std::vector<Effect> present) {
  AttributedRecord out;
  const ComparisonSetting setting = comparison_setting(prepared, simulation, options, std::move(present));
  out.comparison = compare(setting);
  note_runs(setting, compared_parts(setting.present), out.comparison.candidates);
  out.input = attribution_input(out.comparison, *prepared.whittle, simulation.wheel);
  return out;
}

/// The likeliest is asked last what it leaves to shapes without a name: they speak against that one alone.
void settle(AttributedRecord& record, const ComparisonSetting& setting) {
  record.probability = attribute(record.input, kAttribution);
  const std::size_t likeliest = likeliest_of(record.probability);
  Evidence& leading = record.input.all[likeliest];
  if (leading.id == "none") return;
  Candidate& asked = record.comparison.candidates[likeliest];
  note_shapes(setting, compared_parts(setting.present), asked);
  take_what_is_left(leading, asked);
  record.probability = attribute(record.input, kAttribution);
}

/// The first look at a record: beside what the simulation has.
class FirstLook {
 public:
  FirstLook(PreparedRecord& prepared, const Simulation& simulation, const DiagnoseOptions& options)
      : prepared_(prepared), simulation_(simulation), options_(options), there_(compared_parts(simulation.effects)) {}

  AttributedRecord take() {
    compare_all();
    if (const double late_s = found_late_s(); late_s != 0 && prepared_.look_again(simulation_, late_s)) compare_all();
    constexpr int kTimes = 4;
    for (int i = 0; i < kTimes && time_is_left() && lower_the_floor(); ++i) compare_all();
    if (time_is_left() && prepared_.spectral->spectra.step_rad() > 0 && round_as_the_best()) compare_all();
    out_.input.noise_departure = noise_departure();
    settle(out_, comparison_setting(prepared_, simulation_, options_, simulation_.effects));
    return std::move(out_);
  }

 private:
  void compare_all() { out_ = compared(prepared_, simulation_, options_, simulation_.effects); }

  bool time_is_left() { return time_for("a second look at the noise", options_, prepared_.notes); }

  /// By how much the angle is late where a delay explains the record best; 0 where it does not.
  [[nodiscard]] double found_late_s() const {
    const auto nats = [](const Candidate& one) { return one.fit.cost(kSeen); };
    const Candidate& best = *std::ranges::min_element(out_.comparison.candidates, {}, nats);
    return best.id == "delay" ? fitted_effect(best)->at("delay_s") : 0;
  }

  /// A floor that is known from above only comes down to what the best explanation leaves: a density that is far too
  /// large is made smaller by whatever makes the response smaller, rightly or not. Where nothing leaves as much as the
  /// floor the torque's channel holds what is no noise, such as vibration that no wheel follows.
  bool lower_the_floor() {
    constexpr double kThere = 0.8;
    const std::vector<Evidence>& all = out_.input.all;
    const bool any = std::ranges::any_of(all, &Evidence::eligible);
    if (any && !prepared_.whittle->white().at_most) return false;
    double least = 1;
    for (const Evidence& one : all) {
      if (one.eligible || !any) least = std::min(least, one.excess);
    }
    if (least > kThere) return false;
    prepared_.lower_torque_noise(least);
    return true;
  }

  /// Whether there is an effect whose run says where the wheel is within a step.
  bool round_as_the_best() {
    const auto nats = [](const Evidence& one) {
      const bool runs = one.eligible && one.id != "unmeasured_torque";
      return runs ? priced_nats(one) : std::numeric_limits<double>::infinity();
    };
    const std::vector<Evidence>& all = out_.input.all;
    const auto best = static_cast<std::size_t>(std::ranges::min_element(all, {}, nats) - all.begin());
    const Candidate& leading = out_.comparison.candidates[best];
    constexpr double kPlainly = 20;  // nats: less would not change where the wheel is within a step
    if (leading.type == nullptr || nats(all[best]) > nats(all[1]) - kPlainly) return false;
    return with_run_of(leading, [&](std::span<const double> run_rad) { prepared_.round_as(run_rad); });
  }

  /// Of what the run of the wheel, with what the simulation already has, leaves of the angle. A defect of the record
  /// says by itself why its noise is none.
  [[nodiscard]] double noise_departure() const {
    constexpr double kSensor_rad = 3e-6;  // what has less noise is a formula's, not a sensor's
    const bool measured = prepared_.whittle->white().angle_variance > kSensor_rad * kSensor_rad;
    double departure = 0;
    if (!measured || !prepared_.defects.found.empty()) return departure;
    with_run_of(out_.comparison.at("parameters"),
                [&](std::span<const double> run_rad) { departure = departure_from_normal(prepared_.record, run_rad); });
    return departure;
  }

  /// Hands the candidate's run on, one angle a sample, unless it diverges.
  template <class Use>
  bool with_run_of(const Candidate& one, Use&& use) const {
    SimulatedModel model(*prepared_.spectral, there_.with(one.type), there_.fixed);
    const std::span<const double> run_rad = model.run(one.fit.x);
    if (!run_rad.empty()) use(run_rad);
    return !run_rad.empty();
  }

  PreparedRecord& prepared_;
  const Simulation& simulation_;
  const DiagnoseOptions& options_;
  ComparedParts there_;
  AttributedRecord out_;
};

}  // namespace

const Evidence& likeliest(const AttributedRecord& record) { return record.input.all[likeliest_of(record.probability)]; }

ComparisonSetting comparison_setting(const PreparedRecord& prepared, const Simulation& simulation,
                                     const DiagnoseOptions& options, std::vector<Effect> present) {
  return {.record = *prepared.spectral,
          .whittle = *prepared.whittle,
          .sim = simulation.wheel,
          .refit = prepared.refit,
          .closest = prepared.closest,
          .present = std::move(present),
          .without = options.without,
          .threads = options.threads};
}

AttributedRecord attributed_record(PreparedRecord& prepared, const Simulation& simulation,
                                   const DiagnoseOptions& options) {
  return FirstLook(prepared, simulation, options).take();
}

AttributedRecord attributed_beside(const PreparedRecord& prepared, const Simulation& simulation,
                                   const DiagnoseOptions& options, std::vector<Effect> present) {
  AttributedRecord out = compared(prepared, simulation, options, present);
  settle(out, comparison_setting(prepared, simulation, options, std::move(present)));
  return out;
}

}  // namespace steerid
