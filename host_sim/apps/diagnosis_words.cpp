// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/diagnosis_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gap/hypotheses/hypothesis.hpp"
#include "report/uncertainty.hpp"

namespace steerid {
namespace {

/// Ends of parameter names and the units they stand for, longest first.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kUnits = {
    {{"_nms2_per_rad2", "Nm s\u00b2/rad\u00b2"},
     {"_nms_per_rad", "Nms/rad"},
     {"_nm_per_rad3", "Nm/rad\u00b3"},
     {"_nm_per_rad", "Nm/rad"},
     {"_rad_s", "rad/s"},
     {"_kgm2", "kg m\u00b2"},
     {"_rad", "rad"},
     {"_nm", "Nm"},
     {"_hz", "Hz"},
     {"_s", "s"},
     {"_per_turn", "per turn"},
     {"_probability", ""},
     {"_share", ""},
     {"_ratio", ""},
     {"_db", "dB"},
     {"_percent", "%"}}};

/// The unit's place in the table; its size where the name has no unit.
std::size_t unit_index(std::string_view name) {
  const auto found =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const auto& unit) { return name.ends_with(unit.first); });
  return static_cast<std::size_t>(found - kUnits.begin());
}

std::string capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// A free run over the whole record follows no hands_off whose instants are a little off, and no torque that was not
/// recorded: an effect that explains what the record shows may leave more than no effect.
bool run_shows_it(const gap::GapSizes& gap) { return !(gap.closed_fraction.value < 0); }

std::string closed(const gap::GapSizes& gap) {
  // What comes nearer to the record than noise is expected to let it come has closed all there is to close.
  constexpr double kAll = 0.995;  // is written 100 %
  if (gap.closed_fraction.value > 2 - kAll) {
    const bool surely = gap.closed_fraction.low > kAll;
    return surely ? "all of it" : fmt::format("all of it (at least {})", percent(gap.closed_fraction.low));
  }
  return fmt::format("{:.0f} % of it ({})", 100 * gap.closed_fraction.value,
                     percent_range(gap.closed_fraction.low, gap.closed_fraction.high));
}

/// Where the free run's error is too near to noise to tell what of it was closed.
std::string closes_within_noise(bool several) {
  return fmt::format("what {} of the free run's error cannot be told from noise", several ? "they close" : "it closes");
}

std::string wheel_in_words(const gap::BaseWheel& wheel) {
  return fmt::format("J {} kg m\u00b2, B {} Nms/rad, C {} Nm/rad", report::in_digits(wheel.inertia_kgm2.value, 3),
                     report::in_digits(wheel.damping_nms_per_rad.value, 3),
                     report::in_digits(wheel.stiffness_nm_per_rad.value, 3));
}

/// That something is missing, and by what it shows: by the free run's error, or by the spectrum of what is left alone.
std::string gap_in_words(const gap::Diagnosis& d, bool unsure) {
  const std::string missed = percent(d.gap.refit_nrmse);
  const std::string noise = percent(d.gap.floor_nrmse);
  if (!(d.gap.refit_nrmse > d.gap.floor_nrmse)) {
    return fmt::format(
        "With the best J, B and C the free run misses the measured angle by {}, no more than noise alone would ({}), "
        "but what is left has another spectrum than noise, and {}.",
        missed, noise, unsure ? "no change is sure enough to be named" : "no effect of the library explains it");
  }
  const bool seen_in_run = std::isfinite(d.gap.closed_fraction.value);
  return fmt::format(
      "There is a gap {}: with the best J, B and C the free run misses the measured angle by {}, where the noise alone "
      "would leave {}{}.",
      unsure ? "and no change is sure enough to be named" : "that no effect of the library explains", missed, noise,
      seen_in_run ? "" : "; it is the spectrum of what is missing that no noise explains");
}

