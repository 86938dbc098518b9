// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What may be missing beside a set: one effect, the most promising by score tests (what is left, projected on what a
// candidate would move, what the free numbers can do projected out of both; gap/sets/spectral_search.hpp), or two and
// three together (gap/sets/joint_scan.hpp). What promises less than a new number costs is not tried.
//
// Candidates are looked for around the set as it was fitted and around the simulation's J, B and C: those that were
// fitted may make up for what is missing, and be far from where it is found.
#pragma once

#include <vector>

#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/sets/set_fit.hpp"
#include "gap/sets/set_moves.hpp"
#include "gap/sets/spectral_search.hpp"

namespace steerid::gap {

class Additions {
 public:
  /// To `from`. `near` is the same set with the simulation's J, B and C, to look from there as well; null: from `from`
  /// alone. The fitter has to live as long.
  Additions(const FittedSet& from, const FittedSet* near, const SetFitter& fitter);

  /// `dispersion`: what nats are divided by.
  [[nodiscard]] std::vector<Move> single(double dispersion) const;
  /// Two and three at once.
  [[nodiscard]] std::vector<Move> joint() const;

 private:
  struct Candidate {
    const Hypothesis* hypothesis = nullptr;
    std::vector<std::vector<StartingPoint>> points{};  ///< around each origin
  };

  [[nodiscard]] bool may_add(const EffectType& type) const;
  /// `least`: nats without which an effect is not tried.
  [[nodiscard]] bool promises_most(const Candidate& candidate, double least) const;

  const SetSetting& setting_;
  FittedSet from_;
  Parts parts_;
  SimulatedModel run_;
  SpectralRecord record_;  ///< on the motion of the set's run
  Spectrum offset_;
  std::vector<Fitted> fitted_;
  std::vector<SearchOrigin> origins_;  ///< the set's, then that with the simulation's J, B and C
  std::vector<Candidate> candidates_;
};

}  // namespace steerid::gap
