// What `steerid identify` found in a record, whichever method found it, and what follows from it in closed form.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "port/estimate.hpp"

namespace steerid {

/// One identified parameter in the unit of its field's name; `sd` is one standard deviation, infinite when unknown.
struct IdentifiedParameter {
  double value = 0.0;
  double sd = std::numeric_limits<double>::infinity();
  ParameterState state = ParameterState::kStarting;
};

struct Identification {
  std::string method;  ///< "recursive" or "batch_gauss_newton"
  IdentifiedParameter inertia_kgm2;
  IdentifiedParameter damping_nms_per_rad;
  IdentifiedParameter stiffness_nm_per_rad;
  /// How much of the measured amplitude curve (up to 5 Hz) the model explains; nothing when the record has no curve.
  std::optional<double> amplitude_fit_percent;
  /// rms(angle - free-run angle) / std(angle) over the whole record; nothing when the free run diverges.
  std::optional<double> free_run_nrmse;
};

/// What the firmware published, in SI units. A number at the end of its range stands for "at least that": unknown.
IdentifiedParameter from_published(const ParameterEstimate& published);

/// Damped natural frequency (1/2pi) sqrt((1 - xi^2) C/J), or the reason why there is none.
struct NaturalFrequency {
  std::optional<double> hz;
  std::string reason;                   ///< a sentence, empty when `hz` holds a value
  std::optional<double> damping_ratio;  ///< xi = B / (2 sqrt(J C)); nothing unless J and C are known and positive
};

/// The natural frequency that the identified parameters imply. It has none when a parameter it needs was not
/// identified, when J or C is not positive, and when xi is 1 or more: an overdamped arm does not oscillate
/// (Lv et al. 2018, equation 5, holds below 1 only).
NaturalFrequency natural_frequency(const Identification& found);

/// True when the value comes from the record rather than from the prior.
constexpr bool is_identified(ParameterState state) {
  return state != ParameterState::kStarting && state != ParameterState::kNotExcited;
}

}  // namespace steerid
