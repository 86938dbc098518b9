// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/joint_scan.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "gap/sets/effect_set.hpp"
#include "gap/sets/projection.hpp"

namespace steerid::gap {
namespace {

/// What one starting value of a candidate changes.
struct Column {
  const Hypothesis* hypothesis = nullptr;
  const StartingPoint* point = nullptr;
  Eigen::VectorXd rows{};
  bool scales = false;     ///< its size is free
  bool one_sided = false;  ///< and no less than nothing
};

/// One regression: at most three columns.
struct Subset {
  std::array<std::size_t, 3> columns{};
  std::size_t size = 0;
  Eigen::Vector3d factors = Eigen::Vector3d::Zero();
  double nats = 0;
};

class AllSubsets {
 public:
  AllSubsets(std::vector<Column> columns, const Eigen::VectorXd& left, double lines)
      : columns_(std::move(columns)), left_nats_(left.squaredNorm()), lines_(lines) {
    const auto count = std::ssize(columns_);
    gram_.resize(count, count);
    along_.resize(count);
    go_together_.resize(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      along_[i] = at(i).rows.dot(left);
      for (Eigen::Index j = 0; j <= i; ++j) {
        gram_(i, j) = gram_(j, i) = at(i).rows.dot(at(j).rows);
        go_together_(i, j) = go_together_(j, i) =
            at(i).hypothesis != at(j).hypothesis &&
            goes_with(at(i).hypothesis->type(), {Effect(at(j).hypothesis->type())});
      }
    }
  }

  /// The best of `size`, the best first; of those that differ by kinds of a family one.
  [[nodiscard]] std::vector<Subset> best(std::size_t size, std::size_t count) const {
    std::vector<Subset> all;
    extend({}, 0, size, all);
    std::ranges::stable_sort(all, std::ranges::greater(), &Subset::nats);
    std::vector<Subset> out;
    std::set<Kinds> seen;
    for (auto one = all.begin(); one != all.end() && out.size() < count; ++one) {
      const Kinds of_one = kinds(*one);
      if (!each_counts(*one) || !seen.insert(of_one).second) continue;
      out.push_back(*one);
      // Of a family the one with the fewest numbers that explains as much: details are told by fits.
      const double least = one->nats - kLeast * dispersion(*one);
      for (auto other = one; other != all.end() && other->nats >= least; ++other) {
        if (numbers(*other) < numbers(out.back()) && kinds(*other) == of_one) out.back() = *other;
      }
    }
    return out;
  }

  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }

 private:
  using Kinds = std::set<std::pair<Hypothesis::Family, const Hypothesis*>>;

  [[nodiscard]] const Column& at(Eigen::Index i) const { return columns_[static_cast<std::size_t>(i)]; }

  void extend(const Subset& from, std::size_t first, std::size_t size, std::vector<Subset>& all) const {
    for (std::size_t i = first; i < columns_.size(); ++i) {
      if (!may_join(from, i)) continue;
      Subset next = from;
      next.columns[next.size++] = i;
      if (next.size < size) {
        extend(next, i + 1, size, all);
      } else if (regress(next)) {
        all.push_back(next);
      }
    }
  }

  [[nodiscard]] bool may_join(const Subset& from, std::size_t column) const {
    return std::all_of(from.columns.begin(), from.columns.begin() + static_cast<std::ptrdiff_t>(from.size),
                       [&](std::size_t there) {
                         return go_together_(static_cast<Eigen::Index>(there), static_cast<Eigen::Index>(column));
                       });
  }

  /// False where a factor has the wrong sign. What cannot be scaled counts as far as its factor is one.
  bool regress(Subset& one) const {
    constexpr double kRidge = 1e-6;
    Eigen::Matrix3d gram = Eigen::Matrix3d::Identity();
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < one.size; ++i) {
      const auto at_i = static_cast<Eigen::Index>(one.columns[i]);
      along[static_cast<Eigen::Index>(i)] = along_[at_i];
      for (std::size_t j = 0; j < one.size; ++j) {
        gram(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            gram_(at_i, static_cast<Eigen::Index>(one.columns[j])) * (i == j ? 1 + kRidge : 1);
      }
    }
    one.factors = gram.inverse() * along;
    double bent = 0;
    for (std::size_t i = 0; i < one.size; ++i) {
      const Column& column = columns_[one.columns[i]];
      const double factor = one.factors[static_cast<Eigen::Index>(i)];
      if ((!column.scales || column.one_sided) && !(factor > 0)) return false;
      if (!column.scales) bent += std::pow(std::log(factor), 2) / static_cast<double>(one.size);
    }
    one.nats = one.factors.dot(along) / (1 + bent);
    return true;
  }