std::string unknown_sentence(const gap::Diagnosis& d) {
  if (!d.not_credible.empty()) {
    return fmt::format("Nothing is named, as no answer to this record is credible: {}.", d.not_credible);
  }
  const bool closes = std::isfinite(d.gap.closed_fraction.value) && run_shows_it(d.gap);
  const auto of_unknown = std::ranges::find(d.ranking, "unknown", &gap::RankedEffect::id);
  const bool unsure = of_unknown != d.ranking.end() && of_unknown->probability < 0.5;
  // What leaves no more than noise does explain it, sure or not.
  const bool explained = closes && !d.causes.empty() && d.gap.with_effect_nrmse <= d.gap.floor_nrmse;
  std::string text = gap_in_words(d, unsure || explained);
  if (!d.causes.empty()) {
    std::vector<std::string> together;
    for (const gap::Cause& cause : d.causes) {
      together.push_back(fmt::format("{} (probability {:.2f})", spoken(cause.effect.type->id), cause.probability));
    }
    text += " The nearest surrogate is " + joined(together, "and");
    if (closes) text += fmt::format("; it closes {}", closed(d.gap));
    text += ".";
    if (d.base_out_of_place) {
      text += fmt::format(
          " It needs {}, which is too far from the simulation's: if they are right, give them to the simulation and "
          "diagnose again.",
          wheel_in_words(d.base));
    }
  } else {
    text += " It has no surrogate: no effect is shown to bring the free run nearer than J, B and C alone.";
  }
  return text;
}

/// What stays of the gap, and where; empty where nothing does, or where no run says.
std::string remains(const gap::Diagnosis& d) {
  constexpr double kWritten = 0.005;  // is written 1 %
  const gap::Unexplained& rest = d.unexplained;
  if (rest.complete || !(rest.share_of_gap >= kWritten) || !std::isfinite(d.gap.closed_fraction.value)) return "";
  constexpr double kMost = 0.5;
  std::string place;
  if (rest.where && rest.where->share > kMost) {
    place = rest.where->low_hz > 0 ? fmt::format("between {:g} and {:g} Hz", rest.where->low_hz, rest.where->high_hz)
                                   : fmt::format("below {:g} Hz", rest.where->high_hz);
    place = ", most of it " + place;
  }
  return fmt::format(" Of the gap {:.0f} % is left{}.", 100 * rest.share_of_gap, place);
}

std::string alike(const gap::Diagnosis& d) {
  return d.equivalent.empty() ? "" : fmt::format(" This record cannot tell it from {}.", enumerated(d.equivalent));
}

/// The value of a cause's parameter, and between what it lies where the record says little more than that and it is a
/// size: how a bristle bends is known to nobody.
std::string known_as(const gap::Cause& cause, std::size_t i) {
  constexpr double kWide = 0.5;  // of the value, to either side: not even its first digit is known
  const std::string_view name = cause.effect.type->parameters[i].name;
  const double value = cause.effect.values[i];
  std::string text = in_unit(value, name);
  const gap::Hypothesis* hypothesis = gap::hypothesis_of(*cause.effect.type);
  const bool size = hypothesis == nullptr || std::cmp_less(i, hypothesis->sizes());
  if (!size || i >= cause.parameters.size()) return text;
  const gap::BoundedValue& known = cause.parameters[i];
  if (!(known.high - known.low > 2 * kWide * std::abs(value)) || !std::isfinite(known.high - known.low)) return text;
  return text + fmt::format(", between {} and {}", report::in_digits(known.low, 3), in_unit(known.high, name));
}

/// The size of an effect by which it is changed most, of the wheel and of the simulation.
std::string resized(const gap::Cause& cause) {
  std::size_t most = 0;
  double farthest = -1;
  for (std::size_t i = 0; i < cause.effect.values.size(); ++i) {
    const double far = std::abs(cause.effect.values[i] - cause.was->values[i]) / cause.effect.type->parameters[i].scale;
    if (far > farthest) {
      farthest = far;
      most = i;
    }
  }
  const std::string_view name = cause.effect.type->parameters[most].name;
  return fmt::format("{}: {} is {}, not {}", spoken(cause.effect.type->id), quantity_of(name), known_as(cause, most),
                     in_unit(cause.was->values[most], name));
}

