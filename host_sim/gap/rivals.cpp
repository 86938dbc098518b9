#include "gap/rivals.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace steerid {
namespace {

/// A column a torque: its spectrum, before the response.
struct Family {
  std::string_view name;
  std::vector<Spectrum> torques;
};

double largest(const std::vector<double>& x) {
  double most = 1e-12;
  for (const double value : x) most = std::max(most, std::abs(value));
  return most;
}

/// Torques of the angle and the rate, both over their largest value.
Family surface(const SpectralRecord& record) {
  const MeasuredMotion& motion = record.motion;
  const double angle = largest(motion.angle_rad);
  const double rate = largest(motion.rate_rad_s);
  Family out{"surface", {}};
  std::vector<double> torque(motion.angle_rad.size());
  const auto add = [&](auto shape) {
    for (std::size_t i = 0; i < torque.size(); ++i) {
      torque[i] = shape(motion.angle_rad[i] / angle, motion.rate_rad_s[i] / rate);
    }
    out.torques.push_back(record.spectra.of(torque));
  };
  add([](double q, double) { return q * q; });
  add([](double q, double) { return q * q * q; });
  add([](double q, double) { return std::abs(q); });
  add([](double q, double) { return std::max(q - 0.5, 0.0); });
  add([](double q, double) { return std::min(q + 0.5, 0.0); });
  add([](double, double v) { return v * v; });
  add([](double, double v) { return v * std::abs(v); });
  add([](double, double v) { return std::tanh(v / 0.05); });
  add([](double q, double v) { return q * q * v; });
  add([](double q, double v) { return q * v; });
  return out;
}

/// J, B, C, dry friction and a torque that change through the record.
Family course(const SpectralRecord& record) {
  const MeasuredMotion& motion = record.motion;
  const double end = std::max(motion.time_s.back(), 1e-9);
  Family out{"course", {}};
  const double rate = largest(motion.rate_rad_s);
  std::vector<double> torque(motion.angle_rad.size());
  std::vector<double> friction(motion.angle_rad.size());
  for (std::size_t i = 0; i < friction.size(); ++i) friction[i] = std::tanh(motion.rate_rad_s[i] / (0.05 * rate));
  const auto add = [&](const std::vector<double>& of, auto shape) {
    for (std::size_t i = 0; i < torque.size(); ++i) {
      torque[i] = shape(2 * motion.time_s[i] / end - 1) * of[i];
    }
    out.torques.push_back(record.spectra.of(torque));
  };
  for (const auto* of : {&motion.angle_rad, &motion.rate_rad_s, &motion.acceleration_rad_s2}) {
    add(*of, [](double t) { return t; });
    add(*of, [](double t) { return 1.5 * t * t - 0.5; });
    add(*of, [](double t) { return t > 0 ? 1.0 : -1.0; });
  }
  add(friction, [](double t) { return t; });
  const std::vector<double> constant(torque.size(), 1.0);
  add(constant, [](double t) { return t; });
  add(constant, [](double t) { return 1.5 * t * t - 0.5; });
  return out;
}

/// (i w)^p on the predicted angle, over the size that it has at 2 Hz.
Family dynamics(const SpectralRecord& record, const Spectrum& predicted) {
  const Eigen::VectorXd& omega = record.spectra.omega();
  Family out{"dynamics", {}};
  for (const double power : {-0.5, 0.5, 1.5, 3.0, 4.0}) {
    Spectrum torque(omega.size());
    for (Eigen::Index k = 0; k < omega.size(); ++k) {
      const double w = omega[k] / (4 * std::numbers::pi);
      torque[k] = w > 0 ? std::pow(Complex(0, w), power) * predicted[k] : Complex(0);
    }
    out.torques.push_back(std::move(torque));
  }
  return out;
}

/// Another gain of the driver's torque sensor, and the time by which it is late (the motor's gain follows from J, B and
/// C being free). Only lines that stand far above the sensor's noise: the wheel was not driven with that, and a gain of
/// zero would explain it.
Family channel(const SpectralRecord& record, const NoiseFloor& floor) {
  constexpr double kAboveNoise = 25;  // power; of lines of noise one in e^25 is
  Spectrum driver = record.spectra.of(record.record.torque_driver_nm);
  Spectrum late(driver.size());
  for (Eigen::Index k = 0; k < driver.size(); ++k) {
    if (std::norm(driver[k]) < kAboveNoise * floor.torque_variance) driver[k] = 0;
    late[k] = Complex(0, record.spectra.omega()[k]) * driver[k];
  }
  return {"channel", {std::move(driver), std::move(late)}};
}

/// The whitened residual and the model's derivatives on the blocks of one role.
struct Side {
  Side(const Whittle& whittle, const Response& response, const NoiseFloor& floor, Block::Role role)
      : whitened(whittle.spectra(), response, floor, {role}) {}
  Whittle::Whitened whitened;
  Eigen::VectorXd rest;
  Eigen::MatrixXd own;
};

/// Columns orthonormal, those that the others hold already left out.
Eigen::MatrixXd orthonormal(Eigen::MatrixXd columns) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const double size = columns.col(i).norm();
    if (size > 0) columns.col(i) /= size;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(1e-5);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

}  // namespace

