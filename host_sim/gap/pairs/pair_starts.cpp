// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/pairs/pair_starts.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "gap/comparison/dry_friction_forms.hpp"
#include "gap/comparison/spectral_search.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

constexpr Eigen::Index kWheel = 3;  // J, B and C have the first columns

/// An effect of a given shape: the columns of its torque, two where its phase is free, none where it is on a channel.
struct Shape {
  const Hypothesis* hypothesis = nullptr;
  int scaled_by = -1;  ///< as in its Starts
  std::vector<double> values;
  Eigen::Index first = 0;
  Eigen::Index columns = 0;
  std::size_t torque = 0;  ///< of the applied torques, the one that its channel makes of the record's
};

/// Whether it is neither a torque of the motion nor one of the channels': a grip.
bool unseen_by_balance(const Hypothesis& hypothesis) {
  const EffectType* type = &hypothesis.type();
  return !hypothesis.tried_as_torque() && type != &effect::delay && type != &effect::lag;
}

/// The applied torque as a delay or a lag of the angle lets it be seen.
std::vector<double> late_by(const std::vector<double>& torque_nm, double samples) {
  std::vector<double> out(torque_nm.size());
  const double last = static_cast<double>(torque_nm.size()) - 1;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double at = std::clamp(static_cast<double>(i) - samples, 0.0, last);
    const auto low = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(low);
    out[i] = (1 - part) * torque_nm[low] + part * torque_nm[std::min(low + 1, out.size() - 1)];
  }
  return out;
}

std::vector<double> lagged(const std::vector<double>& torque_nm, double samples) {
  std::vector<double> out(torque_nm.size());
  const double keeps = std::exp(-1 / samples);
  double state = torque_nm.front();
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = state = keeps * state + (1 - keeps) * torque_nm[i];
  return out;
}

/// The balance of one set of samples, as products of its columns.
struct Products {
  Eigen::MatrixXd columns;  ///< of each other, the prior's included
  Eigen::MatrixXd torque;   ///< of columns and applied torques; one of these a column
  Eigen::VectorXd square;   ///< of each applied torque
  double samples = 0;
};

class TorqueBalance {
 public:
  TorqueBalance(const SpectralRecord& record, const WheelArm& sim,
                const std::function<bool(const EffectType&)>& may_stand)
      : record_(record), sim_(sim) {
    choose_samples();
    torques_.push_back(record.net_torque_nm);
    const MeasuredMotion& motion = record.motion;
    for (const auto* of : {&motion.acceleration_rad_s2, &motion.rate_rad_s, &motion.angle_rad}) add_column(*of, 1);
    for (const auto& hypothesis : hypotheses()) {
      if (may_stand(hypothesis->type())) add(*hypothesis);
    }
    all_ = products_of([](std::size_t) { return true; });
    const double slides = kSlides * rms(motion.rate_rad_s);
    sliding_ = products_of([&](std::size_t i) { return std::abs(motion.rate_rad_s[i]) > slides; });
  }

  [[nodiscard]] const std::vector<Shape>& shapes() const { return shapes_; }

  /// The two at once, where that is possible.
  [[nodiscard]] std::optional<PairStart> of(const Shape& one, const Shape& other) const {
    if (one.torque > 0 && other.torque > 0) return std::nullopt;
    const std::size_t torque = std::max(one.torque, other.torque);
    const bool sticks = dry_friction(one.hypothesis->type().id) || dry_friction(other.hypothesis->type().id);
    const Products& from = sticks ? sliding_ : all_;
    std::vector<Eigen::Index> chosen = {0, 1, 2};
    for (const Shape* shape : {&one, &other}) {
      for (Eigen::Index k = 0; k < shape->columns; ++k) chosen.push_back(shape->first + k);
    }
    const Eigen::MatrixXd normal = from.columns(chosen, chosen);
    const Eigen::VectorXd right = from.torque(chosen, static_cast<Eigen::Index>(torque));
    const Eigen::VectorXd solved = normal.ldlt().solve(right);
    if (!solved.allFinite() || !(solved.head(kWheel).minCoeff() > 0)) return std::nullopt;
    PairStart start{.first = one.hypothesis, .second = other.hypothesis, .x = solved.head(kWheel)};
    Eigen::Index at = kWheel;
    for (const Shape* shape : {&one, &other}) {
      const std::optional<std::vector<double>> values = sized(*shape, solved.segment(at, shape->columns));
      if (!values) return std::nullopt;
      start.x = point_at(start.x, *values);
      at += shape->columns;
    }
    start.left = (from.square[static_cast<Eigen::Index>(torque)] - solved.dot(right)) / left_by_wheel(from);
    return start;
  }

