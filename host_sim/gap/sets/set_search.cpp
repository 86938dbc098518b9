// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "gap/hypotheses/slow_share.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/compared_parts.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/sets/spectral_search.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

// How often a simulation is right in what it says, before a record is looked at.
constexpr double kWheelGiven = 0.5;
constexpr double kKept = 0.7;
constexpr double kResized = 0.2;
constexpr double kAddedEach = 0.03;

double log_prior(const EffectSet& set) {
  double sum = std::log(set.wheel_given ? kWheelGiven : 1 - kWheelGiven);
  for (const SetPart& part : set.parts) {
    sum += std::log(part.as == Stands::kGiven ? kKept : part.as == Stands::kResized ? kResized : kAddedEach);
  }
  sum += static_cast<double>(set.removed.size()) * std::log(1 - kKept - kResized);
  return sum + (set.slow == SlowTorque::kCause ? std::log(kAddedEach) : 0);
}

class SetSearch {
 public:
  explicit SetSearch(const SetSetting& setting)
      : setting_(setting), record_(carried_by(setting)), fitter_(on(record_)) {}

  SearchedSets run() {
    begin();
    constexpr std::size_t kMost = 6;  // rounds: a set of four, one that takes something back, one that finds nothing
    for (std::size_t round = 0; round < kMost; ++round) {
      if (round > 0 && setting_.out_of_time()) break;
      const std::string before = out_.answer().set.name();
      // All moves begin at one set and are judged by one evidence. A size that was moved first, because nothing else
      // was tried yet, would otherwise stand for what is missing.
      const FittedSet from = free_wheel(out_.answer());
      std::vector<Start> starts = revisions(from);
      std::ranges::move(additions(from), std::back_inserter(starts));
      visit_all(std::move(starts));
      settle_best();
      if (out_.answer().set.name() == before) break;
    }
    out_.judge();
    return std::move(out_);
  }

 private:
  [[nodiscard]] SetSetting on(const SpectralRecord& record) const {
    return {record,         setting_.whittle, setting_.wheel,   setting_.given,
            setting_.fixed, setting_.without, setting_.threads, setting_.out_of_time};
  }

  static EffectSet as_given(const SetSetting& setting) {
    EffectSet set;
    for (const Effect& effect : setting.given) set.parts.push_back({hypothesis_of(*effect.type), Stands::kGiven});
    return set;
  }

  /// The simulation's effects to begin from: with bristles, as friction that is given as ideal leads to none.
  static std::vector<Effect> given_to_begin(const SetSetting& setting) {
    std::vector<Effect> all = setting.given;
    for (Effect& effect : all) effect.values = hypothesis_of(*effect.type)->to_run(effect.values, setting.wheel);
    return all;
  }

  static SpectralRecord carried_by(const SetSetting& setting) {
    if (setting.given.empty()) return setting.record;
    SimulatedModel run(setting.record, as_given(setting).hypotheses(), setting.fixed);
    return carried_record(setting.record, run, joined(setting.wheel, given_to_begin(setting)));
  }

  void begin() {
    EffectSet set = as_given(setting_);
    const Eigen::VectorXd x = joined(setting_.wheel, given_to_begin(setting_));
    visit(fitter_.fit(set, x));
    set.wheel_given = false;
    visit(fitter_.fit(set, x));
    settle_best();
  }

  void visit(FittedSet one) {
    one.eligible = beyond_the_floor(one);
    const FittedSet* same = out_.find(one.set);
    if (same == nullptr) {
      out_.visited.push_back(std::move(one));
    } else if (one.eligible >= same->eligible && one.log_evidence(1) > same->log_evidence(1)) {
      out_.visited[static_cast<std::size_t>(same - out_.visited.data())] = std::move(one);
    }
    out_.rank();
  }

  /// Whether everything that the set adds is more than what every record has.
  [[nodiscard]] bool beyond_the_floor(const FittedSet& one) const {
    const auto [least, most] = std::ranges::minmax(record_.motion.angle_rad);
    const Hypothesis::Usual usual{.applied_rms_nm = setting_.whittle.applied_rms_nm(),
                                  .swing_rad = most - least,
                                  .step_rad = setting_.whittle.spectra().step_rad(),
                                  .loop_holds = setting_.whittle.white().at_most};
    const double slow_share = std::sqrt(one.fit.floor.slow_variance) / usual.applied_rms_nm;
    if (one.set.slow == SlowTorque::kCause && slow_share < kSlowShareBetween) return false;
    return std::ranges::all_of(one.set.parts, [&](const SetPart& part) {
      const double* values = one.fit.x.data() + one.set.place_of(part.hypothesis->type());
      return part.as != Stands::kAdded || part.hypothesis->beyond_usual(values, usual);
    });
  }

