// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/probe_misfit.hpp"

#include <cmath>

namespace steerid {

std::optional<ProbeMisfit> probe_misfit(const InstrumentalFit& fit) {
  constexpr double kLeft = InstrumentedRows::kFunctions - 3;  // combinations that J, B and C do not fit
  const auto driven = driven_part(fit, {fit.inertia.value, fit.damping.value, fit.stiffness.value});
  if (!driven || !(fit.noise_nm > 0)) return std::nullopt;
  const double price = std::log(static_cast<double>(fit.rows));  // of a number, twice
  const double driven_over_noise = fit.driven(0, 0) / (fit.noise_nm * fit.noise_nm);
  const double left_over_noise = driven->nrmse * driven->nrmse * driven_over_noise;
  return ProbeMisfit{.driven_nats = 0.5 * (driven_over_noise - InstrumentedRows::kFunctions * price),
                     .nats = 0.5 * (left_over_noise - kLeft * price),
                     .share = driven->nrmse,
                     .share_by_noise = driven->by_noise};
}

bool drives(const std::optional<ProbeMisfit>& probe) { return probe && probe->driven_nats > 0; }

}  // namespace steerid
