// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/shared_sizes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "gap/likelihood/fit_spread.hpp"
#include "parallel/work_in_parallel.hpp"

namespace steerid::gap {
namespace {

/// How often an effect of a wheel has one size in all of its records, before they are looked at.
constexpr double kInCommon = 0.9;

using Indices = std::vector<Eigen::Index>;

/// Of the free numbers: those that are sizes of the wheel's, and all others.
struct Numbers {
  Indices sizes;
  Indices others;
};

bool is_wheels_own(const SetPart& part) { return part.as != Stands::kGiven && !part.hypothesis->timed(); }

/// Of the effects in the order of `like`: a record has them in the order in which they were found.
Numbers numbers_of(const EffectSet& set, const EffectSet& like, const Eigen::VectorXd& prior_sds) {
  Numbers out;
  for (Eigen::Index i = 0; i < 3; ++i) out.others.push_back(i);
  for (const SetPart& wanted : like.parts) {
    const auto part = std::ranges::find(set.parts, wanted.hypothesis, &SetPart::hypothesis);
    Eigen::Index at = set.first_number_of(*wanted.type());
    for (Eigen::Index i = 0; i < std::ssize(part->type()->parameters); ++i, ++at) {
      (is_wheels_own(*part) && i < part->hypothesis->sizes() ? out.sizes : out.others).push_back(at);
    }
  }
  const auto held = [&](Eigen::Index i) { return !(prior_sds[i] > 0); };
  std::erase_if(out.sizes, held);
  std::erase_if(out.others, held);
  return out;
}

Eigen::MatrixXd told_of_sizes(const FittedSet& one, const Numbers& numbers) {
  const Eigen::MatrixXd& all = one.fit.information;
  const auto count = std::ssize(numbers.sizes);
  if (all.rows() == 0) return Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd told = all(numbers.sizes, numbers.sizes);
  if (!numbers.others.empty()) {
    const Eigen::MatrixXd across = all(numbers.sizes, numbers.others);
    told -= across * covariance_of(all(numbers.others, numbers.others)) * across.transpose();
  }
  return told / std::max(1.0, one.excess());
}

/// The sizes, and where the record has all other numbers then, linearised.
Eigen::VectorXd moved_to(const Eigen::VectorXd& sizes, const FittedSet& one, const Numbers& numbers) {
  Held held;
  for (Eigen::Index i = 0; i < sizes.size(); ++i)
    held.emplace_back(numbers.sizes[static_cast<std::size_t>(i)], sizes[i]);
  return conditioned(one, held);
}

/// Of the record, by J, B, C and what is its own; `x` has the sizes.
FittedSet with_sizes(const RecordSets& record, const FittedSet& apart, const Eigen::VectorXd& x) {
  SetSetting setting = record.setting;
  EffectSet held = apart.set;
  const Point at = Point::of(x, held.hypotheses());
  for (SetPart& part : held.parts) {
    if (!is_wheels_own(part)) continue;
    part.as = Stands::kGiven;
    std::erase_if(setting.given, [&](const Effect& one) { return one.type == part.type(); });
    setting.given.push_back(*at.find(*part.type()));
  }
  const SetFitter fitter(setting);
  FittedSet out = fitter.settled(fitter.fit(held, at, apart.course), 1);
  out.set = apart.set;
  out.eligible = apart.eligible;
  out.fit.information = apart.fit.information;
  return out;
}

/// A set in all records, and what they tell of its sizes.
class Sharing {
 public:
  Sharing(std::span<const RecordSets> records, const EffectSet& set) : records_(records) {
    for (const RecordSets& record : records) {
      std::vector<FittedSet>& visited = record.sets.visited;
      own_.push_back(&visited[static_cast<std::size_t>(record.sets.find(set) - visited.data())]);
      const Eigen::VectorXd prior_sds = SetFitter(record.setting).prior_sds(own_.back()->set);
      numbers_.push_back(numbers_of(own_.back()->set, set, prior_sds));
      told_.push_back(told_of_sizes(*own_.back(), numbers_.back()));
      prior_sds_ = prior_sds(numbers_.back().sizes);
    }
    all_ = std::accumulate(told_.begin() + 1, told_.end(), told_.front());
  }