std::vector<Rival> rivals_beyond(const SpectralRecord& record, const Whittle& whittle, ResidualModel& model,
                                 ResidualModel& slopes, const Eigen::VectorXd& x, const NoiseFloor& floor,
                                 const std::vector<Fitted>& fitted) {
  Spectrum residual;
  Response response;
  slopes.evaluate(x, residual, response);
  const Spectrum before = residual;
  std::vector<Spectrum> derivatives;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!(fitted[i].scale > 0)) continue;
    Eigen::VectorXd moved = x;
    auto& value = moved[static_cast<Eigen::Index>(i)];
    const double h = difference_step(fitted[i], value);
    value += h;
    slopes.evaluate(moved, residual, response);
    derivatives.push_back((residual - before) / h);
  }
  model.evaluate(x, residual, response);
  const Spectrum predicted = record.angle - residual;
  std::array<Side, 2> sides = {Side(whittle, response, floor, Block::Role::kFit),
                               Side(whittle, response, floor, Block::Role::kChoose)};
  for (Side& side : sides) {
    side.rest = side.whitened(residual);
    side.own.resize(side.rest.size(), static_cast<Eigen::Index>(derivatives.size()));
    for (std::size_t i = 0; i < derivatives.size(); ++i) {
      side.own.col(static_cast<Eigen::Index>(i)) = side.whitened(derivatives[i]);
    }
  }
  const auto [fitted_side, chosen_side] = std::tie(sides[0], sides[1]);
  const Eigen::MatrixXd own = orthonormal(fitted_side.own);
  const double own_gain = (own.transpose() * fitted_side.rest).squaredNorm();
  const double left = fitted_side.rest.squaredNorm() - fitted_side.whitened.lines() + chosen_side.rest.squaredNorm() -
                      chosen_side.whitened.lines();
  std::vector<Rival> out;
  for (const Family& family : {surface(record), course(record), dynamics(record, predicted), channel(record, floor)}) {
    std::array<Eigen::MatrixXd, 2> columns;
    for (std::size_t s = 0; s < 2; ++s) {
      const Side& side = sides[s];
      const auto count = static_cast<Eigen::Index>(family.torques.size());
      columns[s].resize(side.rest.size(), side.own.cols() + count);
      columns[s].leftCols(side.own.cols()) = side.own;
      for (Eigen::Index i = 0; i < count; ++i) {
        columns[s].col(side.own.cols() + i) =
            side.whitened(response.gain.cwiseProduct(family.torques[static_cast<std::size_t>(i)]));
      }
    }
    for (Eigen::Index i = 0; i < columns[0].cols(); ++i) {  // of one size, so that a rank can be told
      const double size = std::max(columns[0].col(i).norm(), 1e-300);
      columns[0].col(i) /= size;
      columns[1].col(i) /= size;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-5);
    solver.compute(columns[0]);
    const Eigen::VectorXd by = solver.solve(fitted_side.rest);
    Rival rival{family.name};
    rival.fit_nats = fitted_side.rest.squaredNorm() - own_gain - (fitted_side.rest - columns[0] * by).squaredNorm();
    rival.choose_nats = chosen_side.rest.squaredNorm() - (chosen_side.rest - columns[1] * by).squaredNorm();
    rival.left = std::max(0.0, left);
    rival.free = static_cast<int>(solver.rank() - own.cols());
    out.push_back(rival);
  }
  return out;
}

}  // namespace steerid
