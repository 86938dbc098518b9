// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/textbook_methods.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

namespace steerid {
namespace {

constexpr std::size_t kFewest = 300;

double period_s(const Record& record) {
  return (record.time_s.back() - record.time_s.front()) / static_cast<double>(record.size() - 1);
}

/// Least squares of x'rows = target, with the covariance that white residuals would have.
template <int N>
struct LeastSquares {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  Matrix gram = Matrix::Zero();
  Vector moment = Vector::Zero();
  double power = 0;
  int rows = 0;

  void add(const Vector& row, double target) {
    gram += row * row.transpose();
    moment += row * target;
    power += target * target;
    ++rows;
  }
  [[nodiscard]] Vector solution() const { return scaled_inverse() * moment; }
  [[nodiscard]] Matrix covariance() const {
    const double residual_power = power - solution().dot(moment);
    return scaled_inverse() * (residual_power / (rows - N));
  }

 private:
  [[nodiscard]] Matrix scaled_inverse() const {  // columns differ by orders of magnitude: scaled to unit length first
    const Vector scale = gram.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix scaled = scale.asDiagonal() * gram * scale.asDiagonal();
    return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
  }
};

MethodAnswer answer_of(const LeastSquares<3>& equations) { return {equations.solution(), equations.covariance()}; }

/// x / (s + rate)^2 by Tustin's rule, with its first two derivatives.
class StateVariableFilter {
 public:
  StateVariableFilter(double rate, double period) : rate_(rate), half_(period / 2) {}

  /// (x'', x', x), filtered: the order of J, B, C.
  Eigen::Vector3d step(double x) {
    const double once = lag_[0].step(x, rate_, half_);
    const double twice = lag_[1].step(once, rate_, half_);
    const double first = once - rate_ * twice;
    return {x - 2 * rate_ * first - rate_ * rate_ * twice, first, twice};
  }

 private:
  struct Lag {  // 1/(s + rate)
    double y = 0;
    double x_before = 0;
    double step(double x, double rate, double half) {
      y = (y * (1 - rate * half) + half * (x + x_before)) / (1 + rate * half);
      x_before = x;
      return y;
    }
  };
  double rate_;
  double half_;
  Lag lag_[2];
};

}  // namespace

std::optional<MethodAnswer> central_differences(const Record& record) {
  if (record.size() < kFewest) return std::nullopt;
  const double period = period_s(record);
  const std::vector<double>& th = record.angle_rad;
  LeastSquares<3> equations;
  for (std::size_t i = 1; i + 1 < record.size(); ++i) {
    equations.add(
        {(th[i + 1] - 2 * th[i] + th[i - 1]) / (period * period), (th[i + 1] - th[i - 1]) / (2 * period), th[i]},
        record.net_torque_nm(i));
  }
  return answer_of(equations);
}

std::optional<MethodAnswer> state_variable_filter(const Record& record) {
  if (record.size() < kFewest) return std::nullopt;
  constexpr double kRate = 2 * std::numbers::pi * 5.0;
  constexpr std::size_t kSettled = 50;  // half a second: the filter's start has decayed by exp(-15)
  StateVariableFilter angle(kRate, period_s(record));
  StateVariableFilter torque(kRate, period_s(record));
  LeastSquares<3> equations;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const Eigen::Vector3d row = angle.step(record.angle_rad[i]);
    const double target = torque.step(record.net_torque_nm(i))(2);
    if (i >= kSettled) equations.add(row, target);
  }
  return answer_of(equations);
}

std::optional<MethodAnswer> arx(const Record& record) {
  if (record.size() < kFewest) return std::nullopt;
  using Complex = std::complex<double>;
  LeastSquares<5> equations;
  for (std::size_t i = 2; i < record.size(); ++i) {
    LeastSquares<5>::Vector row;
    row << -record.angle_rad[i - 1], -record.angle_rad[i - 2], record.net_torque_nm(i), record.net_torque_nm(i - 1),
        record.net_torque_nm(i - 2);
    equations.add(row, record.angle_rad[i]);
  }
  const LeastSquares<5>::Vector x = equations.solution();
  const Complex root = std::sqrt(Complex(x[0] * x[0] / 4 - x[1]));
  const Complex first = std::log(-x[0] / 2 + root) / period_s(record);
  const Complex second = std::log(-x[0] / 2 - root) / period_s(record);
  const double stiffness = (1 + x[0] + x[1]) / (x[2] + x[3] + x[4]);
  const double wheel = (first * second).real();     // C/J
  const double damping = -(first + second).real();  // B/J
  // A pole on the negative real axis has no continuous twin: its logarithm leaves an imaginary part behind.
  if (std::abs((first + second).imag()) > 1e-6 * std::abs(first + second) || !std::isfinite(stiffness / wheel)) {
    return std::nullopt;
  }
  const double inertia = stiffness / wheel;
  return MethodAnswer{{inertia, damping * inertia, stiffness}, std::nullopt};
}

}  // namespace steerid
