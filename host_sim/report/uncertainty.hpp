// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A value with its standard deviation, in as many digits as the deviation bears.
#pragma once

#include <span>
#include <string>

#include "report/parts.hpp"

namespace steerid::report {

struct Written {
  std::string value;  ///< "0.1103"
  std::string sd;     ///< "0.0012"; empty when there is none
};

/// The deviation in two significant digits, the value in the same decimals (GUM, JCGM 100:2008, 7.2.6). A value without
/// a positive finite deviation gets four significant digits; one that is not finite is a dash.
Written written(double value, double sd);

/// "0.1103 ± 0.0012", or the value alone.
std::string with_sd(double value, double sd);

/// "3.70 to 3.72": in `significant` digits, or in as many more as keep the two ends apart; one that
/// has no width is its value.
std::string in_interval(double low, double high, int significant = 3);

/// "0.300 (0.243 to 0.360)": all in the decimals that give the interval two digits; a dash for what is not finite.
std::string with_interval(double value, const Ends& ends);

/// The decimals in which the edges of neighbouring bins differ plainly: rounding moves none by more than a fifth of the
/// narrowest bin. Edges may repeat.
int decimals_apart(std::span<const double> edges);

/// In so many decimals; a dash for what is not finite.
std::string in_decimals(double value, int decimals);

/// Four significant digits, or as many as are asked for; a dash for what is not finite.
std::string in_digits(double value, int significant = 4);

}  // namespace steerid::report