 private:
  static constexpr double kSlides = 0.15;   // of the rate's rms
  static constexpr double kOff = 0.08;      // by how much a simulation's J, B and C are wrong
  static constexpr std::size_t kEvery = 3;  // samples: what moves below 12 Hz changes little in between

  /// What J, B and C alone leave of the same samples.
  [[nodiscard]] static double left_by_wheel(const Products& of) {
    const Eigen::VectorXd right = of.torque.col(0).head(kWheel);
    const Eigen::VectorXd solved = of.columns.topLeftCorner(kWheel, kWheel).ldlt().solve(right);
    return std::max(of.square[0] - solved.dot(right), 1e-300);
  }

  [[nodiscard]] double rms(const std::vector<double>& x) const {
    double sum = 0;
    for (const std::size_t i : samples_) sum += x[i] * x[i];
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(samples_.size(), 1)));
  }

  void choose_samples() {
    for (const BlockSpectra::Bins& bins : record_.spectra.blocks()) {
      if (!is_among(kSeen, bins.block.role)) continue;
      for (std::size_t i = 0; i < bins.block.count; i += kEvery) samples_.push_back(bins.block.first + i);
    }
  }

  void add_column(const std::vector<double>& values, double factor) {
    Eigen::VectorXd& column = columns_.emplace_back(static_cast<Eigen::Index>(samples_.size()));
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      column[static_cast<Eigen::Index>(i)] = factor * values[samples_[i]];
    }
  }

  void add(const Hypothesis& hypothesis) {
    const Hypothesis::Starts starts = hypothesis.starts(sim_, record_.record, record_.motion);
    if (starts.by_line) return;
    if (unseen_by_balance(hypothesis)) return add_unseen(hypothesis, starts);
    if (!hypothesis.tried_as_torque()) return add_channel(hypothesis);
    std::vector<double> torque_nm(record_.record.size());
    for (const std::vector<double>& values : starts.values) {
      Shape shape{&hypothesis, starts.scaled, values, std::ssize(columns_), 1, 0};
      const auto add_torque = [&](const std::vector<double>& of) {
        hypothesis.torque(sim_, of.data(), record_.record, record_.motion, torque_nm);
        add_column(torque_nm, -1);
      };
      add_torque(values);
      if (const int phase = hypothesis.linear().phase; phase >= 0) {
        std::vector<double> quarter = values;
        quarter[static_cast<std::size_t>(phase)] += std::numbers::pi / 2;
        add_torque(quarter);
        shape.columns = 2;
      }
      shapes_.push_back(std::move(shape));
    }
  }

  /// No torque of the rigid wheel's: what goes with it is known as if it were not there.
  void add_unseen(const Hypothesis& hypothesis, const Hypothesis::Starts& starts) {
    for (const std::vector<double>& values : starts.values) {
      shapes_.push_back({&hypothesis, starts.scaled, values, std::ssize(columns_), 0, 0});
    }
  }

  void add_channel(const Hypothesis& hypothesis) {
    constexpr std::array<double, 9> kLate_s = {-0.06, -0.04, -0.02, -0.01, 0.01, 0.02, 0.04, 0.06, 0.08};
    constexpr std::array<double, 4> kLag_s = {0.01, 0.02, 0.04, 0.07};
    const bool delays = &hypothesis.type() == &effect::delay;
    const auto try_one = [&](double seconds) {
      const double samples = seconds * record_.rate_hz;
      torques_.push_back(delays ? late_by(torques_.front(), samples) : lagged(torques_.front(), samples));
      shapes_.push_back({&hypothesis, -1, {seconds}, std::ssize(columns_), 0, torques_.size() - 1});
    };
    if (delays) {
      std::ranges::for_each(kLate_s, try_one);
    } else {
      std::ranges::for_each(kLag_s, try_one);
    }
  }

  [[nodiscard]] Products products_of(const auto& taken) const {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (taken(samples_[i])) rows.push_back(static_cast<Eigen::Index>(i));
    }
    Eigen::MatrixXd chosen(std::ssize(rows), std::ssize(columns_));
    for (Eigen::Index k = 0; k < chosen.cols(); ++k) chosen.col(k) = columns_[static_cast<std::size_t>(k)](rows);
    Products out;
    out.samples = static_cast<double>(rows.size());
    out.columns = Eigen::MatrixXd::Zero(chosen.cols(), chosen.cols());
    out.columns.selfadjointView<Eigen::Lower>().rankUpdate(chosen.transpose());
    out.columns.triangularView<Eigen::StrictlyUpper>() = out.columns.transpose();
    out.torque.resize(chosen.cols(), std::ssize(torques_));
    out.square.resize(std::ssize(torques_));
    for (Eigen::Index t = 0; t < out.torque.cols(); ++t) {
      Eigen::VectorXd applied(chosen.rows());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        applied[static_cast<Eigen::Index>(i)] =
            torques_[static_cast<std::size_t>(t)][samples_[static_cast<std::size_t>(rows[i])]];
      }
      out.torque.col(t) = chosen.transpose() * applied;
      out.square[t] = applied.squaredNorm();
    }
    add_prior(out);
    return out;
  }

  /// As if the balance were off by a tenth of the applied torque, and that for good: a few samples' worth of it is all
  /// that such an error lets a record say of J, B and C.
  void add_prior(Products& of) const {
    constexpr double kOffShare = 0.1;
    constexpr double kWorth = 20;  // samples
    const double noise = kOffShare * kOffShare * of.square[0] / kWorth;
    const std::array<double, 3> given = {sim_.inertia_kgm2, sim_.damping_nms_per_rad, sim_.stiffness_nm_per_rad};
    for (Eigen::Index k = 0; k < kWheel; ++k) {
      const double value = given[static_cast<std::size_t>(k)];
      if (!(value > 0)) continue;
      const double weight = noise / std::pow(kOff * value, 2);
      of.columns(k, k) += weight;
      of.torque.row(k).array() += weight * value;
      of.square.array() += weight * value * value;
    }
  }

  /// The shape's values with its size put in; nothing where it would have to be of the other sign.
  [[nodiscard]] std::optional<std::vector<double>> sized(const Shape& shape, const Eigen::VectorXd& by) const {
    if (shape.columns == 0) return shape.values;
    constexpr double kUnchanged = 2;
    const double size = by[0];
    if (shape.scaled_by == -1) {  // nothing to scale: as far as the factor wanted is one
      return size > 1 / kUnchanged && size < kUnchanged ? std::optional(shape.values) : std::nullopt;
    }
    const bool one_sided =
        shape.scaled_by >= 0 && shape.columns == 1 && shape.hypothesis->type().parameters[0].low >= 0;
    if (one_sided && !(size > 0)) return std::nullopt;
    return scaled(*shape.hypothesis, shape.scaled_by, shape.values, {0, size, shape.columns > 1 ? by[1] : 0});
  }

  const SpectralRecord& record_;
  WheelArm sim_;
  std::vector<std::size_t> samples_;
  std::vector<Eigen::VectorXd> columns_;
  std::vector<std::vector<double>> torques_;
  std::vector<Shape> shapes_;
  Products all_;
  Products sliding_;
};

}  // namespace