  void settle_best() {
    for (int again = 0; again < 2; ++again) {
      const std::size_t best = out_.best;
      visit(fitter_.settled(out_.visited[best]));
      if (out_.best == best) break;
    }
    settle_relatives();
  }

  /// The answer's sets with another of its family in the place of an effect: which of a family it is, is told by
  /// details, and a fit that was left early would decide it.
  void settle_relatives() {
    const FittedSet best = out_.answer();
    if (best.excess() < kNearNoise) return;
    std::vector<FittedSet> all;
    for (const FittedSet& one : out_.visited) {
      if (&one != &out_.answer() && one.eligible && are_relatives(one.set, best.set)) all.push_back(one);
    }
    std::vector<std::optional<FittedSet>> found(all.size());
    work_in_parallel(all.size(), setting_.threads, [&](std::size_t i) { found[i] = fitter_.settled(all[i]); });
    for (std::optional<FittedSet>& one : found) visit(std::move(*one));
  }

  static bool are_relatives(const EffectSet& a, const EffectSet& b) {
    if (a.parts.size() != b.parts.size() || a.slow != b.slow || a.wheel_given != b.wheel_given) return false;
    return std::ranges::all_of(a.parts, [&](const SetPart& part) {
      return std::ranges::any_of(b.parts, [&](const SetPart& other) {
        const Hypothesis::Family family = part.hypothesis->family();
        return part.as == other.as && (part.hypothesis == other.hypothesis ||
                                       (family != Hypothesis::Family::kNone && family == other.hypothesis->family()));
      });
    });
  }

  /// The same set with J, B and C free, as it was fitted.
  FittedSet free_wheel(FittedSet one) {
    if (!one.set.wheel_given) return one;
    one.set.wheel_given = false;
    if (const FittedSet* same = out_.find(one.set)) return *same;
    return fitter_.fit(one.set, one.fit.x, one.course);
  }

  struct Start {
    EffectSet set;
    Eigen::VectorXd x;
    std::shared_ptr<const SlowCourse> course;
  };

  /// Fits those of the sets that were not visited yet.
  void visit_all(std::vector<Start> starts) {
    std::erase_if(starts, [&](const Start& one) { return out_.find(one.set) != nullptr; });
    std::vector<std::optional<FittedSet>> found(starts.size());
    work_in_parallel(starts.size(), setting_.threads,
                     [&](std::size_t i) { found[i] = fitter_.fit(starts[i].set, starts[i].x, starts[i].course); });
    for (std::optional<FittedSet>& one : found) visit(std::move(*one));
  }

  /// Effects of the simulation resized and removed, changes taken back.
  [[nodiscard]] std::vector<Start> revisions(const FittedSet& from) const {
    std::vector<Start> starts;
    for (const SetPart& part : from.set.parts) {
      const EffectType& type = part.hypothesis->type();
      if (part.as == Stands::kGiven) {
        starts.push_back({with_resized(from.set, type), from.fit.x, from.course});
        EffectSet alone = starts.back().set;
        alone.wheel_given = true;
        Eigen::VectorXd given = from.fit.x;
        given.head(3) = joined(setting_.wheel, {});
        starts.push_back({std::move(alone), std::move(given), from.course});
      }
      Eigen::VectorXd x = from.fit.x;
      EffectSet rest = without(from.set, type, x);
      starts.push_back({rest, x, from.course});
      if (part.as == Stands::kAdded) exchange(part, from, rest, x, starts);
      if (part.as == Stands::kResized) starts.push_back(as_given_again(from, type));
    }
    for (const EffectType* type : from.set.removed) starts.push_back(as_given_again(from, *type));
    if (from.set.slow == SlowTorque::kCause) {
      starts.push_back({from.set, from.fit.x, from.course});
      starts.back().set.slow = SlowTorque::kFloor;
    }
    return starts;
  }

