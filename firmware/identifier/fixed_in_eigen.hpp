// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Lets Eigen's small vectors hold Fixed numbers. Include it wherever the identifier is instantiated for Fixed.
#pragma once

#include <Eigen/Core>

#include "base/fixed.hpp"

template <>
struct Eigen::NumTraits<steerid::Fixed> : Eigen::GenericNumTraits<steerid::Fixed> {
  using Real = steerid::Fixed;
  using NonInteger = steerid::Fixed;
  using Nested = steerid::Fixed;
  using Literal = steerid::Fixed;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 20,
    MulCost = 10
  };
};
