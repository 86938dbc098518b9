// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/joint_sets.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "gap/sets/shared_sizes.hpp"
#include "parallel/work_in_parallel.hpp"

namespace steerid::gap {
namespace {

constexpr double kNoMatter = 10;  // nats behind the best set

/// The record's most likely sets, and those within its answer: what is named in the end may be a part of it.
std::vector<const FittedSet*> likeliest(const SearchedSets& sets) {
  constexpr std::size_t kMost = 6;
  std::vector<const FittedSet*> all;
  for (const FittedSet& one : sets.visited) all.push_back(&one);
  std::ranges::stable_sort(all, std::ranges::greater(), [&](const FittedSet* one) { return sets.score(*one); });
  std::vector<const FittedSet*> taken;
  for (const FittedSet* one : all) {
    if (taken.size() < kMost || one->set.changes_within(sets.answer().set)) taken.push_back(one);
  }
  return taken;
}

/// As another record has it, with the record's own J, B and C.
Point start_of(const FittedSet& other, const RecordSets& record) {
  return {other.set.wheel_given ? record.setting.wheel : record.sets.answer().at().wheel, other.at().effects};
}

void visit(const RecordSets& record, const std::vector<FittedSet>& wanted) {
  std::vector<const FittedSet*> missing;
  for (const FittedSet& one : wanted) {
    if (record.sets.find(one.set) == nullptr) missing.push_back(&one);
  }
  const SetFitter fitter(record.setting);
  std::vector<std::optional<FittedSet>> found(missing.size());
  work_in_parallel(missing.size(), record.setting.threads, [&](std::size_t i) {
    found[i] = fitter.settled(fitter.fit(missing[i]->set, start_of(*missing[i], record)), 1);
    found[i]->eligible = missing[i]->eligible;
  });
  for (std::optional<FittedSet>& one : found) record.sets.visited.push_back(std::move(*one));
  record.sets.judge();
}

FittedSet sum_of(std::span<const RecordSets> records, const EffectSet& set) {
  FittedSet sum = *records.front().sets.find(set);
  for (const RecordSets& record : records.subspan(1)) {
    const FittedSet& own = *record.sets.find(set);
    sum.fit.penalty += own.fit.penalty;
    for (std::size_t role = 0; role < sum.fit.misfit.size(); ++role) sum.fit.misfit[role] += own.fit.misfit[role];
    sum.occam += own.occam;
    sum.eligible = sum.eligible || own.eligible;
    sum.wheel_at_limit = sum.wheel_at_limit || own.wheel_at_limit;
  }
  return sum;
}

}  // namespace

SearchedSets joint_sets(std::span<const RecordSets> records) {
  SearchedSets joint;
  joint.visited = {records.front().sets.visited[0], records.front().sets.visited[1]};
  for (const RecordSets& record : records) {
    for (const FittedSet* one : likeliest(record.sets)) {
      if (joint.find(one->set) == nullptr) joint.visited.push_back(*one);
    }
  }
  for (const RecordSets& record : records) visit(record, joint.visited);
  const auto add_up = [&] {
    for (FittedSet& sum : joint.visited) sum = sum_of(records, sum.set);
    joint.judge();
  };
  add_up();
  // Sizes in common save less than all numbers cost.
  for (const FittedSet& one : joint.visited) {
    if (joint.score(one) + one.occam > joint.score(joint.answer()) - kNoMatter) share_sizes(records, one.set);
  }
  add_up();
  return joint;
}

void fit_together(std::span<const RecordSets> records, const FittedSet& wanted) {
  const std::vector<FittedSet> one(1, wanted);  // a copy: it may be among those that are visited
  for (const RecordSets& record : records) visit(record, one);
  share_sizes(records, one.front().set);
}

}  // namespace steerid::gap
