// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One record on its way from the question "what is it?" to "what does the simulation become?".
//
//   search    which set of changes explains the record (set_answer.hpp)
//   build     the simulation with them (diagnosing.cpp)
//   measure   how far the gap shrinks on the held-out part, and what each cause closes (diagnosing_measure.cpp)
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gap/diagnosis/clock_error.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/final_fit.hpp"
#include "gap/diagnosis/set_answer.hpp"
#include "gap/model/slow_torque.hpp"
#include "gap/preparation/prepared_record.hpp"

namespace steerid::gap {

class Diagnosing {
 public:
  /// `simulation` and `options` have to live as long. The part that reports is the turn-th. `clock`: the angle's.
  Diagnosing(const Record& log, const Simulation& simulation, const DiagnoseOptions& options, std::size_t turn,
             const AngleClock& clock = {});

  [[nodiscard]] Diagnosis answer();

  /// What is left of a drift between the clocks of angle and torques, or of a delay: beside the answer, or before there
  /// is one beside the simulation with other J, B and C.
  [[nodiscard]] std::optional<ClockError> clock_error(ClockError::Course course) const;
  [[nodiscard]] double message_told_to_s() const { return prepared_.message_told_to_s; }

  /// One of several records of a wheel: the search alone; what it finds is joined with that of the others.
  SetAnswer& searched_together();

  /// Names what the search found and measures it, until nothing is refused any more.
  void measure();

  /// The changes without which this record's held-out part is simulated no worse.
  [[nodiscard]] std::vector<const EffectType*> idle_changes() const;

  /// The answer, once everything is measured.
  Diagnosis finished();

  /// Whether the part that reports holds something that the rest does not show, such as a hand that leaves once or a
  /// ramp of which only the ends were seen: what was seen is explained down to the noise level, and the held-out part
  /// is far from it, or what was seen leaves open whether the answer closes anything there.
  [[nodiscard]] bool reports_something_new(const Diagnosis& answer) const;

 private:
  // ---- search ----
  /// Takes what the sets say, less what was refused.
  void name_changes();

  // ---- build ----
  void build_simulations();
  /// The floor and J, B and C that follow from the last fit.
  void rest_on_last_fit();
  /// A surrogate's J, B and C are no better known than those that the simulation had: nothing that explains the record
  /// speaks for moving them.
  void allow_for_given();
  /// The time course of an unmeasured torque, where that is the cause.
  void add_slow_torque();

  // ---- finish ----
  /// Where sizes are common to several records of the wheel.
  void say_what_this_record_alone_tells();

  // ---- measure ----
  /// At the end: what was taken off the measured angle belongs to it and to what every simulation shows.
  void put_remainder_back();
  void run_simulations();
  void size_gap();
  /// A change without which the held-out part is simulated no worse, or a surrogate: by what the runs say, before the
  /// gap is sized, which costs many runs. True if something was refused.
  bool refuse_by_runs();
  /// J, B and C where nothing else is changed, or a surrogate: by the sizes of the gap. True if something was refused.
  bool refuse_by_sizes();
  /// It is not shown to bring the free run nearer.
  void refuse_surrogate();
  /// Whether a run is nearer to the held-out part than another one, by more than noise hides.
  [[nodiscard]] bool is_nearer(const std::vector<double>& run_rad, const std::vector<double>& than_rad) const;
  /// Whether the answer is nearer to the held-out part than other J, B and C alone.
  [[nodiscard]] bool closes_by_more_than_chance() const;
  /// The changes with what each closes, the largest share first.
  void describe_changes();
  /// In the order of `named_`, of the held-out NRMSE (gap/diagnosis/shared_among.hpp).
  [[nodiscard]] std::vector<double> closed_by_each() const;
  [[nodiscard]] double held_out_nrmse(const std::vector<double>& angle) const;

  const DiagnoseOptions& options_;
  const Simulation& simulation_;
  PreparedRecord prepared_;
  Diagnosis out_;
  SetAnswer by_sets_;
  bool together_ = false;           ///< with other records of the wheel
  std::vector<Cause> named_;        ///< what each closes is not known yet
  bool surrogate_refused_ = false;  ///< it brings no free run nearer
  FinalFit last_;
  SlowTorque slow_ = SlowTorque::kFloor;
  NoiseFloor floor_;
};

}  // namespace steerid::gap
