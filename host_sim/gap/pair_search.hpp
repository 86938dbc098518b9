// Two effects at once, where no single one explains the record.
//
// Two effects of like size leave each other's gap open, so that neither reaches the floor alone. Forward: the best
// single effect first, then every other one fitted jointly with it. Where that does not reach the floor, the second one
// found takes the first one's place and what goes with it is looked for again (the first may have stood in for both),
// in turns as long as much is gained; then the next best single effect has its turn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gap/attribution.hpp"
#include "gap/comparison.hpp"

namespace steerid {

struct CausePair {
  std::string first;
  std::string leading;                   ///< of the two, the one that explains more alone
  std::optional<Effect> first_effect;    ///< none: an unmeasured torque, whose numbers are the floor's
  SlowTorque slow = SlowTorque::kFloor;  ///< what the second one is fitted with
  Candidate second;                      ///< fitted jointly with the first
  Evidence evidence;                     ///< of both together
  double unknown = 1;                    ///< probability that they are not the cause
};

/// What is left above this excess is worth a name of its own.
inline constexpr double kWorthAName = 1.5;

/// Whether a further effect closes most of what is left above the floor. `excess` and `nats` are what is there without
/// it.
[[nodiscard]] bool gains_enough(double excess, double nats, const Evidence& by);

/// The same beside a defect of the record, from nearer the floor on. Its repair leaves what no effect explains: a free
/// run that closes most of the gap will do, too. `refit` is the wheel without an effect.
[[nodiscard]] bool gains_beside_defects(const Evidence& refit, const Evidence& by);

/// The pair that explains the record better than any single effect, or than `unknown`, if there is one. `alone` and
/// `singles` are the comparison of single effects, `input` and `probability` its attribution; the latter becomes the
/// pair's where the pair takes the place of what was most probable.
[[nodiscard]] std::optional<CausePair> pair_instead(const ComparisonSetting& alone, const Comparison& singles,
                                                    const AttributionInput& input, std::vector<double>& probability);

}  // namespace steerid