  /// With an effect of the simulation as it is given, and with the J, B and C that go with it there: those that were
  /// found may make up for its size.
  [[nodiscard]] Start as_given_again(const FittedSet& from, const EffectType& type) const {
    Start out{from.set, from.fit.x, from.course};
    if (out.set.has(type)) out.set = without(std::move(out.set), type, out.x);
    std::erase(out.set.removed, &type);
    const std::vector<Effect> given = given_to_begin(setting_);
    std::vector<double> values = std::ranges::find(given, &type, &Effect::type)->values;
    out.set.parts.insert(out.set.parts.begin(), {hypothesis_of(type), Stands::kGiven});
    values.insert(values.begin(), {setting_.wheel.inertia_kgm2, setting_.wheel.damping_nms_per_rad,
                                   setting_.wheel.stiffness_nm_per_rad});
    values.insert(values.end(), out.x.begin() + 3, out.x.end());
    out.x = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
    return out;
  }

  /// Others of its family in the place of what was added, with values that act alike. `rest` at `x`: without it.
  void exchange(const SetPart& part, const FittedSet& from, const EffectSet& rest, const Eigen::VectorXd& x,
                std::vector<Start>& starts) const {
    const EffectType& type = part.hypothesis->type();
    Effect added(type);
    const double* values = from.fit.x.data() + from.set.place_of(type);
    added.values.assign(values, values + added.values.size());
    add_relatives(*part.hypothesis, added, rest, x, from.course, starts);
  }

  void add_relatives(const Hypothesis& of, const Effect& added, const EffectSet& rest, const Eigen::VectorXd& x,
                     const std::shared_ptr<const SlowCourse>& course, std::vector<Start>& starts) const {
    if (of.family() == Hypothesis::Family::kNone) return;
    for (const auto& other : hypotheses()) {
      if (other->family() != of.family() || other.get() == &of || rest.has(other->type())) continue;
      if (std::ranges::find(setting_.without, other->type().id) != setting_.without.end()) continue;
      if (const auto alike = other->in_place_of(added)) {
        starts.push_back({with(rest, *other), point_at(x, *alike), course});
      }
    }
  }

  [[nodiscard]] bool may_add(const EffectType& type, const FittedSet& base) const {
    if (std::ranges::find(setting_.without, type.id) != setting_.without.end()) return false;
    if (std::ranges::find(base.set.removed, &type) != base.set.removed.end() || base.set.has(type)) return false;
    std::vector<Effect> present = effects_at(base.fit.x, base.set.hypotheses(), setting_.fixed);
    return goes_with(type, present);
  }

  /// The set with the effect behind the others.
  [[nodiscard]] static EffectSet with(EffectSet set, const Hypothesis& hypothesis) {
    set.parts.push_back({&hypothesis, Stands::kAdded});
    return set;
  }

