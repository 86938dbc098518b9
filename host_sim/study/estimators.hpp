// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every way to J, B and C that a study compares, behind one call: a record in, three numbers and what the method says
// of their errors out.
//
//   batch               fit/gauss_newton.hpp over the whole record
//   recursive, float    firmware/app/task.hpp, the 100 Hz task that is flashed, fed with the port's integers; its
//   answer recursive, double   after the last sample the others          textbook_methods.hpp
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "log/record.hpp"

namespace steerid {

enum class Method {
  kBatch,
  kRecursiveFloat,
  kRecursiveDouble,
  kStateVariableFilter,
  kArx,
  kCentralDifferences,
};
[[nodiscard]] std::string_view name(Method method);

struct MethodAnswer {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< J, B, C in SI units
  std::optional<Eigen::Matrix3d> covariance;        ///< as the method states it; nothing when it states none
  unsigned restarts = 0;                            ///< recursive: how often it took the arm for another one
};

/// Nothing when the method finds no wheel in the record.
[[nodiscard]] std::optional<MethodAnswer> estimate(Method method, const Record& record);

}  // namespace steerid
