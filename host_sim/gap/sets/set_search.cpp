// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "gap/hypotheses/slow_share.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/sets/additions.hpp"
#include "gap/sets/joint_scan.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

class SetSearch {
 public:
  explicit SetSearch(const SetSetting& setting)
      : setting_(setting), record_(carried_by(setting)), fitter_(on(record_)) {}

  [[nodiscard]] FittedSet begun_with_free_wheel() const {
    EffectSet set = as_given(setting_);
    set.wheel_given = false;
    return fitter_.fit(set, given_to_begin(setting_));
  }

  SearchedSets run(const std::vector<Move>& known) {
    begin();
    visit_and_correct(known);
    settle_best();
    constexpr std::size_t kMost = 6;  // rounds: a set of four, one that takes something back, one that finds nothing
    bool gone_on = true;
    for (std::size_t round = 0; round < kMost && gone_on && (round == 0 || !setting_.out_of_time()); ++round) {
      gone_on = add();
    }
    while (gone_on && !setting_.out_of_time()) gone_on = take_back();
    out_.judge();
    visit_with_given_wheel();
    return std::move(out_);
  }

 private:
  /// A round of all moves; false where it leads no further.
  bool add() {
    const FittedSet before = out_.answer();
    // All moves begin at one set and are judged by one evidence. A size that was moved first, because nothing else
    // was tried yet, would otherwise stand for what is missing.
    const FittedSet from = free_wheel(out_.answer());
    const FittedSet given = given_wheel(from);
    const Additions additions(from, &given, fitter_);
    if (from.set.changes() > 0) visit(given);
    std::vector<Move> moves = revisions(from, setting_);
    std::ranges::move(additions.single(out_.dispersion), std::back_inserter(moves));
    visit_and_correct(moves);
    settle_best();
    // Where nothing of the library is the cause, every effect takes a little of what is left, for ever.
    constexpr std::size_t kMany = 4;
    const double left = out_.answer().excess();
    if (from.set.changes() >= kMany && left > kReached && left - 1 > (from.excess() - 1) / 2) return false;
    // Several at once, where one change more leaves much.
    if (out_.answer().excess() > kNearNoise) {
      visit_and_correct(additions.joint());
      settle_best();
    }
    if (has_gone_on(before)) return true;
    visit_all(in_place_of_one());
    settle_best();
    return has_gone_on(before);
  }

  /// A round that adds nothing: of what was added one after another the last may do without the first.
  bool take_back() {
    const FittedSet before = out_.answer();
    visit_all(revisions(free_wheel(before), setting_));
    settle_best();
    return has_gone_on(before);
  }

  [[nodiscard]] SetSetting on(const SpectralRecord& record) const {
    return {record,           setting_.whittle, setting_.wheel,      setting_.given,
            setting_.without, setting_.threads, setting_.out_of_time};
  }

  static EffectSet as_given(const SetSetting& setting) {
    EffectSet set;
    for (const Effect& effect : setting.given) set.parts.push_back({hypothesis_of(*effect.type), Stands::kGiven});
    return set;
  }

  static SpectralRecord carried_by(const SetSetting& setting) {
    if (setting.given.empty()) return setting.record;
    SimulatedModel run(setting.record, as_given(setting).hypotheses());
    return carried_record(setting.record, run, given_to_begin(setting));
  }

  void begin() {
    visit(fitter_.fit(as_given(setting_), given_to_begin(setting_)));
    visit(begun_with_free_wheel());
  }

  void visit(FittedSet one) {
    // Where runs hardly hold together their slopes may be no numbers, and so is what the fitted ones cost.
    if (!std::isfinite(one.log_evidence(1)) && !out_.visited.empty()) return;
    one.eligible = beyond_the_floor(one).set.changes() == one.set.changes();
    const FittedSet* same = out_.find(one.set);
    if (same == nullptr) {
      out_.visited.push_back(std::move(one));
    } else if (one.log_evidence(1) >= same->log_evidence(1)) {
      out_.visited[static_cast<std::size_t>(same - out_.visited.data())] = std::move(one);
    }
    out_.rank();
  }

  /// The set without what is no more than every record has.
  [[nodiscard]] Move beyond_the_floor(const FittedSet& one) const {
    const auto [least, most] = std::ranges::minmax(record_.motion.angle_rad);
    const Hypothesis::Usual usual{.record = span_of(record_),
                                  .applied_rms_nm = setting_.whittle.applied_rms_nm(),
                                  .swing_rad = most - least,
                                  .step_rad = setting_.whittle.spectra().step_rad(),
                                  .loop_holds = setting_.whittle.white().at_most};
    Move beyond{one.set, one.at(), one.course};
    const double slow_share = std::sqrt(one.fit.floor.slow_variance) / usual.applied_rms_nm;
    if (slow_share < kSlowShareBetween) beyond.set.slow = SlowTorque::kFloor;
    for (const SetPart& part : one.set.parts) {
      const EffectType& type = *part.type();
      if (part.as != Stands::kAdded) continue;
      if (!part.hypothesis->beyond_usual(beyond.at.find(type)->values.data(), usual)) {
        beyond = without(std::move(beyond), type);
      }
    }
    return beyond;
  }

