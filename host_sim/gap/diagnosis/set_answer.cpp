// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/set_answer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gap/diagnosis/time_limit.hpp"
#include "gap/diagnosis/verdict_ids.hpp"
#include "gap/likelihood/fast_torque_left.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/sets/discrepancy.hpp"
#include "gap/sets/joint_sets.hpp"
#include "gap/sets/set_search.hpp"
#include "gap/sets/wheel_shift.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// Probabilities as they are with the record's own defects, the most probable first; their sum is one.
std::vector<RankedEffect> with_defects(std::vector<RankedEffect> ranking, const std::vector<RecordDefect>& defects) {
  for (const RecordDefect& defect : defects) {
    for (RankedEffect& one : ranking) {
      one.probability *= 1 - defect.probability();
      if (one.id == defect.effect.type->id) one.probability += defect.probability();
    }
  }
  double sum = 0;
  for (const RankedEffect& one : ranking) sum += one.probability;
  for (RankedEffect& one : ranking) one.probability /= sum;
  std::ranges::stable_sort(ranking, std::ranges::greater(), &RankedEffect::probability);
  return ranking;
}

std::string noise_words(const FastTorque& torque) {
  std::vector<std::string> parts;
  if (torque.tail_variance > 0) {
    parts.push_back(fmt::format("the tail of a slow torque of {:.2g} Nm", std::sqrt(torque.tail_variance)));
  }
  if (torque.tremor_variance > 0) {
    parts.push_back(
        fmt::format("a tremor of {:.2g} Nm at {:g} Hz", std::sqrt(torque.tremor_variance), torque.tremor_hz));
  }
  return fmt::format("above 1 Hz the driver adds a torque that no sensor sees, and that counts as noise: {}",
                     fmt::join(parts, ", and "));
}

}  // namespace

SetAnswer::SetAnswer(PreparedRecord& prepared, const Simulation& simulation, const DiagnoseOptions& options)
    : prepared_(prepared), simulation_(simulation), options_(options) {
  set_up();
}

void SetAnswer::search() {
  search_once();
  const FittedSet& found = sets_->answer();
  if (found.set.has(effect::delay) &&
      prepared_.look_again(simulation_, found.at().find(effect::delay)->at("delay_s"))) {
    search_once();
  }
  constexpr double kThere = 0.8;  // an excess below which a floor that is known from above only is too high
  constexpr int kTimes = 4;
  const auto time_is_left = [&] { return time_for("a second look at the noise", options_, prepared_.notes); };
  const auto too_noisy = [&] { return sets_->answer().excess() < kThere && prepared_.whittle->white().at_most; };
  for (int i = 0; i < kTimes && too_noisy() && time_is_left(); ++i) {
    prepared_.lower_torque_noise(sets_->answer().excess());
    search_once();
  }
  if (prepared_.spectral->spectra.step_rad() > 0 && time_is_left()) {
    const FittedSet& best = sets_->answer();
    SimulatedModel model(*prepared_.spectral, best.set.hypotheses(), best.course);
    if (const std::span<const double> run_rad = model.run(best.at()); !run_rad.empty()) {
      prepared_.round_as(run_rad);
      search_once();
    }
  }
  discrepancy_nats_ = discrepancy_nats(sets_->answer(), SetFitter(*setting_));
  allow_for_fast_torque();
  inclusion_ = inclusion_of(*sets_, std::array{RecordSets{*setting_, *sets_}}, discrepancy_nats_);
}

void SetAnswer::allow_for_fast_torque() {
  const FittedSet first = sets_->answer();
  const FastTorque left =
      fast_torque_left(*prepared_.whittle, prepared_.spectral->torque, first.fit, first.set.slow, kSeen);
  if (!left.any() || !time_for("a second look, for the driver's torque above 1 Hz,", options_, prepared_.notes)) return;
  std::optional<SearchedSets> without = std::exchange(sets_, std::nullopt);
  prepared_.count_as_noise(left);
  set_up();
  const SetFitter fitter(*setting_);
  double beside = 0;
  const auto leaves_nothing = [&](const FittedSet& one) {
    if (one.excess() >= kReached) return false;
    beside = discrepancy_nats(one, fitter);
    return beside < kStrong_nats;
  };
  if (leaves_nothing(fitter.fit(first.set, first.at(), first.course))) {
    search_once();
    if (leaves_nothing(sets_->answer())) {
      discrepancy_nats_ = beside;
      prepared_.notes.push_back(noise_words(left));
      return;
    }
  }
  prepared_.count_as_noise({});
  set_up();
  sets_ = std::move(without);
}

