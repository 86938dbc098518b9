// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/blind_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace steerid::blind_study {
namespace {

constexpr double kTwoSided95 = 1.959964;
constexpr std::array kGapEdges = {1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 100.0};
constexpr std::array kProbabilityEdges = {0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0};

bool no_effect(const std::string& label) { return label == "none" || label == "parameters"; }

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

double probability(const Answer& answer, const std::string& id) {
  const auto found = answer.probability.find(id);
  return found == answer.probability.end() ? 0 : found->second;
}

/// How many ids are more probable.
std::size_t rank(const Answer& answer, const std::string& id) {
  const double own = probability(answer, id);
  return static_cast<std::size_t>(std::count_if(answer.probability.begin(), answer.probability.end(),
                                                [&](const auto& one) { return one.second > own; }));
}

double brier(const Case& one) {
  if (!one.answer) return 1;
  double sum = 0;
  bool holds_label = false;
  for (const auto& [id, p] : one.answer->probability) {
    const double truth = id == one.truth.label ? 1 : 0;
    holds_label = holds_label || truth == 1;
    sum += (p - truth) * (p - truth);
  }
  return holds_label ? sum : sum + 1;
}

/// The value below which this share of all lies, joined linearly.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

bool inside(double value, const Interval& interval) { return value >= interval.low && value <= interval.high; }

/// Errors of one quantity over cases.
struct Errors {
  std::vector<double> percent;
  Share covered;
  void add(const Estimated& found, double truth) {
    percent.push_back(100 * std::abs(found.value / truth - 1));
    covered.count(inside(truth, found.ci95));
  }
  [[nodiscard]] Recovery recovery() const {
    return {percent.size(), quantile(percent, 0.5), quantile(percent, 0.9), covered};
  }
};

/// Numbers whose ratio to the truth says nothing: angles of a cycle and choices.
bool is_relative(const std::string& name, double truth) {
  return truth != 0 && !name.starts_with("phase") && name != "shape" && name != "first_s";
}

/// A swing's instant is one of many, a period apart: how many periods the nearest to the truth is away from what was
/// found, s.
double whole_periods_s(const std::map<std::string, double>& truth, const std::string& name, double found) {
  constexpr double kSwing = 2;
  const auto shape = truth.find("shape");
  const auto period_s = truth.find("length_s");
  if (name != "time_s" || shape == truth.end() || shape->second != kSwing || period_s == truth.end()) return 0;
  return period_s->second * std::round((found - truth.at(name)) / period_s->second);
}

void add_recovery(const Case& one, std::map<std::string, Errors>& errors) {
  for (const NamedCause& cause : one.answer->causes) {
    const auto known = one.truth.parameters.find(cause.effect);
    if (known == one.truth.parameters.end()) continue;
    for (const auto& [name, truth] : known->second) {
      const auto found = cause.parameters.find(name);
      if (found == cause.parameters.end() || !is_relative(name, truth)) continue;
      errors[cause.effect + "." + name].add(found->second,
                                            truth + whole_periods_s(known->second, name, found->second.value));
    }
  }
  for (const auto& [name, truth] : one.truth.arm) {
    const auto found = one.answer->arm.find(name);
    if (found != one.answer->arm.end() && std::isfinite(found->second.value)) errors[name].add(found->second, truth);
  }
}

template <std::size_t N>
std::size_t band_of(double value, const std::array<double, N>& edges) {
  const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
  return static_cast<std::size_t>(above - edges.begin()) - 1;
}

class Tally {
 public:
  Tally() {
    for (std::size_t i = 0; i + 1 < kGapEdges.size(); ++i) {
      scores_.detection.push_back({kGapEdges[i], kGapEdges[i + 1], {}, {}});
    }
    for (std::size_t i = 0; i + 1 < kProbabilityEdges.size(); ++i) {
      scores_.reliability.push_back({kProbabilityEdges[i], kProbabilityEdges[i + 1], 0, {}});
    }
  }

  void add(const Case& one) {
    ++scores_.cases;
    if (!one.answer) ++scores_.refused;
    add_verdict(one);
    add_probabilities(one);
    if (!no_effect(one.truth.label) && one.truth.label != "unknown") add_detection(one);
    if (right(one)) add_right(one);
  }

  [[nodiscard]] Scores scores() {
    const auto n = static_cast<double>(scores_.cases);
    scores_.mean_probability /= n;
    scores_.brier /= n;
    for (auto& [label, of] : scores_.labels) of.mean_probability /= static_cast<double>(of.cases);
    for (ReliabilityBand& band : scores_.reliability) {
      if (band.right.all == 0) continue;
      band.mean_probability /= static_cast<double>(band.right.all);
      scores_.calibration_error +=
          static_cast<double>(band.right.all) / n * std::abs(band.mean_probability - band.right.value());
    }
    scores_.median_closed = quantile(closed_, 0.5);
    for (const auto& [name, errors] : errors_) scores_.recovery[name] = errors.recovery();
    return scores_;
  }

