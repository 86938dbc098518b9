#include "gap/pair_search.hpp"

#include <algorithm>
#include <limits>

#include "gap/attribution_coefficients.hpp"
#include "gap/dry_friction_forms.hpp"
#include "gap/free_run_stage.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

/// Two effects that undo each other fit nearly anything, with J, B and C beyond kFarthestShift.
class PairSearch {
 public:
  PairSearch(const ComparisonSetting& alone, const Comparison& singles, const AttributionInput& input)
      : alone_(alone), singles_(singles), input_(input) {}

  std::optional<CausePair> best() {
    const std::vector<std::size_t> order = most_likely_first();
    if (order.empty()) return std::nullopt;
    constexpr std::size_t kFirsts = 2;
    for (std::size_t i = 0; i < std::min(kFirsts, order.size()) && !reaches_floor(); ++i) {
      const Candidate& first = singles_.candidates[order[i]];
      if (best_ && (first.id == best_->first || first.id == best_->second.id)) continue;
      offer(beside(first.id, fitted_effect(first), first.fit, first.simulated));
      take_turns();
      if (best_ && best_->unknown < 0.5) break;
    }
    return best_;
  }

 private:
  [[nodiscard]] std::vector<std::size_t> most_likely_first() const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < input_.all.size(); ++i) {
      const Evidence& one = input_.all[i];
      if (names_effect(one.id) && one.eligible && !coulomb_by_another_name(one)) order.push_back(i);
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return priced_nats(input_.all[i]); });
    return order;
  }

  /// A kind of dry friction that Coulomb's explains as well: beside a second effect it would soon show a difference
  /// that is not there.
  [[nodiscard]] bool coulomb_by_another_name(const Evidence& one) const {
    constexpr double kPlain = 12;  // nats
    return one.id != "coulomb_friction" && dry_friction(one.id) &&
           priced_nats(one) > nats_alone("coulomb_friction") - kPlain;
  }

  [[nodiscard]] double nats_alone(const std::string& id) const {
    const auto found = std::ranges::find(input_.all, id, &Evidence::id);
    return found == input_.all.end() ? std::numeric_limits<double>::infinity() : priced_nats(*found);
  }

  [[nodiscard]] bool reaches_floor() const {
    constexpr double kFloor = 1.2;
    return best_ && best_->unknown < 0.5 && best_->evidence.excess < kFloor;
  }

  bool offer(std::optional<CausePair> pair) {
    const bool better = pair && (!best_ || priced_nats(pair->evidence) < priced_nats(best_->evidence));
    if (better) best_ = std::move(pair);
    return better;
  }

  /// The second one found is held and the first looked for anew, and so on as long as much is gained.
  void take_turns() {
    constexpr int kTurns = 4;
    constexpr double kMuch = 0.7;
    for (int turn = 0; turn < kTurns && best_ && !reaches_floor(); ++turn) {
      const double before = best_->evidence.excess;
      const std::optional<Effect> other = fitted_effect(best_->second);
      if (!offer(beside(best_->second.id, other, without_first(*best_, other), false))) return;
      if (best_->evidence.excess > kMuch * before) return;
    }
  }

  /// The second effect of a pair where it is, alone.
  [[nodiscard]] Whittle::Fit without_first(const CausePair& pair, const std::optional<Effect>& effect) const {
    std::vector<Effect> present = alone_.present;
    if (effect) present.push_back(*effect);
    Whittle::Fit fit = pair.second.fit;
    fit.x = joined(wheel_of(pair.second.fit.x), present);
    return fit;
  }

  /// The best effect beside `first`, which is fitted as `fit` says.
  [[nodiscard]] std::optional<CausePair> beside(const std::string& first, const std::optional<Effect>& effect,
                                                const Whittle::Fit& fit, bool by_runs) const {
    ComparisonSetting setting = alone_;
    if (effect) setting.present.push_back(*effect);
    setting.slow = effect ? SlowTorque::kFloor : SlowTorque::kCause;
    setting.base = fit;
    setting.base_by_runs = by_runs;
    const Comparison comparison = compare(setting);
    AttributionInput input = attribution_input(comparison, setting.whittle, setting.sim);
    input.refit_excess = input_.refit_excess;
    bool any = false;
    for (Evidence& one : input.all) {
      one.eligible =
          one.eligible && names_effect(one.id) && (one.simulated || !comparison.by_runs) && one.shift < kFarthestShift;
      any = any || one.eligible;
    }
    if (!any) return std::nullopt;
    const std::vector<double> probability = attribute(input, kAttribution);
    const auto second =
        static_cast<std::size_t>(std::max_element(probability.begin(), probability.end() - 1) - probability.begin());
    const std::string& other = comparison.candidates[second].id;
    return CausePair{.first = first,
                     .leading = nats_alone(first) <= nats_alone(other) ? first : other,
                     .first_effect = effect,
                     .slow = setting.slow,
                     .second = comparison.candidates[second],
                     .evidence = input.all[second],
                     .unknown = probability.back()};
  }

  const ComparisonSetting& alone_;
  const Comparison& singles_;
  const AttributionInput& input_;
  std::optional<CausePair> best_;
};

