// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include "gap/diagnosis/diagnosing.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/set_answer.hpp"
#include "gap/diagnosis/time_limit.hpp"
#include "gap/diagnosis/together.hpp"
#include "log/angle_clock.hpp"
#include "log/bad_input.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {

namespace {

/// Of every cause the first parameter, where it differs.
void name_differing_sizes(Together& together, std::span<const NamedRecord> records) {
  for (Cause& cause : together.records.front().causes) {
    for (const SharedNumber& number : together.numbers) {
      const EffectType& type = *cause.effect.type;
      if (!number.differs || number.of != type.id || number.parameter != type.parameters.front().name) continue;
      for (std::size_t i = 0; i < records.size(); ++i) {
        cause.elsewhere.emplace_back(records[i].name, number.values[i].value);
      }
    }
  }
}

double times_the_noise(const Diagnosis& answer) { return answer.gap.with_effect_nrmse / answer.gap.floor_nrmse; }

/// Of records that nothing explains together.
std::string missed_words(const Together& together, std::span<const NamedRecord> records) {
  std::vector<std::string> missed;
  for (std::size_t i = 0; i < records.size(); ++i) {
    missed.push_back(
        fmt::format("{:.3g} times its noise in {}", times_the_noise(together.records[i]), records[i].name));
  }
  return fmt::format(
      "what the answer leaves of the held-out part is {}: one record that is another wheel's, or has a sensor that "
      "failed, leaves all of them unexplained",
      fmt::join(missed, ", "));
}

/// A record whose angle is read by the torques' clock, before it is searched.
class OnOneClock {
 public:
  /// As the log has it.
  OnOneClock(const Record& record, const Simulation& simulation, const DiagnoseOptions& options)
      : record_(&record), simulation_(&simulation), options_(&options), look_(looked()) {}

  [[nodiscard]] Diagnosing& look() { return *look_; }
  [[nodiscard]] std::unique_ptr<Diagnosing> taken() && { return std::move(look_); }
  [[nodiscard]] bool moved() const { return !clock_.is_the_torques(); }

  /// Reads the angle by another clock, where a drift that is left matters, or where most of what is left is a delay
  /// that rows of the log may make. False where neither is.
  bool move() {
    const bool drifts = take_drift();
    return take_delay() || drifts;
  }

  /// Whether rows of the log may make the angle later by so much: it is read so then.
  bool move_by(double late_s) {
    if (!(std::abs(clock_.late_s + late_s) <= look_->message_told_to_s())) return false;
    clock_.late_s += late_s;
    look_ = looked();
    return true;
  }

 private:
  using Course = ClockError::Course;
  static constexpr int kTimes = 3;  // they are read off to first order, and beside what else is missing

  bool take_drift() {
    std::optional<ClockError> drift = look_->clock_error(Course::kGrowing);
    if (!drift || !drift->matters()) return false;
    for (int i = 0; i < kTimes && drift && drift->is_plain() && !options_->out_of_time(); ++i) {
      clock_.later_per_s += drift->size;
      look_ = looked();
      drift = look_->clock_error(Course::kGrowing);
    }
    return true;
  }

  bool take_delay() {
    if (!(look_->message_told_to_s() > 0)) return false;
    std::optional<ClockError> delay = look_->clock_error(Course::kConstant);
    if (!delay || !delay->matters()) return false;
    bool taken = false;
    for (int i = 0; i < kTimes && delay && delay->is_plain() && move_by(delay->size); ++i) {
      taken = true;
      delay = look_->clock_error(Course::kConstant);
    }
    return taken;
  }

  [[nodiscard]] std::unique_ptr<Diagnosing> looked() const {
    return std::make_unique<Diagnosing>(*record_, *simulation_, *options_, 0, clock_);
  }

