// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identify_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "apps/identification_json.hpp"
#include "apps/identify_page.hpp"
#include "apps/made_from.hpp"
#include "apps/over_time.hpp"
#include "apps/unit_words.hpp"
#include "fit/clock_check.hpp"
#include "fit/unit_check.hpp"
#include "fit/wheel_friction.hpp"
#include "log/angle_clock.hpp"
#include "log/bad_input.hpp"
#include "log/frozen_channels.hpp"
#include "log/log_reader.hpp"
#include "log/spikes.hpp"
#include "report/page.hpp"

namespace steerid {
namespace {

Scalar scalar_of(const std::string& text) {
  if (text == "double") return Scalar::kDouble;
  return text == "fixed" ? Scalar::kFixed : Scalar::kFloat;
}

std::optional<bool> offset_of(const std::string& text) {
  if (text == "auto") return std::nullopt;
  return text == "yes";
}

/// One sentence on how long the record is and what was done to it.
std::string summary(const Record& record, const RecordQuality& seen, const Resampled& resampled) {
  std::string text = fmt::format("{:.1f} s, {} rows at {:.4g} Hz", record.time_s.back() - record.time_s.front(),
                                 seen.rows, 1.0 / seen.median_period_s);
  if (resampled.filtered) {
    text += ", filtered and resampled to 100 Hz";
  } else if (!resampled.untouched) {
    text += ", put on an even grid of 100 Hz";
  }
  if (!seen.gaps.empty()) text += fmt::format(", {} gap{}", seen.gaps.size(), seen.gaps.size() == 1 ? "" : "s");
  if (seen.dropped_rows > 0) text += fmt::format(", {} incomplete rows left out", seen.dropped_rows);
  return text;
}

/// Of an answer's or a fit's J, B and C.
template <class Found>
bool any_valid(const Found& inertia, const Found& damping, const Found& stiffness) {
  return std::ranges::any_of(std::array{inertia.state, damping.state, stiffness.state},
                             [](ParameterState state) { return state == ParameterState::kValid; });
}

/// `found` is the answer to the record. Where neither the driver's own torque nor a probe is in the record there is
/// nothing to check, unless one arm explains the whole of it: then the driver did next to nothing.
Evidence evidence_of(const Resampled& resampled, const Identification& found, bool torque_offset,
                     const std::optional<BareWheelFit>& bare) {
  const Record& record = resampled.record;
  Evidence out;
  out.anything_valid = any_valid(found.inertia_kgm2, found.damping_nms_per_rad, found.stiffness_nm_per_rad);
  if (!voluntary_torque_known(record.equation())) {
    const InstrumentalFit fit = bare ? bare->wheel : fit_by_instrument(record);
    out.probe_recorded = has_a_probe(record);
    out.probe = probe_misfit(fit);
    out.record_tells = any_valid(fit.inertia, fit.damping, fit.stiffness);
    if (out.probe || !out.record_tells) return out;
    torque_offset = true;  // the bar's own zero
  }
  out.check = check_model(resampled, torque_offset);
  return out;
}

/// By --wheel, by the record itself with the hands off, or by its two sensors; nothing where none of them tells.
std::optional<WheelFrictionFound> known_friction(const std::optional<WheelAlone>& given,
                                                 const std::optional<BareWheelFit>& bare, const Record& record) {
  if (given) {
    if (!(given->friction.value > 0)) return std::nullopt;
    return WheelFrictionFound{given->friction.value, given->from};
  }
  if (bare) return WheelFrictionFound{bare->friction.value, "this record, in which nobody holds it"};
  const std::optional<FittedNumber> between = friction_between_sensors(record);
  if (!between) return std::nullopt;
  return WheelFrictionFound{between->value, "torque_rim and torque_bar"};
}

}  // namespace

nlohmann::ordered_json IdentifyRequest::json() const {
  nlohmann::ordered_json json = {{"columns", log.columns},
                                 {"sign", log.sign},
                                 {"scalar", scalar},
                                 {"batch", batch},
                                 {"torque_offset", torque_offset}};
  if (!wheel.empty()) json["wheel"] = wheel.string();
  if (log.align) json["align"] = true;
  for (const auto& file : log.with) json["with"].push_back(input_json(file));
  for (const auto& file : log.dbc) json["dbc"].push_back(input_json(file));
  return json;
}

constexpr const char* kArmChanges =
    "the arm changes in this record: the batch's J, B and C are means, and their deviations hold how far it goes";

ReadLog read_log(const std::filesystem::path& log, const IdentifyRequest& request) {
  ReadLog out;
  out.log = log;
  out.record = request.log.read(log, &out.seen);
  return out;
}

IdentifiedLog identify_log(const ReadLog& log, const IdentifyRequest& request) {
  IdentifiedLog out;
  out.log = log.log;
  out.request = request;
  out.seen = log.seen;
  out.resampled = resample_100hz(log.record, log.log.string());
  if (!request.wheel.empty()) out.wheel = load_wheel(request.wheel, out.resampled.record.equation());
  Record mended = log.record;  // the firmware has to live with its sensors' faults; a fit of the whole record has not
  std::vector<std::string> faults{mend_spikes(mended).note(), leave_out_frozen(mended).note()};
  std::erase(faults, "");
  Resampled without_faults = faults.empty() ? out.resampled : resample_100hz(mended, log.log.string());
  const std::vector<double>& stamps_s = out.resampled.record.time_s;
  const AngleClock clock = check_clock(without_faults, offset_of(request.torque_offset).value_or(true));
  out.clock_notes = clock_notes(clock, stamps_s.back() - stamps_s.front(), out.resampled.in_step_s());
  for (Resampled* one : {&out.resampled, &without_faults}) {
    one->record = by_one_clock(std::move(one->record), clock, one->in_step_s());
  }
  const std::optional<BareWheelFit> bare = out.wheel ? std::nullopt : fit_bare_wheel(without_faults.record);
  out.friction = known_friction(out.wheel, bare, without_faults.record);
  const double friction_nm = out.friction ? out.friction->torque_nm : 0;
  Record record = less_wheel_friction(out.resampled.record, friction_nm);
  // A rim that nobody touches reads nothing that a bar could be held against.
  if (bare) record.channels &= static_cast<std::uint8_t>(~kTorqueRimValid);
  out.look = first_look(record, offset_of(request.torque_offset));
  const std::string units = unit_words(check_units(record), out.seen);
  if (!units.empty()) out.look.doubt = units;
  out.run = run_firmware(out.resampled.record, scalar_of(request.scalar), out.look.units, friction_nm);
  out.recursive = recursive_answer(record, out.run, out.look.torque_offset);
  if (!bare) without_faults.record = less_wheel_friction(without_faults.record, friction_nm);
  const Record& fitted = without_faults.record;
  const Evidence evidence = evidence_of(without_faults, out.recursive.found, out.look.torque_offset, bare);
  out.credibility = credibility(log.log.string(), record.equation(), out.look, evidence);
  if (request.batch) {
    for (const std::string& fault : faults) out.batch_notes.push_back("for the batch fit " + fault);
    out.batch = batch_answer(fitted, out.look.torque_offset, bare);
    if (voluntary_torque_known(record.equation())) widen(out.batch->found, evidence.check);
    // Without hands there is no arm to change.
    if (!bare && out.look.doubt.empty() && out.look.units.steering_wheel()) {
      out.over_time = fit_varying_arm(fitted);
      std::string doubt = hold_change_against(*out.over_time, evidence.check);
      if (!doubt.empty()) out.batch_notes.push_back(std::move(doubt));
      widen(out.batch->found, *out.over_time);
      if (out.over_time->changes) out.batch_notes.emplace_back(kArmChanges);
    }
  }
  if (!out.look.doubt.empty()) {
    out.recursive.found.doubt = out.look.doubt;  // its states are the firmware's, and stay
    if (out.batch) refuse(out.batch->found, out.look.doubt);
  }
  if (!out.wheel) out.wheel = wheel_of(out.recursive.found);
  if (!request.wheel.empty() && !own_arm(out.recursive.found, *out.wheel)) {
    throw BadInput(fmt::format(
        "{}: expected a torsion bar, whose arm has a wheel to take off, found a rim transducer, whose arm has "
        "none; leave out --wheel",
        request.wheel.string()));
  }
  if (!units.empty()) refuse(out.recursive.found, units);  // numbers in a wrong unit are no numbers
  out.driver = driver_timeline(out.run, out.recursive.found);
  if (!out.driver.none_since.empty()) forget_driver(out.run);
  out.what = summary(log.record, out.seen, out.resampled);
  return out;
}

std::optional<OwnArm> IdentifiedLog::own_arm_of(const Identification& found) const {
  return wheel && found.doubt.empty() ? own_arm(found, *wheel) : std::nullopt;
}

nlohmann::ordered_json IdentifiedLog::json() const {
  std::optional<Identification> batch_found;
  if (batch) batch_found = batch->found;
  nlohmann::ordered_json json = identification_json(recursive.found, batch_found);
  if (const auto own = own_arm_of(recursive.found)) json["own_arm"] = own_arm_json(*own);
  if (batch) {
    if (const auto own = own_arm_of(batch->found)) json["batch"]["own_arm"] = own_arm_json(*own);
    json["batch"]["over_time"] = over_time_json(over_time);
  }
  json["driver"] = driver_json(driver);
  json["credible"] = credibility.credible ? nlohmann::ordered_json(*credibility.credible) : nlohmann::ordered_json();
  json["reasons"] = credibility.reasons;
  json["next"] = credibility.next.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(credibility.next);
  json["notes"] = notes();
  json["input"] = input_json(log);
  json["options"] = request.json();
  json["program"] = program_json();
  return json;
}

std::vector<std::string> IdentifiedLog::notes() const {
  std::vector<std::string> all = seen.notes;
  for (std::string& note : resampled.notes()) all.push_back(std::move(note));
  all.insert(all.end(), clock_notes.begin(), clock_notes.end());
  all.insert(all.end(), look.notes.begin(), look.notes.end());
  if (wheel && !wheel->doubt.empty()) {
    all.push_back(
        fmt::format("the wheel of {} may be wrong, and with it the driver's own arm: {}", wheel->from, wheel->doubt));
  }
  if (friction) {
    all.push_back(
        fmt::format("the wheel's dry friction above the torsion bar, {:.2g} Nm by {}, is taken off its torque",
                    friction->torque_nm, friction->from));
  }
  all.insert(all.end(), batch_notes.begin(), batch_notes.end());
  return all;
}

report::Page identify_page_of(const std::string& record_name, const IdentifiedLog& found) {
  return identify_page({record_name, found.what, found.resampled.record, found.run, found.driver, found.recursive,
                        found.batch, found.over_time,
                        found.own_arm_of(found.batch ? found.batch->found : found.recursive.found), found.credibility,
                        found.notes()});
}

void write_identify_page(const std::filesystem::path& target, const std::string& record_name,
                         const IdentifiedLog& found) {
  report::write_page(target, identify_page_of(record_name, found));
}

}  // namespace steerid