  /// Whether the answer is another set, or the same much nearer, so that all that was tried beside it is to be tried
  /// again.
  [[nodiscard]] bool has_gone_on(const FittedSet& before) const {
    const FittedSet& now = out_.answer();
    return now.set.name() != before.set.name() || now.nats() + kLeast * out_.dispersion < before.nats();
  }

  void settle_best() {
    for (int again = 0; again < 2; ++again) {
      const FittedSet best = out_.answer();
      visit(fitter_.settled(best, setting_.threads));
      correct({best.set});
      if (out_.answer().set.name() == best.set.name()) break;
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
    work_in_parallel(all.size(), setting_.threads, [&](std::size_t i) { found[i] = fitter_.settled(all[i], 1); });
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

  /// The sets with J, B and C free also with the simulation's, where that is likelier: what J, B and C cost may be more
  /// than a change is worth.
  void visit_with_given_wheel() {
    if (setting_.out_of_time()) return;
    std::vector<Move> moves;
    for (const FittedSet& one : out_.visited) {
      if (one.set.wheel_given || one.set.changes() == 0 || !one.eligible) continue;
      const auto [move, lost_nats] = with_given_wheel(one, setting_);
      if (lost_nats / out_.dispersion < fitter_.cost_of_wheel(one)) moves.push_back(move);
    }
    visit_all(moves);
    out_.judge();
  }

  /// The same set with J, B and C free, as it was fitted.
  FittedSet free_wheel(FittedSet one) {
    if (!one.set.wheel_given) return one;
    one.set.wheel_given = false;
    if (const FittedSet* same = out_.find(one.set)) return *same;
    return fitter_.fit(one.set, one.at(), one.course);
  }

  /// The same set with the simulation's J, B and C.
  [[nodiscard]] FittedSet given_wheel(const FittedSet& one) const {
    const Move move = with_given_wheel(one, setting_).move;
    if (const FittedSet* same = out_.find(move.set)) return *same;
    return fitter_.fit(move.set, move.at, move.course);
  }

  /// Another effect in the place of one that the answer adds, or that one found anew beside the others. Two that were
  /// found one after the other are not always the two that explain a record together.
  [[nodiscard]] std::vector<Move> in_place_of_one() const {
    std::vector<Move> all;
    const FittedSet answer = out_.answer();
    if (answer.set.changes() < 2) return all;  // beside none all were tried
    for (const SetPart& part : answer.set.parts) {
      if (part.as != Stands::kAdded) continue;
      EffectSet set = without(answer.set, *part.type());
      set.wheel_given = false;
      const FittedSet* rest = out_.find(set);
      if (rest == nullptr) continue;
      const Additions additions(*rest, nullptr, fitter_);
      std::ranges::move(additions.single(out_.dispersion), std::back_inserter(all));
    }
    return all;
  }

  /// Where one of the sets is nearer than the answer and is not eligible, what it has beyond the floor is as near, or
  /// it holds an effect by another one's name.
  void correct(const std::vector<EffectSet>& sets) {
    std::vector<Move> corrected;
    for (const EffectSet& set : sets) {
      const FittedSet* one = out_.find(set);
      if (one == nullptr || one->eligible || one->nats() > out_.answer().nats()) continue;
      corrected.push_back(beyond_the_floor(*one));
      std::ranges::move(exchanges(*one, setting_), std::back_inserter(corrected));
    }
    visit_all(corrected);
  }

  /// Fits the sets, and what may stand in the place of those that are not eligible.
  void visit_and_correct(const std::vector<Move>& moves) {
    visit_all(moves);
    std::vector<EffectSet> sets;
    for (const Move& move : moves) sets.push_back(move.set);
    correct(sets);
  }

  /// Fits those of the sets that were not visited yet, and those that are nearer already where they would begin now: a
  /// set that was fitted from elsewhere may have ended in a worse optimum. A set that holds one torque twice is left to
  /// the one that holds it once.
  void visit_all(const std::vector<Move>& moves) {
    std::vector<std::optional<FittedSet>> found(moves.size());
    work_in_parallel(moves.size(), setting_.threads, [&](std::size_t i) {
      const auto& [set, at, course] = moves[i];
      if (has_one_torque_twice(set)) return;
      const FittedSet* same = out_.find(set);
      const auto nearer = [&] {
        return fitter_.nats_at(set, at, course) + kLeast * out_.dispersion < same->fit.cost(kSeen);
      };
      if (same == nullptr || nearer()) found[i] = fitter_.fit(set, at, course);
    });
    for (std::optional<FittedSet>& one : found) {
      if (one) visit(std::move(*one));
    }
  }

  SetSetting setting_;
  SpectralRecord record_;  // with the motion that the simulation's own run carries
  SetFitter fitter_;
  SearchedSets out_;
};

}  // namespace

SearchedSets search_sets(const SetSetting& setting, const std::vector<Move>& known) {
  return SetSearch(setting).run(known);
}

FittedSet with_free_wheel(const SetSetting& setting) { return SetSearch(setting).begun_with_free_wheel(); }

}  // namespace steerid::gap