std::string change_in_words(const gap::Cause& cause) {
  if (cause.change == gap::ChangeKind::kRemove) {
    return fmt::format("the wheel does not have the simulation's {}", spoken(cause.effect.type->id));
  }
  if (cause.change == gap::ChangeKind::kResize) return resized(cause);
  return in_short(cause) + " is missing from the simulation";
}

std::string changes_sentence(const gap::Diagnosis& d) {
  std::vector<std::string> changes;
  for (const gap::Cause& cause : d.causes) changes.push_back(change_in_words(cause));
  const bool several = changes.size() > 1;
  const std::string_view they = several ? "Together these changes close" : "This change closes";
  const std::string closes = !std::isfinite(d.gap.closed_fraction.value) ? capital(closes_within_noise(several))
                             : run_shows_it(d.gap) ? fmt::format("{} the gap: {}", they, closed(d.gap))
                                                   : "A free run with what is changed does not close the gap";
  return fmt::format(
      "{}. {}. The free run misses the measured angle by {} as given, by {} with other J, B and C alone, and by {} "
      "with what is changed.{}",
      capital(fmt::format("{}", fmt::join(changes, "; "))), closes, percent(d.gap.sim_nrmse),
      percent(d.gap.refit_nrmse), percent(d.gap.with_effect_nrmse), remains(d));
}

std::string cause_sentence(const gap::Diagnosis& d) {
  const bool adds =
      std::ranges::all_of(d.causes, [](const gap::Cause& one) { return one.change == gap::ChangeKind::kAdd; });
  if (!adds) return changes_sentence(d);
  std::vector<std::string> causes;
  for (const gap::Cause& cause : d.causes) causes.push_back(in_short(cause));
  const bool several = causes.size() > 1;
  const std::string_view explain = several ? "explain" : "explains";
  if (d.only_the_loop_holds) {
    return fmt::format(
        "{} {} what the record shows. Only the loop holds the wheel with {}, so that no free run can say how far the "
        "gap closes: as given it misses the measured angle by {}.{}",
        capital(joined(causes, "and")), explain, several ? "them" : "it", percent(d.gap.sim_nrmse), alike(d));
  }
  constexpr double kMost = 0.5;  // what closes less than half of a gap explains a part of it
  const char* of_gap = d.gap.closed_fraction.value < kMost ? "a part of the gap" : "the gap";
  const auto does = [&]() -> std::string {
    if (!std::isfinite(d.gap.closed_fraction.value)) {
      return fmt::format("{} what the record shows; {}", explain, closes_within_noise(several));
    }
    if (run_shows_it(d.gap)) {
      return fmt::format("{} {} and {} {}", explain, of_gap, several ? "close" : "closes", closed(d.gap));
    }
    return fmt::format("{} what the record shows, but a free run with {} does not close the gap", explain,
                       several ? "them" : "it");
  };
  const std::string text = fmt::format(
      "{} {}. The free run misses the measured angle by {} as given, by {} with the best J, B and C alone, and by {} "
      "with the {}.{}",
      capital(joined(causes, "and")), does(), percent(d.gap.sim_nrmse), percent(d.gap.refit_nrmse),
      percent(d.gap.with_effect_nrmse), several ? "effects" : "effect", remains(d));
  return text + alike(d);
}

}  // namespace

std::string spoken(std::string_view id) {
  std::string text(id);
  std::replace(text.begin(), text.end(), '_', ' ');
  for (const std::string_view person : {"coulomb", "stribeck"}) {
    if (text.starts_with(person)) return capital(std::move(text));
  }
  return text;
}

std::string unit_of(std::string_view name) {
  const std::size_t i = unit_index(name);
  return i < kUnits.size() ? std::string(kUnits[i].second) : std::string();
}

std::string quantity_of(std::string_view name) {
  const std::size_t i = unit_index(name);
  // What has no unit keeps its whole name: "breakaway ratio".
  if (i < kUnits.size() && !kUnits[i].second.empty()) name.remove_suffix(kUnits[i].first.size());
  return spoken(name);
}

std::string in_unit(double value, std::string_view name) {
  const std::string unit = unit_of(name);
  return report::in_digits(value, 3) + (unit.empty() ? "" : " " + unit);
}