void SetAnswer::search_once() {
  std::vector<Move> known;
  if (sets_) known.push_back({sets_->answer().set, sets_->answer().at(), nullptr});
  set_up();
  sets_ = search_sets(*setting_, known);
}

void SetAnswer::set_up() {
  std::vector<Effect> given = simulation_.effects;  // those of the record were repaired away
  std::erase_if(given, [](const Effect& effect) { return hypothesis_of(*effect.type) == nullptr; });
  std::vector<std::string> without = options_.without;
  without.insert(without.end(), prepared_.untold.begin(), prepared_.untold.end());
  const auto out_of_time = [this] {  // what is not believed is not looked for
    return !options_.not_credible.empty() || !time_for("the search for further changes", options_, prepared_.notes);
  };
  setting_.emplace(SetSetting{.record = *prepared_.spectral,
                              .whittle = *prepared_.whittle,
                              .wheel = simulation_.wheel,
                              .given = std::move(given),
                              .without = std::move(without),
                              .threads = options_.threads,
                              .out_of_time = out_of_time});
}

std::vector<RankedEffect> SetAnswer::ranking(const std::vector<RecordDefect>& defects) const {
  constexpr double kLeast = 1e-6;  // nothing is impossible
  double changed = 0;
  for (const ChangeInclusion& one : inclusion_.changes) changed += one.probability;
  const double unchanged = inclusion_.none + inclusion_.parameters + inclusion_.unknown;
  const double scale = changed > 0 ? (1 - unchanged) / changed : 0;
  std::vector<RankedEffect> ranking;
  for (const std::string& id : verdict_ids()) {
    double own = kLeast +
                 (id == "none"         ? inclusion_.none
                  : id == "parameters" ? inclusion_.parameters
                                       : 0) +
                 (id == "unknown" ? inclusion_.unknown : 0);
    for (const ChangeInclusion& one : inclusion_.changes) own += one.type->id == id ? scale * one.probability : 0;
    ranking.push_back({id, own});
  }
  return with_defects(std::move(ranking), defects);
}

std::string SetAnswer::verdict() const {
  if (const std::vector<Cause> all = changes(); !all.empty()) return std::string(all.front().effect.type->id);
  // What no named change explains is none of these two where it is likelier that something is changed.
  if (inclusion_.none + inclusion_.parameters < 0.5) return "unknown";
  return inclusion_.parameters > inclusion_.none ? "parameters" : "none";
}

const FittedSet& SetAnswer::named() const {
  const EffectSet& answer = judged().visited[inclusion_.answer].set;
  EffectSet freed = answer;
  freed.wheel_given = false;
  const FittedSet* one = sets_->find(freed);
  return one != nullptr ? *one : *sets_->find(answer);
}

FinalFit SetAnswer::final_fit() const { return gap::final_fit(prepared_, SetFitter(*setting_), named()); }

std::optional<FinalFit> SetAnswer::fit_alone() const {
  if (!named().apart) return std::nullopt;
  return gap::final_fit(prepared_, SetFitter(*setting_), *named().apart);
}

std::vector<Cause> SetAnswer::changes() const {
  std::vector<Cause> all;
  const FittedSet& one = named();
  const Point at = one.at();
  for (const ChangeInclusion& change : inclusion_.changes) {
    if (!makes(one.set, *change.type, change.kind)) continue;
    Cause& out = all.emplace_back(
        Cause{.effect = Effect(*change.type), .change = change.kind, .probability = change.probability});
    const auto was = std::ranges::find(setting_->given, change.type, &Effect::type);
    if (was != setting_->given.end()) out.was = *was;
    if (change.kind == ChangeKind::kRemove) out.effect = *was;
    if (const Effect* found = at.find(*change.type)) out.effect = *found;
  }
  return all;
}

