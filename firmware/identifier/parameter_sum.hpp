// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The parameters as what they are: a sum of corrections, one a sample, that goes on for hours.
//
// A correction is some 3e-6 of its parameter. Added to it in float, it loses half a unit in the parameter's last place,
// 3e-8 of the value, at every sample, in either direction. Over the ten thousand samples that the memory reaches back
// to that adds up to 1e-5 of the value. So float keeps what has come since the last refresh apart from what there was
// then: its last place is a hundred times finer, and nothing is added to the parameter itself but at the refresh, when
// what is rounded off stays behind. Double and fixed point, with 53 and 29 bits, need nothing of it.
#pragma once

#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
class ParameterSum {
 public:
  explicit(false) ParameterSum(const Vector3<Scalar>& value) : value_(value) {}

  [[nodiscard]] Vector3<Scalar> value() const { return value_; }
  [[nodiscard]] Scalar operator()(int i) const { return value_(i); }
  void set(int i, Scalar value) { value_(i) = value; }
  /// What one measurement has to say (UdCovariance::Correction).
  template <class Correction>
  void add(const Correction& correction) {
    correction.apply(value_);
  }
  /// Now and then, twice a second say.
  void fold() {}

 private:
  Vector3<Scalar> value_;
};

template <>
class ParameterSum<float> {
 public:
  explicit(false) ParameterSum(const Vector3<float>& value) : settled_(value) {}

  [[nodiscard]] Vector3<float> value() const { return settled_ + since_; }
  [[nodiscard]] float operator()(int i) const { return settled_(i) + since_(i); }
  void set(int i, float value) {
    settled_(i) = value;
    since_(i) = 0;
  }
  template <class Correction>
  void add(const Correction& correction) {
    correction.apply(since_);
  }
  void fold() {
    const Vector3<float> before = settled_;
    settled_ += since_;
    since_ -= settled_ - before;
  }

 private:
  Vector3<float> settled_;
  Vector3<float> since_ = Vector3<float>::Zero();
};

}  // namespace steerid