namespace {

/// "0.40 Nm in a.csv, 0 Nm in b.csv"
std::string by_record(const gap::Cause& cause, const Parameter& parameter) {
  std::vector<std::string> values;
  for (const auto& [record, value] : cause.elsewhere) {
    const double shown = std::abs(value) < 1e-3 * parameter.scale ? 0 : value;
    values.push_back(fmt::format("{} in {}", in_unit(shown, parameter.name), record));
  }
  return fmt::format("{}", fmt::join(values, ", "));
}

}  // namespace

std::string in_short(const gap::Cause& cause) {
  constexpr std::size_t kShown = 2;
  std::string text = spoken(cause.effect.type->id);
  std::vector<std::string> numbers;
  for (std::size_t i = 0; i < std::min(kShown, cause.effect.values.size()); ++i) {
    const Parameter& parameter = cause.effect.type->parameters[i];
    if (i == 0 && !cause.elsewhere.empty()) {
      numbers.push_back(fmt::format("{} {}", quantity_of(parameter.name), by_record(cause, parameter)));
      continue;
    }
    const double value = cause.effect.values[i];
    const bool absent = value == 0 && parameter.preset == 0;  // bristles that there are none of
    if (parameter.whole || absent) continue;
    numbers.push_back(fmt::format("{} {}", quantity_of(parameter.name), known_as(cause, i)));
  }
  return numbers.empty() ? text : fmt::format("{} ({})", text, fmt::join(numbers, ", "));
}

std::string joined(const std::vector<std::string>& words, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? fmt::format(" {} ", last) : ", ";
    text += words[i];
  }
  return text;
}

std::string enumerated(const std::vector<std::string>& ids) {
  std::vector<std::string> words;
  for (const std::string& id : ids) words.push_back(spoken(id));
  return joined(words, "or");
}

std::string percent(double share) { return report::in_digits(100 * share, 3) + " %"; }

std::string percent_range(double low, double high) {
  const auto whole = [](double share) { return fmt::format("{:.0f}", std::round(100 * share)); };
  if (!std::isfinite(low) || !std::isfinite(high)) return "interval unknown";
  if (whole(low) == whole(high)) return "to half a per cent";
  return fmt::format("{} to {} %", whole(low), whole(high));
}

namespace {

std::string parameters_sentence(const gap::Diagnosis& d) {
  const std::string noise = percent(d.gap.floor_nrmse);
  if (!(d.gap.with_effect_nrmse < d.gap.sim_nrmse)) {
    return fmt::format(
        "The record says {}, other than the simulation, but no free run shows it: the held-out part is missed by {} "
        "with these numbers and by {} as given, where the noise alone would leave {}.",
        wheel_in_words(d.base), percent(d.gap.with_effect_nrmse), percent(d.gap.sim_nrmse), noise);
  }
  const std::string falls = fmt::format("with {} the free run's error falls from {} to {}", wheel_in_words(d.base),
                                        percent(d.gap.sim_nrmse), percent(d.gap.with_effect_nrmse));
  if (d.unexplained.complete) return "The model is right, its numbers are not: " + falls + ", down to the noise.";
  return fmt::format("The model needs other numbers: {}, where the noise alone would leave {}.", falls, noise);
}

}  // namespace

std::string verdict_sentence(const gap::Diagnosis& d) {
  const std::string noise = percent(d.gap.floor_nrmse);
  const bool complete = d.unexplained.complete;
  if (d.verdict == "none") {
    const std::string missed = percent(d.gap.sim_nrmse);
    return complete ? fmt::format(
                          "The simulation explains this record down to its noise: the free run misses by {}, "
                          "the noise alone leaves {}.",
                          missed, noise)
                    : fmt::format(
                          "The record shows nothing that the simulation lacks, but its free run misses the "
                          "measured angle by {}, where the noise alone would leave {}.",
                          missed, noise);
  }
  if (d.verdict == "parameters") return parameters_sentence(d);
  if (d.verdict == "unknown" || d.causes.empty()) return unknown_sentence(d);
  return cause_sentence(d);
}

}  // namespace steerid