  /// What may be missing beside a set: sorted by score tests, the best fitted on the motion of its run.
  [[nodiscard]] std::vector<Start> additions(const FittedSet& base) const {
    const SpectralModel::Parts parts = base.set.hypotheses();
    SimulatedModel run(setting_.record, parts, setting_.fixed, base.course);
    const SpectralRecord record = carried_record(record_, run, base.fit.x);
    Spectrum offset;
    if (base.motion == Motion::kFreeRuns) {
      Spectrum on_motion;
      Response response;
      run.evaluate(base.fit.x, offset, response);
      SpectralModel(record, parts).evaluate(base.fit.x, on_motion, response);
      offset -= on_motion;
    }
    const std::vector<Fitted> fitted = fitter_.fitted(base.set);
    RunSlopes slopes(record, parts);
    std::vector<SearchOrigin> origins;
    const auto begin_at = [&](const Whittle::Fit& fit) {
      origins.push_back({LinearScan(record, setting_.whittle, parts, fit, kSeen, offset, slopes.at(fit.x, fitted)),
                         fit.x, with_torques_of(parts, record, fit.x)});
    };
    begin_at(base.fit);
    // J, B and C that make up for what is missing may be far from where it is found; the simulation's are near.
    if (base.set.changes() == 0) begin_at(out_.visited.front().fit);

    struct Added {
      const Hypothesis* hypothesis = nullptr;
      double nats = 0;  ///< promised, then reached
      Whittle::Fit fit{};
    };
    std::vector<Added> all;
    for (const auto& hypothesis : hypotheses()) {
      if (may_add(hypothesis->type(), base)) all.push_back({hypothesis.get()});
    }
    work_in_parallel(all.size(), setting_.threads, [&](std::size_t i) {
      if (!all[i].hypothesis->acts()) return;
      for (const SearchOrigin& origin : origins) {
        const auto points = starting_points(*all[i].hypothesis, record, origin);
        if (!points.empty()) all[i].nats = std::max(all[i].nats, points.front().nats);
      }
    });
    constexpr double kLeast = 4;  // nats: what an added number costs at least
    constexpr std::size_t kScanned = 6;
    constexpr std::size_t kRunAtFirst = 8;
    constexpr std::size_t kRunLater = 4;
    std::vector<double> promised;
    promised.reserve(all.size());
    for (const Added& one : all) promised.push_back(one.nats);
    std::ranges::sort(promised, std::greater());
    double least = kLeast * out_.dispersion;
    if (promised.size() >= kScanned) least = std::max(least, promised[kScanned - 1]);
    std::erase_if(all, [&](const Added& one) { return one.hypothesis->acts() && one.nats < least; });
    work_in_parallel(all.size(), setting_.threads, [&](std::size_t i) {
      all[i].fit = search(*all[i].hypothesis, {record, setting_.whittle, origins, parts, setting_.wheel, setting_.wheel,
                                               kSeen, base.set.slow, offset, fitted});
      all[i].nats = all[i].fit.cost(kSeen);
    });
    std::ranges::sort(all, {}, &Added::nats);
    const std::size_t most = base.set.changes() == 0 ? kRunAtFirst : kRunLater;
    std::erase_if(all, [&](const Added& one) { return base.nats() - one.nats < kLeast * out_.dispersion; });
    if (all.size() > most) all.resize(most);
    std::vector<Start> starts;
    for (const Added& one : all) {
      const Eigen::VectorXd origin = origin_of(one.fit.x, one.hypothesis->type());
      Effect added(one.hypothesis->type());
      std::copy(one.fit.x.end() - std::ssize(added.values), one.fit.x.end(), added.values.begin());
      added.values = one.hypothesis->to_run(added.values, wheel_of(one.fit.x));
      starts.push_back({with(base.set, *one.hypothesis), point_at(origin, added.values), base.course});
      if (one.hypothesis->sticks()) {
        add_relatives(*one.hypothesis, added, base.set, origin, base.course, starts);
      }
    }
    if (base.set.slow == SlowTorque::kFloor && may_add(effect::unmeasured_torque, base)) {
      starts.push_back({base.set, base.fit.x, base.course});
      starts.back().set.slow = SlowTorque::kCause;
    }
    return starts;
  }

  SetSetting setting_;
  SpectralRecord record_;  // with the motion that the simulation's own run carries
  SetFitter fitter_;
  SearchedSets out_;
};

}  // namespace

double SearchedSets::score(const FittedSet& one, double dispersion) {
  if (!one.eligible) return -std::numeric_limits<double>::infinity();
  return one.log_evidence(dispersion) + log_prior(one.set);
}

const FittedSet* SearchedSets::find(const EffectSet& set) const {
  const std::string name = set.name();
  const auto same = std::ranges::find_if(visited, [&](const FittedSet& one) { return one.set.name() == name; });
  return same == visited.end() ? nullptr : &*same;
}

const FittedSet& SearchedSets::nearest() const {
  return *std::ranges::min_element(visited, {}, [](const FittedSet& one) {
    return one.eligible ? one.nats() : std::numeric_limits<double>::infinity();
  });
}

void SearchedSets::rank() { rank_by(std::max(1.0, nearest().excess())); }

void SearchedSets::judge() { rank_by(nearest().left_nats() / nearest().chance_nats()); }

void SearchedSets::rank_by(double by) {
  dispersion = by;
  const auto highest = std::ranges::max_element(visited, {}, [&](const FittedSet& one) { return score(one); });
  best = static_cast<std::size_t>(highest - visited.begin());
}

std::vector<double> SearchedSets::probabilities() const {
  std::vector<double> all;
  double sum = 0;
  for (const FittedSet& one : visited) {
    all.push_back(std::exp(score(one) - score(visited[best])));
    sum += all.back();
  }
  for (double& one : all) one /= sum;
  return all;
}

SearchedSets search_sets(const SetSetting& setting) { return SetSearch(setting).run(); }

}  // namespace steerid::gap
