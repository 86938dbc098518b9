// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/prepared_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/amplitude_fit.hpp"
#include "fit/autoregression.hpp"
#include "gap/likelihood/fast_part.hpp"
#include "gap/likelihood/held_out_split.hpp"
#include "gap/likelihood/piece_lines.hpp"
#include "gap/likelihood/rounding_spectrum.hpp"
#include "gap/likelihood/student.hpp"
#include "gap/preparation/between_steps.hpp"
#include "gap/preparation/driven_band.hpp"
#include "gap/preparation/lost_samples.hpp"
#include "gap/preparation/record_gates.hpp"
#include "gap/preparation/sampled_record.hpp"
#include "gap/preparation/steered_band.hpp"
#include "log/angle_clock.hpp"
#include "log/bad_input.hpp"
#include "log/frozen_channels.hpp"
#include "log/record_quality.hpp"
#include "log/resample.hpp"
#include "log/spikes.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// The record with the held-out part's angle unknown.
Record without_held_out(Record record, const std::vector<Block>& blocks) {
  for (const Block& block : blocks) {
    if (block.role != Block::Role::kReport) continue;
    for (std::size_t i = block.first; i < block.first + block.count; ++i) {
      record.angle_rad[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return record;
}

BatchFit first_fit_of(const Record& record, const std::vector<Block>& blocks, const Simulation& simulation,
                      FitOptions::Noise noise = FitOptions::Noise::kAutoregressive, bool torque_offset = false) {
  FitOptions options;
  options.torque_offset = torque_offset;
  options.between = simulation.torque_between_samples;
  options.convergence_factor = false;
  options.noise = noise;
  return fit_batch(without_held_out(record, blocks), options);
}

/// What a record's torques leave of its angle, -log likelihood up to a constant, the held-out part left out: by the
/// nearest linear wheel.
double nats_by_linear_wheel(const Record& record, const std::vector<Block>& blocks, const Simulation& simulation) {
  return static_cast<double>(record.size()) / 2 * std::log(first_fit_of(record, blocks, simulation).noise_sd_rad);
}

/// The same by the simulation as it is. Infinite where its run diverges.
double nats_by_simulation(const Record& record, const std::vector<Block>& blocks, const Simulation& simulation) {
  constexpr int kLongestNoise = 30;  // samples
  const std::vector<double> run = restarted_run(simulation, record, run_stretches(record, blocks, false));
  std::vector<Eigen::VectorXd> left;
  for (const Block& block : blocks) {
    if (block.role == Block::Role::kReport) continue;
    const auto rows = [&](const std::vector<double>& all) {
      return Eigen::Map<const Eigen::VectorXd>(&all[block.first], static_cast<Eigen::Index>(block.count));
    };
    left.emplace_back(rows(record.angle_rad) - rows(run));
    if (!left.back().allFinite()) return std::numeric_limits<double>::infinity();
  }
  return Autoregression::fit(left, kLongestNoise).misfit(left) / 2;
}

/// Flat tops that a record was made with, on purpose, look like clipped ones unless noise was clipped with them, and
/// the peaks of a drive that repeats itself crowd. If rebuilding them lets neither the linear wheel nor a simulation
/// with effects predict better than flat ones do, and than the record as it is, by a factor that chance does not make,
/// they were never clipped. Flat are those without their noise, which the rebuilt ones lack as well.
void drop_idle_saturation(RecordDefects& defects, const Record& record, const std::vector<Block>& blocks,
                          const Simulation& simulation) {
  const auto found = defects.find("torque_saturation");
  if (found == defects.found.end() || found->certain) return;
  Record clipped = defects.repaired;
  clipped.torque_driver_nm = record.torque_driver_nm;
  clipped.torque_motor_nm = record.torque_motor_nm;
  Record flat = clipped;
  const double limit_nm = found->effect.at("limit_nm");
  const auto flatten = [limit_nm](std::vector<double>& torque, const std::vector<double>& rebuilt) {
    for (std::size_t i = 0; i < torque.size(); ++i) {
      if (torque[i] != rebuilt[i]) torque[i] = std::copysign(limit_nm, torque[i]);
    }
  };
  flatten(flat.torque_driver_nm, defects.repaired.torque_driver_nm);
  flatten(flat.torque_motor_nm, defects.repaired.torque_motor_nm);
  const auto gained = [&](auto nats) {
    const auto of = [&](const Record& one) { return nats(one, blocks, simulation); };
    return std::min(of(flat), of(clipped)) - of(defects.repaired);
  };
  constexpr double kNats = 15;
  if (gained(nats_by_linear_wheel) > kNats) return;
  if (!simulation.effects.empty() && gained(nats_by_simulation) > kNats) return;
  defects.found.erase(found);
  defects.repaired = std::move(clipped);
  defects.hidden.clear();
}

/// Whether a spring brings the wheel back before long: the simulation has one, and the record does not contradict; or
/// the record shows one, as that of a pendulum does, whose weight the simulation may lack.
bool comes_back(const BatchFit& fit, const Simulation& simulation) {
  constexpr double kLong_s = 5.0;
  const double doubt = kOnceIn16000 * fit.stiffness.sd;
  const bool simulated =
      memory_s(simulation.wheel) < kLong_s && fit.stiffness.value + doubt > simulation.wheel.stiffness_nm_per_rad / 5;
  return simulated || (memory_s(fit.wheel()) < kLong_s && fit.stiffness.value > doubt);
}

/// Where an effect is strong the linear refit can lose its inertia altogether, and a motion that is worked out with it
/// is no motion; nor is one that is pushed away, by a spring or a damping that is found below zero.
WheelArm within_reach(WheelArm fitted, const WheelArm& sim) {
  const auto limited = [](double value, double around) {
    return around > 0 ? std::clamp(value, around / kWheelWithin, around * kWheelWithin) : std::max(value, 0.0);
  };
  fitted.inertia_kgm2 = limited(fitted.inertia_kgm2, sim.inertia_kgm2);
  fitted.damping_nms_per_rad = limited(fitted.damping_nms_per_rad, sim.damping_nms_per_rad);
  fitted.stiffness_nm_per_rad = limited(fitted.stiffness_nm_per_rad, sim.stiffness_nm_per_rad);
  return fitted;
}

std::string note_on_driven_lines(double highest_hz) {
  return fmt::format(
      "the torque answers the measured angle, as a position loop does: lines up to {:g} Hz are compared, where it "
      "drives the wheel",
      highest_hz);
}

/// Squared gain from torque to angle on every line.
Eigen::VectorXd passed_by(const WheelArm& wheel, const BlockSpectra& spectra) {
  const WheelArm sprung = with_a_spring(wheel);
  Eigen::VectorXd gain(spectra.bins());
  for (Eigen::Index k = 0; k < gain.size(); ++k) gain[k] = std::norm(wheel_response(sprung, spectra.omega()[k]));
  return gain;
}

/// What clipped torques hid becomes part of the floor, as far as it moves the wheel by more than noise does.
void hide(const std::vector<HiddenTorque>& hidden, const Eigen::VectorXd& gain, const NoiseFloor& floor, bool held,
          BlockSpectra& spectra) {
  if (hidden.empty()) return;
  for (const HiddenTorque& one : hidden) spectra.hide(one.first, one.shapes_nm, held);
  constexpr double kNegligible = 0.5;  // of the noise of one line
  spectra.condense_hidden(gain.cwiseQuotient(floor.density(spectra, gain)).cwiseSqrt(), kNegligible);
}

/// The torques' noise is known apart from them where the channels hold nothing else above the drive.
KnownTorque known_of(const Record& record, const NoiseFloor& floor, double pass_hz) {
  if (floor.at_most) return {record};
  return known_torque(record, white_noise_variance(record.torque_driver_nm, record, pass_hz),
                      white_noise_variance(record.torque_motor_nm, record, pass_hz));
}

/// What is left of the noise on every bin: the mean over the lines of its stretch that are nearest to it.
Eigen::VectorXd left_on(const BlockSpectra& spectra, const std::vector<KnownTorque::Left>& left) {
  Eigen::VectorXd share = Eigen::VectorXd::Ones(spectra.bins());
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    const auto of = std::ranges::find_if(left, [&](const KnownTorque::Left& one) {
      return one.first <= bins.block.first && bins.block.first + bins.block.count <= one.end;
    });
    if (of == left.end()) continue;
    const auto last = static_cast<double>(of->share.size() - 1);
    const double lines_a_bin = static_cast<double>(of->end - of->first) / static_cast<double>(bins.block.count);
    for (Eigen::Index k = 0; k < bins.count; ++k) {
      const auto place = static_cast<double>(bins.below + k);
      const auto line = [&](double at) { return static_cast<std::size_t>(std::clamp(std::round(at), 0.0, last)); };
      const std::size_t from = line((place - 0.5) * lines_a_bin);
      const std::size_t to = line((place + 0.5) * lines_a_bin);
      double sum = 0;
      for (std::size_t i = from; i <= to; ++i) sum += of->share[i];
      share[bins.first + k] = sum / static_cast<double>(to - from + 1);
    }
  }
  return share;
}

}  // namespace

PreparedRecord::PreparedRecord(const Record& log, const Simulation& simulation, const std::vector<std::string>& without,
                               std::size_t turn, const std::optional<double>& origin,
                               const PredictionRemainder& remainder, const AngleClock& clock)
    : origin_s(origin.value_or(log.time_s.empty() ? 0.0 : log.time_s.front())) {
  require_usable(log);
  Record mended = log;
  const Spikes spikes = mend_spikes(mended);
  if (spikes.all() > 0) notes.push_back(spikes.note());
  if (std::string frozen = leave_out_frozen(mended).note(); !frozen.empty()) notes.push_back(std::move(frozen));
  Resampled resampled = resample_100hz(mended);
  for (std::string& note : resampled.notes()) notes.push_back(std::move(note));
  message_told_to_s = resampled.message_told_to_s;
  const std::optional<double> in_step_s = resampled.in_step_s();
  for (std::string& note : clock_notes(clock, log.time_s.back() - log.time_s.front(), in_step_s)) {
    notes.push_back(std::move(note));
  }
  resampled.record = by_one_clock(std::move(resampled.record), clock, in_step_s);
  const std::optional<SteeredBand> steered = steered_band(resampled.record);
  const auto rows = static_cast<double>(resampled.record.size());
  record = sampled_record(std::move(resampled.record));
  for (double& stamp : record.time_s) stamp -= origin_s;
  if (const auto kept = static_cast<double>(record.size()); kept < 0.9 * rows) {
    notes.push_back(
        fmt::format("the record is {:.0f} minutes long: pieces of {:g} s, {:.0f} minutes in all, spread evenly "
                    "over it, are looked at",
                    rows / kResampledRateHz / 60, kPiece_s, kept / kResampledRateHz / 60));
  }
  pass_hz_ = resampled.filtered ? anti_alias_for(resampled.source_rate_hz).pass_hz : kAllPassed_hz;
  defects = record_defects(record);
  std::erase_if(defects.found, [&](const RecordDefect& one) {
    return std::ranges::find(without, one.effect.type->id) != without.end();
  });
  if (defects.found.empty()) {
    defects.repaired = record;
    defects.hidden.clear();
  }
  take_off(remainder);
  if (steered) take_off_steering(steered->to_hz, simulation);
  blocks = held_out_split(record, turn);
  const auto tells_noise = [](const GapFreeRows& rows_between) { return rows_between.size() >= kPieceRows; };
  if (blocks.empty() || std::ranges::none_of(gap_free_rows(record), tells_noise)) {
    throw BadInput(fmt::format(
        "too little between the record's gaps: expected a stretch of 6 s, or four of 0.7 s one of which has "
        "{:g} s; record a longer drive, and lose no samples",
        static_cast<double>(kPieceRows) / kResampledRateHz));
  }
  drop_idle_saturation(defects, record, blocks, simulation);
  const BatchFit first = first_fit_of(defects.repaired, blocks, simulation);
  const BatchFit white = first_fit_of(defects.repaired, blocks, simulation, FitOptions::Noise::kWhite);
  closest = within_reach(white.wheel(), simulation.wheel);
  const auto left = [&](const BatchFit& fit) {
    return free_run_nrmse(defects.repaired.angle_rad, fit.angle_model_rad).value_or(1);
  };
  // A wheel that a weight or a driver holds off its zero moves by what is left of the torque.
  const auto left_beside_offset = [&] {
    return left(first_fit_of(defects.repaired, blocks, simulation, FitOptions::Noise::kWhite, true));
  };
  for (std::string& note : require_excited(first, left(white), left_beside_offset)) {
    notes.push_back(std::move(note));
  }
  refit = within_reach(first.wheel(), simulation.wheel);
  drifts = !comes_back(first, simulation);
  if (drifts) {
    notes.emplace_back("no spring brings the wheel back, so that free runs drift: they begin anew at every block");
  }
  NoiseFloor floor = NoiseFloor::of(defects.repaired, refit, pass_hz_);
  floor.lowest_hz = lowest_hz;
  if (steered) floor.steering_tail_nm = steered->tail_nm;
  const DrivenBand driven = driven_band(defects.repaired, pass_hz_);
  floor.at_most = !driven.noise_alone_above;
  const bool lossy = defects.find("sample_loss") != defects.found.end();
  if (lossy) floor.angle_variance = std::max(floor.angle_variance, kept_noise_variance(record.angle_rad, defects.lost));
  known = known_of(defects.repaired, floor, pass_hz_);
  compare_up_to(simulation, lowest_hz > 0 ? kHighest_hz : driven.highest_hz, floor);  // a bar is no loop's torque
}

void PreparedRecord::take_off(const PredictionRemainder& remainder) {
  remainder_rad.assign(record.size(), 0.0);
  // What was rounded is known by its steps, which it would not have any more.
  if (defects.find("coarse_quantization") != defects.found.end()) return;
  remainder_rad = angles_at(log_stamps_s(), remainder.time_s, remainder.angle_rad);
  for (std::size_t i = 0; i < record.size(); ++i) {
    record.angle_rad[i] -= remainder_rad[i];
    defects.repaired.angle_rad[i] -= remainder_rad[i];
  }
}

void PreparedRecord::take_off_steering(double below_hz, const Simulation& simulation) {
  const auto stands = [](const Effect& effect) {
    const Hypothesis* hypothesis = hypothesis_of(*effect.type);
    return hypothesis != nullptr && hypothesis->stands_beside_steering();
  };
  // Beside the steering an angle's steps are noise; what else is wrong with a record is mended on the whole of it.
  const auto is_noise = [](const RecordDefect& one) { return one.effect.type == &effect::coarse_quantization; };
  if (!std::ranges::all_of(simulation.effects, stands) || !std::ranges::all_of(defects.found, is_noise)) return;
  defects.found.clear();
  lowest_hz = below_hz;
  record = fast_part(std::move(record), lowest_hz);
  defects.repaired = fast_part(std::move(defects.repaired), lowest_hz);
  for (const auto& hypothesis : hypotheses()) {
    if (!hypothesis->stands_beside_steering()) untold.emplace_back(hypothesis->type().id);
  }
  untold.emplace_back(effect::unmeasured_torque.id);
}

std::vector<double> PreparedRecord::run(const Simulation& simulation) const {
  return without_drift(restarted_run(simulation, record, stretches), lowest_hz);
}

std::vector<double> PreparedRecord::log_stamps_s() const {
  std::vector<double> stamps_s = record.time_s;
  for (double& stamp_s : stamps_s) stamp_s += origin_s;
  return stamps_s;
}

void PreparedRecord::compare_up_to(const Simulation& simulation, double highest_hz, NoiseFloor floor) {
  highest_hz_ = highest_hz;
  if (highest_hz < kHighest_hz) notes.push_back(note_on_driven_lines(highest_hz));
  std::vector<Block> seen;
  std::ranges::copy_if(blocks, std::back_inserter(seen),
                       [](const Block& block) { return block.role != Block::Role::kReport; });
  const bool held = simulation.torque_between_samples == TorqueSignal::Between::kHeld;
  spectral = std::make_unique<SpectralRecord>(known.record, refit, seen, held, drifts, highest_hz, lowest_hz);
  if (!known.left.empty()) spectral->spectra.leave_of_torque_noise(left_on(spectral->spectra, known.left));
  if (!defects.lost.empty()) {
    BlockSpectra& spectra = spectral->spectra;
    spectra.rebuild(rebuilt_noise_gain(defects.lost, spectra.omega(), kResampledRateHz));
  }
  const Eigen::VectorXd passed = passed_by(refit, spectral->spectra);
  spectral->spectra.count_torque_noise_by(passed);
  stretches = run_stretches(record, blocks, drifts);
  hide(defects.hidden, passed, floor, held, spectral->spectra);
  take(floor);
  if (defects.find("coarse_quantization") == defects.found.end()) return;
  Simulation nearest = simulation;
  nearest.wheel = closest;
  round_as(restarted_run(nearest, record, stretches));
}

void PreparedRecord::take(const NoiseFloor& floor) {
  whittle = std::make_unique<Whittle>(spectral->spectra, floor, spectral->applied_rms_nm);
}

bool PreparedRecord::look_again(const Simulation& simulation, double late_s) {
  if (lowest_hz > 0) return false;
  const double highest_hz = driven_band(defects.repaired, pass_hz_, late_s).highest_hz;
  if (!(highest_hz < highest_hz_)) return false;
  std::erase(notes, note_on_driven_lines(highest_hz_));
  compare_up_to(simulation, highest_hz, whittle->white());
  return true;
}

void PreparedRecord::lower_torque_noise(double factor) {
  NoiseFloor floor = whittle->white();
  floor.torque_variance *= factor;
  floor.at_most = true;
  take(floor);
}

void PreparedRecord::count_as_noise(const FastTorque& torque) {
  NoiseFloor floor = whittle->white();
  floor.fast = torque;
  take(floor);
}

void PreparedRecord::round_as(std::span<const double> run_rad) {
  std::vector<double> motion_rad(run_rad.begin(), run_rad.end());
  for (double& angle : motion_rad) {
    if (!std::isfinite(angle)) angle = 0;  // outside all blocks
  }
  const double step_rad = defects.find("coarse_quantization")->effect.at("step_rad");
  if (!drifts) {
    Record passed = defects.repaired;
    passed.angle_rad = between_steps(passed, motion_rad, step_rad);
    spectral->motion = motion_carried_by(passed, motion_rad, spectral->motion);
  }
  spectral->spectra.round(step_rad, rounding_spectrum(spectral->spectra, motion_rad, step_rad));
}

}  // namespace steerid::gap