constexpr double kDoubtful = 0.25;  // probability of unknown

/// Whether an explanation gains enough over one that leaves `nats`.
bool worth_it(double nats, const Evidence& by) {
  constexpr double kWorthNats = 40;  // over the dispersion
  return (nats - priced_nats(by)) / std::max(1.0, by.excess) > kWorthNats;
}

/// Whether two effects close most of what one leaves of the free run's gap, where that is not small.
bool closes_run(const Evidence& one, const Evidence& two) {
  constexpr double kNotSmall = 0.01;  // of the gap's power; right single effects leave a tenth of that
  constexpr double kMost = 0.2;
  return one.run_error && two.run_error && *one.run_error > kNotSmall && *two.run_error < kMost * *one.run_error;
}

/// Whether the most probable single effect leaves something open.
bool leaves_much(const Evidence& best, double unknown) {
  constexpr double kMuchLeft = 0.1;  // of the gap's power
  return unknown > kDoubtful || best.excess > kWorthAName || best.run_error.value_or(0) > kMuchLeft;
}

/// What the leading effect of a pair leaves alone when it is fitted from where the pair ended: what a pair gains may be
/// a better optimum of one of the two.
double nats_of_leading(const ComparisonSetting& alone, const CausePair& pair, const AttributionInput& input) {
  const auto single = std::ranges::find(input.all, pair.leading, &Evidence::id);
  std::optional<Effect> leading = pair.first_effect;
  if (pair.leading == pair.second.id) leading = fitted_effect(pair.second);
  if (!leading || single == input.all.end()) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd& x = pair.second.fit.x;
  if (pair.leading == pair.first) {
    const auto second = static_cast<std::ptrdiff_t>(fitted_effect(pair.second).value_or(Effect()).values.size());
    std::copy_n(x.end() - second - std::ssize(leading->values), leading->values.size(), leading->values.begin());
  }
  ComparisonSetting setting = alone;
  setting.present.push_back(*leading);
  const ComparedParts there = compared_parts(setting.present);
  const Whittle::Fit fit = fit_from(setting, there, joined(wheel_of(x), there.present));
  return fit.cost(kSeen) + single->complexity;
}

/// Whether a pair that is likely enough also gains enough over the best single effect.
bool gains_enough(const ComparisonSetting& alone, const CausePair& pair, const AttributionInput& input,
                  const std::vector<double>& probability) {
  const Evidence& single = *std::ranges::min_element(input.all, {}, [](const Evidence& one) {
    return one.eligible ? one.fit_nats + one.choose_nats : std::numeric_limits<double>::infinity();
  });
  if (!worth_it(priced_nats(single), pair.evidence)) return false;
  if (!worth_it(nats_of_leading(alone, pair, input), pair.evidence)) return false;
  if (*std::ranges::max_element(probability) == probability.back()) return true;
  // A slow torque takes up some of what any effect's fit leaves: beside one that explains the record it says little.
  const bool slow = pair.slow == SlowTorque::kCause || pair.second.id == "unmeasured_torque";
  return !(slow && probability.back() < kDoubtful) &&
         (gains_enough(single.excess, priced_nats(single), pair.evidence) || closes_run(single, pair.evidence));
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

std::optional<CausePair> pair_instead(const ComparisonSetting& alone, const Comparison& singles,
                                      const AttributionInput& input, std::vector<double>& probability) {
  const auto best = static_cast<std::size_t>(std::ranges::max_element(probability) - probability.begin());
  const bool unknown = best == input.all.size();
  if (!unknown && !(names_effect(input.all[best].id) && leaves_much(input.all[best], probability.back()))) return {};
  std::optional<CausePair> pair = PairSearch(alone, singles, input).best();
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
