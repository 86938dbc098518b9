// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/straightened_model.hpp"

#include <limits>
#include <utility>

namespace steerid::gap {

StraightenedModel::StraightenedModel(ResidualModel& model, Eigen::VectorXd x, std::vector<Fitted> fitted,
                                     std::vector<Spectrum> slopes)
    : x_(std::move(x)), fitted_(std::move(fitted)), along_(std::move(slopes)) {
  model.evaluate(x_, residual_, response_);
}

void StraightenedModel::stand_beside(const std::vector<Spectrum>& torques) {
  along_.resize(fitted_.size());
  for (const Spectrum& torque : torques) {
    Spectrum effect = -response_.gain_on_motion().cwiseProduct(torque);
    const double size = effect.norm();
    if (size > 0) effect *= residual_.norm() / size;
    along_.push_back(std::move(effect));
  }
}

Eigen::VectorXd StraightenedModel::start() const {
  Eigen::VectorXd at = Eigen::VectorXd::Zero(std::ssize(along_));
  at.head(x_.size()) = x_;
  return at;
}

std::vector<Fitted> StraightenedModel::fitted() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<Fitted> all = fitted_;
  all.resize(along_.size(), {.low = -infinity, .high = infinity});
  return all;
}

void StraightenedModel::evaluate(const Eigen::VectorXd& at, Spectrum& residual, Response& response) {
  residual = residual_;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const double by = i < x_.size() ? at[i] - x_[i] : at[i];
    if (by != 0) residual += by * along_[static_cast<std::size_t>(i)];
  }
  response = response_;
}

}  // namespace steerid::gap