std::vector<PairStart> pair_starts(const SpectralRecord& record, const WheelArm& sim, std::size_t most,
                                   const EffectType& leading, const std::function<bool(const EffectType&)>& may_stand,
                                   const std::function<bool(const EffectType&, const EffectType&)>& together) {
  const TorqueBalance balance(record, sim, may_stand);
  std::map<std::pair<const Hypothesis*, const Hypothesis*>, PairStart> best;
  const std::vector<Shape>& shapes = balance.shapes();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t k = i + 1; k < shapes.size(); ++k) {
      const Hypothesis* one = shapes[i].hypothesis;
      const Hypothesis* other = shapes[k].hypothesis;
      if (one == other || !together(one->type(), other->type())) continue;
      std::optional<PairStart> start = balance.of(shapes[i], shapes[k]);
      if (!start) continue;
      const auto [place, fresh] = best.try_emplace({one, other}, *start);
      if (!fresh && start->left < place->second.left) place->second = std::move(*start);
    }
  }
  std::vector<PairStart> out;
  for (auto& [effects, start] : best) out.push_back(std::move(start));
  std::ranges::sort(out, {}, &PairStart::left);
  // What the balance does not see gains nothing in it: the best that goes with `leading` is offered beyond the others.
  const auto unseen = [&](const PairStart& start) {
    const auto both = [&](const Hypothesis& one, const Hypothesis& other) {
      return unseen_by_balance(one) && &other.type() == &leading;
    };
    return both(*start.first, *start.second) || both(*start.second, *start.first);
  };
  std::size_t kept = std::min(most, out.size());
  const auto best_unseen = std::ranges::find_if(out, unseen);
  const auto place = static_cast<std::size_t>(best_unseen - out.begin());
  if (place >= kept && place < out.size()) std::swap(out[kept++], *best_unseen);
  out.resize(kept);
  return out;
}

}  // namespace steerid
