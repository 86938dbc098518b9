// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/pairs/pair_acceptance.hpp"

#include <algorithm>
#include <limits>

#include "gap/attribution/verdict_ids.hpp"
#include "gap/comparison/free_run_stage.hpp"
#include "gap/comparison/preferred_fit.hpp"

namespace steerid {
namespace {

constexpr double kDoubtful = 0.25;  // probability of unknown

constexpr double kWorthNats = 40;  // over the dispersion
/// A slow torque is there in any case: all that is asked is whether it is larger than a driver's.
constexpr double kWorthNatsSlow = 25;

/// Whether an explanation gains enough over one that leaves `nats`.
bool worth_it(double nats, const Evidence& by, double worth_nats = kWorthNats) {
  return (nats - priced_nats(by)) / std::max(1.0, by.excess) > worth_nats;
}

/// Whether two effects close most of what one leaves of the free run's gap, where that is not small.
bool closes_run(const Evidence& one, const Evidence& two) {
  constexpr double kNotSmall = 0.01;  // of the gap's power; right single effects leave a tenth of that
  constexpr double kMost = 0.2;
  return one.run_error && two.run_error && *one.run_error > kNotSmall && *two.run_error < kMost * *one.run_error;
}

/// Whether an effect needs a slow torque that is larger than any driver's. Beside play and absence that does not speak
/// for `unknown` (gap/attribution/attribution.cpp), as they may miss as much there.
bool needs_slow_torque(const Evidence& one) {
  constexpr double kDrivers = 0.03;  // of the applied torque: drivers have 0.02, and 0.05 is a cause
  return one.slow_share > kDrivers;
}

/// Whether two effects come near the floor without most of the slow torque that one of them needs. One that is called a
/// cause takes up much of what else is missing, and has to come nearer.
bool takes_slow_torque(const Evidence& one, const CausePair& two) {
  constexpr double kNear = 2;
  constexpr double kMost = 0.6;
  const double near = two.has_slow_torque() ? kWorthAName : kNear;
  return two.evidence.excess < near && two.evidence.slow_share < kMost * one.slow_share;
}

/// Whether the most probable single effect leaves something open. What it leaves above the floor is in the probability
/// of `unknown`; what its run leaves of the gap speaks there from four tenths on only
/// (gap/attribution/attribution.cpp).
bool leaves_much(const Evidence& best, double unknown) {
  constexpr double kMuchLeft = 0.1;  // of the gap's power
  return unknown > kDoubtful || best.run_error.value_or(0) > kMuchLeft || needs_slow_torque(best);
}

/// What the leading effect of a pair leaves alone when it is fitted from where the pair ended: what a pair gains may be
/// a better optimum of one of the two.
double nats_of_leading(const ComparisonSetting& alone, const CausePair& pair, const AttributionInput& input) {
  const auto single = std::ranges::find(input.all, pair.leading, &Evidence::id);
  const std::optional<Effect> leading =
      pair.leading == pair.first ? fitted_beside(pair.first_effect, pair.second) : fitted_effect(pair.second);
  if (!leading || single == input.all.end()) return std::numeric_limits<double>::infinity();
  std::vector<Effect> with = alone.present;
  with.push_back(*leading);
  Candidate one{.id = std::string(leading->type->id), .type = leading->type, .fit = {}};
  one.fit.x = point_of(wheel_of(pair.second.fit.x), with);
  const ComparedParts there = compared_parts(alone.present);
  fit_from_here(alone, there, one);
  prefer_slow_course(alone, there, one);
  return one.fit.cost(kSeen) + single->complexity;
}

/// Whether a pair that is likely enough also gains enough over the best single effect.
bool gains_enough(const ComparisonSetting& alone, const CausePair& pair, const AttributionInput& input,
                  const std::vector<double>& probability) {
  const Evidence& single = *std::ranges::min_element(input.all, {}, [](const Evidence& one) {
    return one.eligible ? one.fit_nats + one.choose_nats : std::numeric_limits<double>::infinity();
  });
  const double worth_nats = pair.has_slow_torque() ? kWorthNatsSlow : kWorthNats;
  if (!worth_it(priced_nats(single), pair.evidence, worth_nats)) return false;
  if (!worth_it(nats_of_leading(alone, pair, input), pair.evidence, worth_nats)) return false;
  if (*std::ranges::max_element(probability) == probability.back()) return true;
  if (needs_slow_torque(single) && takes_slow_torque(single, pair)) return true;
  // A slow torque takes up some of what any effect's fit leaves: beside one that explains the record it says little,
  // and as little where that effect is forgiven one.
  const bool explained = probability.back() < kDoubtful && single.excess < kWorthAName;
  if (pair.has_slow_torque() && (explained || (single.switches && needs_slow_torque(single)))) return false;
  return gains_enough(single.excess, priced_nats(single), pair.evidence) || closes_run(single, pair.evidence);
}

/// Most speaks for the one that explains most alone, and never less than for `unknown`.
void share_among(const CausePair& pair, const AttributionInput& input, std::vector<double>& probability) {
  const double second = 0.4 * (1 - 2 * pair.unknown);
  for (std::size_t i = 0; i < input.all.size(); ++i) {
    const std::string& id = input.all[i].id;
    const bool of_pair = id == pair.first || id == pair.second.id;
    probability[i] = id == pair.leading ? 1 - pair.unknown - second : of_pair ? second : 0;
  }
  probability.back() = pair.unknown;
}

}  // namespace

bool gains_enough(double excess, double nats, const Evidence& by) {
  return excess > 1.25 && worth_it(nats, by) && excess - by.excess > 0.6 * (excess - 1);
}

bool gains_beside_defects(const Evidence& refit, const Evidence& by) {
  constexpr double kMostLeft = 0.3;  // of the gap's power
  constexpr double kSomething = 1.1;
  const double nats = refit.fit_nats + refit.choose_nats;
  const bool closes = refit.excess > kSomething && refit.excess - by.excess > 0.6 * (refit.excess - 1);
  if (closes && worth_it(nats, by)) return true;
  return by.run_error && *by.run_error < kMostLeft && worth_it(nats, by);
}

bool gains_beside_rounding(const Evidence& refit, const Evidence& by) {
  const bool strays = by.run_error && *by.run_error > 1;
  return !strays && worth_it(refit.fit_nats + refit.choose_nats, by);
}

std::optional<CausePair> pair_instead(const ComparisonSetting& alone, const Comparison& singles,
                                      const AttributionInput& input, std::vector<double>& probability) {
  const auto best = static_cast<std::size_t>(std::ranges::max_element(probability) - probability.begin());
  const bool unknown = best == input.all.size();
  if (!unknown && !(names_effect(input.all[best].id) && leaves_much(input.all[best], probability.back()))) return {};
  std::optional<CausePair> pair = best_pair(alone, singles, input);
  if (!pair || pair->unknown > 0.5 || !gains_enough(alone, *pair, input, probability)) return {};
  if (!unknown) {
    const std::string& named = input.all[best].id;
    if (named == pair->first || named == pair->second.id) {  // what it is called stays as likely as it was
      pair->leading = named;
      return pair;
    }
  }
  share_among(*pair, input, probability);
  return pair;
}

}  // namespace steerid