bool SetAnswer::take_surrogate() {
  if (sets_->answer().set.changes() == 0) return false;
  inclusion_.answer = judged().best;
  return true;
}

void SetAnswer::refuse_surrogate() { inclusion_.answer = likely_answer(judged(), inclusion_.changes); }

bool SetAnswer::wheel_out_of_place() const {
  return shift_at_least(simulation_.wheel, sets_->answer().fit) > kOutOfPlace;
}

std::vector<std::string> SetAnswer::equivalents() const {
  const FittedSet& answer = judged().visited[inclusion_.answer];
  std::vector<std::string> ids;
  for (const ChangeInclusion& change : inclusion_.changes) {
    if (!makes(answer.set, *change.type, change.kind)) continue;
    for (const ChangeInclusion* other : in_place_of(judged(), answer, change, inclusion_.changes)) {
      const std::string id(other->type->id);
      if (other->type == change.type) continue;  // of another size in place of removed: a size of next to nothing
      if (std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
    }
  }
  return ids;
}

std::vector<SetEvidence> SetAnswer::evidence() const {
  const SearchedSets& all = judged();
  std::vector<SetEvidence> out;
  for (const FittedSet& one : all.visited) {
    if (!one.eligible) continue;
    SetEvidence& evidence = out.emplace_back();
    for (const ChangeInclusion& change : inclusion_.changes) {
      if (makes(one.set, *change.type, change.kind)) {
        evidence.changes.push_back({std::string(change.type->id), change.kind});
      }
    }
    evidence.wheel_given = one.set.wheel_given;
    evidence.nats = one.nats();
    evidence.excess = one.excess();
    evidence.lines = one.lines();
    evidence.left_nats = one.left_nats();
    evidence.occam = one.occam;
    evidence.log_odds = all.score(one) - all.score(all.answer());
  }
  std::ranges::stable_sort(out, std::ranges::greater(), &SetEvidence::log_odds);
  return out;
}

void SetAnswer::refuse(const EffectType& type) {
  double lost = 0;
  for (ChangeInclusion& one : inclusion_.changes) {
    if (one.type != &type) continue;
    one.refused = true;
    const double before = std::exchange(one.probability, std::min(one.probability, 1 - kLikely));
    lost = std::max(lost, before - one.probability);
  }
  // What the change loses is shared by what is left if nothing is changed but J, B and C.
  const double unchanged = inclusion_.none + inclusion_.parameters + inclusion_.unknown;
  const double more = unchanged > 0 ? std::min(unchanged + lost, 1.0) / unchanged : 1;
  for (double* one : {&inclusion_.none, &inclusion_.parameters, &inclusion_.unknown}) *one *= more;
  inclusion_.answer = likely_answer(judged(), inclusion_.changes);
}

void SetAnswer::refuse_wheel(bool as_given) {
  (as_given ? inclusion_.none : inclusion_.unknown) += std::exchange(inclusion_.parameters, 0.0);
}

void SetAnswer::believe_nothing() {
  for (ChangeInclusion& one : inclusion_.changes) {
    one.refused = true;
    one.probability = 0;
  }
  inclusion_.none = 0;
  inclusion_.parameters = 0;
  inclusion_.unknown = 1;
  inclusion_.answer = likely_answer(judged(), inclusion_.changes);
}

std::vector<RecordSets> SetAnswer::sets_of(std::span<SetAnswer* const> records) {
  std::vector<RecordSets> all;
  for (SetAnswer* record : records) all.push_back({*record->setting_, *record->sets_});
  return all;
}

void SetAnswer::share_named(std::span<SetAnswer* const> records) {
  fit_together(sets_of(records), records.front()->named());
}

void SetAnswer::join(std::span<SetAnswer* const> records) {
  const std::vector<RecordSets> all = sets_of(records);
  double discrepancy = 0;
  for (const SetAnswer* record : records) discrepancy += record->discrepancy_nats_;
  const auto joint = std::make_shared<const SearchedSets>(joint_sets(all));
  const Inclusion inclusion = inclusion_of(*joint, all, discrepancy);
  for (SetAnswer* record : records) {
    record->joint_ = joint;
    record->inclusion_ = inclusion;
  }
}

}  // namespace steerid::gap
