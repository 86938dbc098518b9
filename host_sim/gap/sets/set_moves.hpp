// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a search over sets of changes tries from one set on.
//
// Revisions: an effect of the simulation resized or removed, or as it is given again; a change taken back; an effect
// exchanged for another of its family. Additions: one effect, the most promising by score tests (what is left,
// projected on what a candidate would move, what the free numbers can do projected out of both;
// gap/sets/spectral_search.hpp), or two and three together (gap/sets/joint_scan.hpp). What promises less than a new
// number costs is not tried.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gap/sets/set_fit.hpp"
#include "gap/sets/spectral_search.hpp"

namespace steerid::gap {

/// A set to fit, and where from.
struct Move {
  EffectSet set;
  Eigen::VectorXd x;
  std::shared_ptr<const SlowCourse> course;
};

/// The simulation's effects to begin from: with bristles, as friction that is given as ideal leads to none.
[[nodiscard]] std::vector<Effect> given_to_begin(const SetSetting& setting);

class SetMoves {
 public:
  /// The fitter has to live as long.
  explicit SetMoves(const SetFitter& fitter) : fitter_(fitter), setting_(fitter.setting()) {}

  [[nodiscard]] std::vector<Move> revisions(const FittedSet& from) const;

  /// Every effect that was added exchanged for the others of its family.
  [[nodiscard]] std::vector<Move> exchanges(const FittedSet& from) const;

  struct Additions {
    std::vector<Move> single{};
    std::vector<Move> joint{};  ///< two and three at once
  };
  /// `given_wheel`: the same set with the simulation's J, B and C. `dispersion`: what nats are divided by.
  [[nodiscard]] Additions additions(const FittedSet& base, const FittedSet& given_wheel, double dispersion) const;

 private:
  /// What additions of one base share.
  struct Base;
  struct Candidate;

  [[nodiscard]] Move as_given_again(const FittedSet& from, const EffectType& type) const;
  void exchange(const SetPart& part, const FittedSet& from, const EffectSet& rest, const Eigen::VectorXd& x,
                std::vector<Move>& moves) const;
  void add_relatives(const Hypothesis& of, const Effect& added, const EffectSet& rest, const Eigen::VectorXd& x,
                     const std::shared_ptr<const SlowCourse>& course, std::vector<Move>& moves) const;
  [[nodiscard]] bool may_add(const EffectType& type, const FittedSet& base) const;
  [[nodiscard]] std::vector<Move> single(const Base& base, double dispersion) const;
  [[nodiscard]] std::vector<Move> joint(const Base& base) const;

  const SetFitter& fitter_;
  const SetSetting& setting_;
};

}  // namespace steerid::gap