  [[nodiscard]] bool has_sizes() const { return prior_sds_.size() > 0; }
  [[nodiscard]] bool is_settled() const { return own_.front()->told_elsewhere.size() > 0; }
  void keep_apart() {
    for (FittedSet* one : own_) one->told_elsewhere = Eigen::VectorXd::Zero(one->fit.x.size());
  }

  /// From here on as if one record alone told them, the one that tells most: what is far from linear has no mean, such
  /// as a weight and its phase where the motion is small.
  void by_one_alone() {
    const auto best = std::ranges::max_element(told_, {}, [&](const Eigen::MatrixXd& one) { return gained(one); });
    all_ = *best;
    for (auto one = told_.begin(); one != told_.end(); ++one) {
      if (one != best) one->setZero();
    }
  }

  /// True where they are taken.
  bool take() {
    const Eigen::VectorXd sizes = in_common();
    std::vector<FittedSet> shared(own_.size());
    work_in_parallel(own_.size(), records_.front().setting.threads, [&](std::size_t r) {
      const Eigen::VectorXd x = moved_to(sizes, *own_[r], numbers_[r]);
      shared[r] = with_sizes(records_[r], *own_[r], within(x, SetFitter(records_[r].setting).fitted(own_[r]->set)));
      shared[r].occam += gained(all_) / static_cast<double>(own_.size());
    });
    if (lost(shared) > std::log(kInCommon / (1 - kInCommon))) return false;
    for (std::size_t r = 0; r < own_.size(); ++r) {
      const Eigen::VectorXd elsewhere = covariance_of(all_ - told_[r]).diagonal().cwiseMax(0.0).cwiseSqrt();
      shared[r].told_elsewhere = Eigen::VectorXd::Zero(own_[r]->fit.x.size());
      shared[r].told_elsewhere(numbers_[r].sizes) = elsewhere;
      shared[r].apart = std::make_shared<const FittedSet>(std::move(*own_[r]));
      *own_[r] = std::move(shared[r]);
    }
    return true;
  }

 private:
  [[nodiscard]] Eigen::VectorXd sizes_of(std::size_t r) const { return own_[r]->fit.x(numbers_[r].sizes); }
  [[nodiscard]] Eigen::VectorXd in_common() const {
    const Eigen::VectorXd first = sizes_of(0);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(first.size());
    for (std::size_t r = 0; r < own_.size(); ++r) pull += told_[r] * (sizes_of(r) - first);
    return first + covariance_of(all_) * pull;
  }

  [[nodiscard]] double gained(const Eigen::MatrixXd& told) const { return information_gained(told, prior_sds_); }

  /// Nats that all records lose by them, over their excess.
  [[nodiscard]] double lost(const std::vector<FittedSet>& shared) const {
    double nats = 0;
    double occam = 0;
    double chi = 0;
    double lines = 0;
    for (std::size_t r = 0; r < own_.size(); ++r) {
      nats += shared[r].nats() - own_[r]->nats();
      occam += shared[r].occam - own_[r]->occam;
      chi += own_[r]->fit.over(kSeen).chi;
      lines += own_[r]->lines();
    }
    return nats / std::max(1.0, chi / lines) + occam;
  }

  std::span<const RecordSets> records_;
  // One a record:
  std::vector<FittedSet*> own_;
  std::vector<Numbers> numbers_;
  std::vector<Eigen::MatrixXd> told_;
  Eigen::MatrixXd all_;        // their sum
  Eigen::VectorXd prior_sds_;  // of the sizes
};

}  // namespace

void share_sizes(std::span<const RecordSets> records, const EffectSet& set) {
  Sharing sharing(records, set);
  if (!sharing.has_sizes() || sharing.is_settled() || sharing.take()) return;
  sharing.by_one_alone();
  if (!sharing.take()) sharing.keep_apart();
}

}  // namespace steerid::gap
