// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/estimators.hpp"

#include <cmath>
#include <stdexcept>

#include "app/task.hpp"
#include "fit/gauss_newton.hpp"
#include "study/textbook_methods.hpp"

namespace steerid {
namespace {

std::optional<MethodAnswer> batch(const Record& record) {
  FitOptions options;
  options.convergence_factor = false;
  const BatchFit fit = fit_batch(record, options);
  if (fit.stop == StopReason::kNoData) return std::nullopt;
  MethodAnswer answer;
  answer.value << fit.inertia.value, fit.damping.value, fit.stiffness.value;
  answer.covariance = fit.covariance.topLeftCorner<3, 3>();
  return answer;
}

template <class Scalar>
std::optional<MethodAnswer> recursive(const Record& record) {
  IdentificationTask<Scalar> task;
  for (std::size_t i = 0; i < record.size(); ++i) {
    Sample sample;
    sample.stamp_us = std::llround(record.time_s[i] * 1e6);
    sample.angle_urad = static_cast<std::int32_t>(std::lround(record.angle_rad[i] * 1e6));
    sample.torque_driver_mnm = static_cast<std::int32_t>(std::lround(record.torque_driver_nm[i] * 1e3));
    sample.torque_motor_mnm = static_cast<std::int32_t>(std::lround(record.torque_motor_nm[i] * 1e3));
    sample.sequence = static_cast<std::uint16_t>(i);
    task.take(sample);
  }
  const Identifier<Scalar>& identifier = task.identifier().steady();
  MethodAnswer answer;
  answer.value = identifier.value().template cast<double>();
  Eigen::Matrix3d covariance;
  for (int i = 0; i < 3; ++i) covariance.col(i) = identifier.covariance_column(i).template cast<double>();
  answer.covariance = covariance;
  answer.restarts = identifier.changes();
  return answer;
}

}  // namespace

std::string_view name(Method method) {
  switch (method) {
    case Method::kBatch:
      return "batch Gauss-Newton";
    case Method::kRecursiveFloat:
      return "recursive, float";
    case Method::kRecursiveDouble:
      return "recursive, double";
    case Method::kStateVariableFilter:
      return "state-variable filter";
    case Method::kArx:
      return "discrete ARX";
    case Method::kCentralDifferences:
      return "central differences";
  }
  throw std::logic_error("a method without a name");
}

std::optional<MethodAnswer> estimate(Method method, const Record& record) {
  switch (method) {
    case Method::kBatch:
      return batch(record);
    case Method::kRecursiveFloat:
      return recursive<float>(record);
    case Method::kRecursiveDouble:
      return recursive<double>(record);
    case Method::kStateVariableFilter:
      return state_variable_filter(record);
    case Method::kArx:
      return arx(record);
    case Method::kCentralDifferences:
      return central_differences(record);
  }
  throw std::logic_error("a method that nobody runs");
}

}  // namespace steerid