  const Record* record_;
  const Simulation* simulation_;
  const DiagnoseOptions* options_;
  AngleClock clock_{};
  std::unique_ptr<Diagnosing> look_;
};

/// The answer with the angle read by the torques' clock; nothing where nothing of it matters, or where the record stays
/// unknown.
std::optional<Diagnosis> answer_on_one_clock(OnOneClock& clock) {
  constexpr int kTimes = 2;  // a drift beside what is missing is known better once that is
  for (int i = 0; i < kTimes && clock.move(); ++i) {
    Diagnosis answer = clock.look().answer();
    if (answer.verdict != "unknown") return answer;
  }
  return std::nullopt;
}

/// A delay that is named beside what else is missing, or a lag as short, s; 0 where none is.
double named_delay_s(const Diagnosis& answer) {
  for (const Cause& cause : answer.causes) {
    const bool delays = cause.effect.type == &effect::delay || cause.effect.type == &effect::lag;
    if (delays && cause.change == ChangeKind::kAdd) return cause.effect.values.front();
  }
  return 0;
}

}  // namespace

Diagnosis diagnose(const Record& record, const Simulation& simulation, const DiagnoseOptions& options) {
  OnOneClock clock(record, simulation, options);
  if (std::optional<Diagnosis> mended = answer_on_one_clock(clock)) return std::move(*mended);
  const bool tried = clock.moved();
  if (tried) clock = OnOneClock(record, simulation, options);
  Diagnosis answer = clock.look().answer();
  const bool reports_something_new = clock.look().reports_something_new(answer);
  if (answer.verdict == "unknown" && !tried) {  // what is missing hid a drift
    if (std::optional<Diagnosis> mended = answer_on_one_clock(clock)) return std::move(*mended);
  }
  if (const double late_s = named_delay_s(answer); !tried && late_s != 0 && clock.move_by(late_s)) {
    Diagnosis beside = clock.look().answer();
    if (beside.verdict != "unknown") return beside;
  }
  if (!reports_something_new) return answer;
  if (!time_for("a second look, as what was held out holds something that the rest of the record does not show,",
                options, answer.notes)) {
    return answer;
  }
  Diagnosing second(record, simulation, options, 1);
  Diagnosis again = second.answer();
  const bool names = !again.causes.empty() && !again.surrogate;
  if (!names || times_the_noise(again) >= times_the_noise(answer)) return answer;
  again.notes.emplace_back(
      "what was held out at first holds something that the rest of the record does not show: the parts have changed "
      "places, and what reports now has fitted before");
  return again;
}

Together diagnose_together(std::span<const NamedRecord> records, const Simulation& simulation,
                           const DiagnoseOptions& options) {
  std::vector<std::unique_ptr<Diagnosing>> all;
  std::vector<SetAnswer*> answers;
  for (const NamedRecord& one : records) {
    options.at_part(0.7 * static_cast<double>(all.size()) / static_cast<double>(records.size()));
    try {
      OnOneClock clock(one.record, simulation, options);
      clock.move();
      all.push_back(std::move(clock).taken());
      answers.push_back(&all.back()->searched_together());
    } catch (const BadInput& error) {
      throw BadInput(fmt::format("{}: {}", one.name, error.what()));
    }
  }
  SetAnswer::join(answers);
  // A change is refused that no record's held-out part needs.
  for (bool refused = true; refused;) {
    options.at_part(0.8);
    SetAnswer::share_named(answers);
    std::vector<const EffectType*> idle;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i]->measure();
      const std::vector<const EffectType*> own = all[i]->idle_changes();
      if (i == 0) idle = own;
      std::erase_if(idle, [&](const EffectType* type) { return std::ranges::find(own, type) == own.end(); });
    }
    refused = !idle.empty();
    for (SetAnswer* answer : answers) {
      if (refused) answer->refuse(*idle.front());
    }
  }
  Together out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    out.records.push_back(all[i]->finished());
  }
  widen_shared_sizes(out.records);
  out.numbers = shared_numbers(out.records);
  for (const SharedNumber& number : out.numbers) {
    if (number.differs) out.records.front().notes.push_back(difference_words(number, records));
  }
  name_differing_sizes(out, records);
  if (out.records.front().verdict == "unknown") out.records.front().notes.push_back(missed_words(out, records));
  return out;
}

}  // namespace steerid::gap