 private:
  [[nodiscard]] static std::string verdict(const Case& one) { return one.answer ? one.answer->verdict : "refused"; }
  [[nodiscard]] static bool right(const Case& one) { return verdict(one) == one.truth.label; }

  void add_verdict(const Case& one) {
    const std::string& label = one.truth.label;
    const std::string said = verdict(one);
    scores_.right.count(right(one));
    scores_.right_or_equivalent.count(right(one) || (one.answer && contains(one.answer->equivalent, label)));
    LabelScore& of = scores_.labels[label];
    ++of.cases;
    of.right.count(right(one));
    ++of.verdicts[said];
    if (no_effect(label)) scores_.false_alarms.count(one.answer && !no_effect(said) && said != "unknown");
    if (label == "unknown") {
      scores_.abstained.count(said == "unknown");
      if (!one.truth.effects.empty()) ++scores_.outside[one.truth.effects.front()][said];
    } else {
      scores_.needlessly_unknown.count(said == "unknown");
    }
  }

  void add_probabilities(const Case& one) {
    const double p = one.answer ? probability(*one.answer, one.truth.label) : 0;
    scores_.mean_probability += p;
    scores_.labels[one.truth.label].mean_probability += p;
    scores_.brier += brier(one);
    const std::size_t above = one.answer ? rank(*one.answer, one.truth.label) : 99;
    scores_.top1.count(above < 1);
    scores_.top3.count(above < 3);
    if (!one.answer || one.answer->probability.empty()) return;
    const auto best = std::max_element(one.answer->probability.begin(), one.answer->probability.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    ReliabilityBand& band = scores_.reliability[band_of(best->second, kProbabilityEdges)];
    band.mean_probability += best->second;
    band.right.count(best->first == one.truth.label);
  }

  void add_detection(const Case& one) {
    GapBand& band = scores_.detection[band_of(one.truth.gap_over_floor, kGapEdges)];
    band.noticed.count(one.answer && !no_effect(verdict(one)));
    band.right.count(right(one));
  }

  void add_right(const Case& one) {
    add_recovery(one, errors_);
    if (one.answer->causes.empty() || one.truth.label == "unknown" || !one.answer->closed_fraction) return;
    closed_.push_back(one.answer->closed_fraction->value);
    scores_.closed_covers.count(one.answer->closed_fraction->ci95.high >= 1 &&
                                one.answer->closed_fraction->ci95.low <= 1);
  }

  Scores scores_;
  std::vector<double> closed_;
  std::map<std::string, Errors> errors_;
};

}  // namespace

double Share::value() const { return all == 0 ? std::nan("") : static_cast<double>(some) / static_cast<double>(all); }

Interval Share::ci95() const {
  if (all == 0) return {std::nan(""), std::nan("")};
  const auto n = static_cast<double>(all);
  const double p = value();
  const double z2 = kTwoSided95 * kTwoSided95;
  const double centre = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kTwoSided95 / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

Scores score(std::span<const Case> cases) {
  Tally tally;
  for (const Case& one : cases) tally.add(one);
  return tally.scores();
}

PairScores score_pairs(std::span<const Case> cases) {
  PairScores out;
  std::vector<double> closed;
  for (const Case& one : cases) {
    ++out.cases;
    std::size_t found = 0;
    bool stranger = false;
    if (one.answer) {
      for (const NamedCause& cause : one.answer->causes) {
        (contains(one.truth.effects, cause.effect) ? void(++found) : void(stranger = true));
      }
      if (one.answer->closed_fraction) closed.push_back(one.answer->closed_fraction->value);
    }
    const bool named = one.answer && one.answer->verdict != "unknown";
    out.both_named.count(named && found >= 2);
    out.one_named.count(named && found >= 1);
    out.only_true.count(!stranger);
  }
  out.median_closed = quantile(closed, 0.5);
  return out;
}

namespace {

/// Whether the causes named are the effect by definition: dry friction that differs between the directions is
/// Coulomb's with an offset.
bool is_by_definition(const std::vector<NamedCause>& causes, const std::string& label) {
  const auto named = [&](std::string_view id) {
    return std::any_of(causes.begin(), causes.end(), [&](const NamedCause& one) { return one.effect == id; });
  };
  return label == "asymmetric_friction" && causes.size() == 2 && named("coulomb_friction") && named("torque_bias");
}

}  // namespace

LeaveOneOutScores score_leave_one_out(std::span<const Case> cases, std::span<const Case> whole) {
  LeaveOneOutScores out;
  for (const Case& one : cases) {
    const std::string said = one.answer ? one.answer->verdict : "refused";
    const auto same =
        std::find_if(whole.begin(), whole.end(), [&](const Case& other) { return other.name == one.name; });
    const bool equivalent = (same != whole.end() && same->answer && contains(same->answer->equivalent, said)) ||
                            (one.answer && is_by_definition(one.answer->causes, one.truth.label));
    LeftOut& left_out = out.effects[one.truth.label];
    left_out.unknown.count(said == "unknown" || equivalent);
    out.unknown.count(said == "unknown" || equivalent);
    if (said != "unknown") ++left_out.impostors[said];
  }
  return out;
}

}  // namespace steerid::blind_study