  /// Nats that it leaves a line.
  [[nodiscard]] double dispersion(const Subset& one) const { return std::max(1.0, (left_nats_ - one.nats) / lines_); }

  [[nodiscard]] std::size_t numbers(const Subset& one) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < one.size; ++i) {
      sum += columns_[one.columns[i]].hypothesis->type().parameters.size();
    }
    return sum;
  }

  /// Whether every effect takes off enough beside the others.
  [[nodiscard]] bool each_counts(const Subset& one) const {
    for (std::size_t without = 0; without < one.size; ++without) {
      Subset rest;
      for (std::size_t i = 0; i < one.size; ++i) {
        if (i != without) rest.columns[rest.size++] = one.columns[i];
      }
      if (regress(rest) && one.nats - rest.nats < kLeast * dispersion(one)) return false;
    }
    return true;
  }

  /// The same for subsets that differ by kinds of a family.
  [[nodiscard]] Kinds kinds(const Subset& one) const {
    Kinds all;
    for (std::size_t i = 0; i < one.size; ++i) {
      const Hypothesis* hypothesis = columns_[one.columns[i]].hypothesis;
      const bool alone = hypothesis->family() == Hypothesis::Family::kNone;
      all.emplace(hypothesis->family(), alone ? hypothesis : nullptr);
    }
    return all;
  }

  std::vector<Column> columns_;
  double left_nats_;
  double lines_;
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> go_together_;  // two columns, in one simulation
  Eigen::MatrixXd gram_;
  Eigen::VectorXd along_;
};

/// A starting value with its size multiplied.
std::vector<double> resized(const Column& column, double factor) {
  std::vector<double> values = column.point->at.effects.back().values;
  if (!column.scales) return values;
  LinearScan::Gain gain{.nats = 0, .first = factor, .second = 0};
  if (const int phase = column.hypothesis->linear().phase; phase >= 0) {
    const double amplitude = factor * values[0];
    const double at = values[static_cast<std::size_t>(phase)];
    gain = {.nats = 0, .first = amplitude * std::cos(at), .second = amplitude * std::sin(at)};
  } else if (column.point->scaled == Hypothesis::kScalesRatio) {
    gain.first = factor * (values[1] - 1);
  }
  return scaled(*column.hypothesis, column.point->scaled, std::move(values), gain);
}

}  // namespace

std::vector<JointStart> joint_starts(const JointSetting& setting, const std::vector<JointCandidate>& candidates,
                                     std::size_t count) {
  const Whittle::Whitened& whitened = setting.origin.scan.whitened();
  const Spectrum& residual = setting.origin.scan.residual();
  const WheelArm& wheel = setting.origin.from.wheel;
  const double sd = setting.wheel_sd;
  const Projection projection(
      whitened, setting.origin.slopes,
      {sd * wheel.inertia_kgm2, sd * wheel.damping_nms_per_rad, sd * wheel.stiffness_nm_per_rad});
  std::vector<Column> columns;
  for (const JointCandidate& candidate : candidates) {
    Parts parts = setting.parts;
    parts.push_back(candidate.hypothesis);
    SpectralModel model(setting.record, parts, setting.offset);
    for (const StartingPoint& point : candidate.points) {
      Spectrum with;
      Response other;
      model.evaluate(point.at.numbers(), with, other);
      Eigen::VectorXd rows = projection.of(whitened, residual - with);
      if (!rows.allFinite() || rows.squaredNorm() < 1e-12) continue;
      const bool scales = point.scaled != Hypothesis::kScalesNothing;
      const bool one_sided =
          scales && candidate.hypothesis->linear().phase < 0 && candidate.hypothesis->type().parameters[0].low >= 0;
      columns.push_back({candidate.hypothesis, &point, std::move(rows), scales, one_sided});
    }
  }
  const AllSubsets subsets(std::move(columns), projection.of(whitened, residual), whitened.lines());
  std::vector<JointStart> starts;
  for (const std::size_t size : {std::size_t{2}, std::size_t{3}}) {
    for (const Subset& one : subsets.best(size, count)) {
      JointStart& start = starts.emplace_back();
      start.at = setting.origin.from;
      start.nats = one.nats;
      for (std::size_t i = 0; i < one.size; ++i) {
        const Column& column = subsets.columns()[one.columns[i]];
        std::vector<double> values = resized(column, one.factors[static_cast<Eigen::Index>(i)]);
        values = column.hypothesis->to_run(std::move(values), wheel);
        start.at = with_added(std::move(start.at), *column.hypothesis, std::move(values));
        start.added.push_back(column.hypothesis);
      }
    }
  }
  return starts;
}

}  // namespace steerid::gap
