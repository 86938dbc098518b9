// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/probe_misfit.hpp"

#include <cmath>

namespace steerid {

std::optional<ProbeMisfit> probe_misfit(const InstrumentalFit& fit) {
  constexpr double kLeft = InstrumentedRows::kFunctions - 3;  // combinations that J, B and C do not fit
  const auto driven = driven_part(fit, {fit.inertia.value, fit.damping.value, fit.stiffness.value});
  if (!driven || !(fit.noise_nm > 0)) return std::nullopt;
  const double left_nm = driven->nrmse * std::sqrt(fit.driven(0, 0));
  const double over_noise = left_nm * left_nm / (fit.noise_nm * fit.noise_nm);
  return ProbeMisfit{.nats = 0.5 * (over_noise - kLeft * std::log(static_cast<double>(fit.rows))),
                     .share = driven->nrmse,
                     .share_by_noise = driven->by_noise};
}

}  // namespace steerid
