// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The diagnosis of the sim-to-real gap: where a simulation and a measured wheel disagree, which effect of the
// vocabulary (plant/effects/vocabulary.hpp) causes it, and how far the gap shrinks once that effect is simulated.
//
// Besides the effects a verdict can be
//   none        the simulation explains the record down to its floor
//   parameters  it does so with other J, B, C
//   unknown     the gap is real and no effect of the vocabulary reaches the floor
//
// Every NRMSE is rms(measured - free run)/std(measured) of the angle on the held-out part of the record, which no fit
// and no choice has seen. closed_fraction = (refit - with_effect)/(refit - floor).
//
// Method, sources and measured limits: docs/gap_diagnosis.md.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gap/preparation/prediction_remainder.hpp"
#include "gap/sets/inclusion.hpp"
#include "log/record.hpp"
#include "plant/simulation.hpp"

namespace steerid::gap {

/// A value with its 95 % interval. Where the record does not say, the interval is infinite.
struct BoundedValue {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// One entry of the ranking. Every id of the vocabulary occurs once; the probabilities sum to one.
struct RankedEffect {
  std::string id;
  double probability = 0;
};

/// A change of the simulation that is named; those that close most come first.
struct Cause {
  Effect effect;                           ///< as the wheel has it; one that is removed as the simulation had it
  std::vector<BoundedValue> parameters{};  ///< one a parameter of the effect's type, in their order; none if removed
  double closes = 0;  ///< its share (shared_among.hpp) of (refit - floor), a tenth of the floor at least
  ChangeKind change = ChangeKind::kAdd;
  double probability = 0;  ///< that the wheel has it other than it was simulated
  /// `parameters` by this record alone, where the sizes are common to several of the wheel; else none.
  std::vector<BoundedValue> alone{};
  std::optional<Effect> was{};  ///< of one that the simulation had
  /// Its first parameter in every record of the wheel, by the record's name, where it is not the same in all.
  std::vector<std::pair<std::string, double>> elsewhere{};
};

/// What the record says for one set of changes (gap/sets/set_fit.hpp).
struct SetEvidence {
  struct Change {
    std::string effect;
    ChangeKind change = ChangeKind::kAdd;
  };
  std::vector<Change> changes;
  bool wheel_given = true;  ///< J, B and C are the simulation's
  double nats = 0;          ///< minus log likelihood of all that was seen
  double excess = 1;        ///< misfit over what the floor leaves
  double lines = 0;         ///< Fourier lines that were seen
  double left_nats = 0;     ///< that it leaves above the floor, and by chance
  double occam = 0;         ///< nats that its free numbers cost
  double log_odds = 0;      ///< against the likeliest set
};

/// What is left of the gap with all that is named.
struct Unexplained {
  double share_of_gap = 0;  ///< of (refit - floor), a tenth of the floor at least; 0 where nothing is
  bool complete = false;    ///< it is at the floor
  /// The band of frequency that holds most of it.
  struct Band {
    double low_hz = 0;
    double high_hz = 0;
    double share = 0;  ///< of the power of the angle that is left above the noise
  };
  std::optional<Band> where{};  ///< none where it is complete, or no figures were made
};

/// One bin of an axis along which the gap is laid out.
struct GapBin {
  double low = 0;
  double high = 0;
  BoundedValue share{};       ///< of the excess residual's power, with its block-bootstrap interval
  double expected_share = 0;  ///< of the noise's power: what the bin would hold if there were no gap
};

/// The gap laid out along one axis. Shares sum to one.
struct GapAxis {
  std::string axis{};  ///< "velocity", "position", "time", "frequency", "amplitude", "channel", and "reversal"
  std::string unit{};  ///< of the bins' edges: "rad/s", "rad", "s", "Hz", "rad", "" and "s"
  std::vector<GapBin> bins{};
  std::vector<std::string> bin_names{};  ///< of the channel axis only, one a bin
  double concentration = 0;              ///< 0 spread like the noise .. 1 all in the smallest part of the axis
};

/// Where the gap is: the range of the axis that concentrates it most.
struct GapPlace {
  std::string axis;
  double low = 0;
  double high = 0;
  std::string unit;
  BoundedValue share_of_gap;
  std::string says;  ///< one sentence
};

/// The restoring-force surface: the residual torque over the angle-velocity plane. Row-major, a row a rate bin.
struct AngleVelocityMap {
  std::vector<double> angle_edges_rad;       ///< columns + 1
  std::vector<double> rate_edges_rad_s;      ///< rows + 1
  std::vector<double> mean_torque_nm;        ///< mean residual torque of the refit; NaN where nothing was measured
  std::vector<double> mean_torque_after_nm;  ///< the same with the effect
};

/// Power density of the residual angle, before and after, beside what the noise alone would leave.
struct ResidualSpectrum {
  std::vector<double> frequency_hz;
  std::vector<double> measured_rad2_per_hz;  ///< of the measured angle itself
  std::vector<double> refit_rad2_per_hz;
  std::vector<double> with_effect_rad2_per_hz;
  std::vector<double> noise_rad2_per_hz;
};

/// For plots. Columns of equal length; an angle that was not simulated (in a gap) is NaN.
struct GapSeries {
  std::vector<double> time_s;
  std::vector<double> measured_rad;
  std::vector<double> sim_rad;                   ///< free run of the simulation as it was given
  std::vector<double> refit_rad;                 ///< with J, B, C refitted
  std::vector<double> with_effect_rad;           ///< with the causes added
  std::vector<char> held_out;                    ///< 1 where the sample belongs to the held-out part
  std::vector<double> torque_residual_nm;        ///< T - (J th'' + B th' + C th) of the refit, low-passed
  std::vector<double> torque_residual_after_nm;  ///< the same with the causes
};

struct GapSizes {
  double sim_nrmse = 0;
  double refit_nrmse = 0;
  double with_effect_nrmse = 0;
  double floor_nrmse = 0;
  BoundedValue closed_fraction;  ///< NaN where the refit may be within a tenth of the floor: no gap is shown
  // The same in torque: rms of the torque residual, low-passed, over the rms of the applied torque, held-out part.
  double torque_refit = 0;
  double torque_with_effect = 0;
  double torque_floor = 0;
};

struct BaseWheel {
  BoundedValue inertia_kgm2;
  BoundedValue damping_nms_per_rad;
  BoundedValue stiffness_nm_per_rad;
};

/// A bounded multisine for the EPS motor, as the `probe` of `steerid simulate` plays it.
struct ProbeProposal {
  double rms_nm = 1.5;
  double low_hz = 0.2;
  double high_hz = 5.0;
  double period_s = 10.0;
  double duration_s = 60.0;
};

struct NextExperiment {
  std::string why{};  ///< one sentence: what the probe tells apart, or why there is none
  ProbeProposal probe{};
  std::array<std::string, 2> separates{};  ///< the two it tells apart best: ids, or both and one of two effects
  double separation = 0;                   ///< expected log-likelihood between them, nats
};

struct Diagnosis {
  std::string verdict;
  std::vector<RankedEffect> ranking;       ///< most probable first
  std::vector<SetEvidence> evidence;       ///< what the ranking was made from: every set that was fitted
  std::vector<ChangeInclusion> inclusion;  ///< every change that was tried, named or not, the likeliest first
  Unexplained unexplained;
  std::vector<Cause> causes;   ///< empty for none and parameters; for unknown the nearest surrogate
                               ///< if any
  bool surrogate = false;      ///< the causes are a surrogate of something unknown, not the cause
  std::string not_credible{};  ///< why nothing is named, as DiagnoseOptions has it
  /// Said to be unknown because the surrogate needs J, B and C further from the simulation's than simulations are off.
  bool base_out_of_place = false;
  /// With the causes the wheel does not hold itself: only a loop holds it, and no free run says what they close.
  bool only_the_loop_holds = false;
  std::vector<std::string> equivalent;
  GapPlace where;
  std::vector<GapAxis> axes;  ///< all of them, the most concentrated first
  GapSizes gap;
  BaseWheel base;
  NextExperiment next_experiment;
  std::vector<std::string> notes;  ///< whole sentences for the user: what was left out, what is not excited

  Simulation with_effect;  ///< reproduces with_effect_nrmse through `steerid simulate --replay`, but for a remainder
  Simulation refit;
  GapSeries series;
  ResidualSpectrum spectrum;
  AngleVelocityMap map;
};

/// Whether more than one change is named.
[[nodiscard]] bool names_several(const Diagnosis& diagnosis);

/// Of the answer: of the change that is least sure among those that are named, each of which has a probability of its
/// own; where none is, of the verdict. The ranking shares one among all ids, so that three sure changes have a third
/// each there. NaN where it is unknown.
[[nodiscard]] double probability_of_answer(const Diagnosis& diagnosis);

struct DiagnoseOptions {
  std::uint64_t seed = 1;              ///< of the bootstrap
  unsigned threads = 0;                ///< 0: one a core
  std::vector<std::string> without{};  ///< effects taken out of the library, for leave-one-out studies
  std::optional<double> origin_s{};    ///< the stamp that effects take as time zero; the record's first unless given
  PredictionRemainder remainder{};     ///< where the simulation stands for one that is known by its prediction alone
  bool figures = true;                 ///< fill axes, series, spectrum and map; off saves time in studies
  int bootstrap_draws = 400;
  /// Why no answer to the record would be credible, in words; empty: one may be. Nothing is named then, and no probe
  /// proposed.
  std::string not_credible{};
  /// Asked, on the calling thread, before every part of the work that an answer can do without: true ends the search,
  /// the answer is what is known by then, and a note says what was left out.
  std::function<bool()> out_of_time = [] { return false; };
  /// Told, on the calling thread, which part of the work is done, from 0 to 1.
  std::function<void(double)> at_part = [](double) {};
};

/// Diagnoses the record against the simulation. Throws BadInput, one sentence, when the record cannot tell anything:
/// too short, a channel dead, no excitation.
[[nodiscard]] Diagnosis diagnose(const Record& record, const Simulation& simulation,
                                 const DiagnoseOptions& options = {});

}  // namespace steerid::gap
