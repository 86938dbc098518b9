// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/over_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace steerid {
namespace {

std::size_t column_of(const FoundTable& table, std::string_view key) {
  const auto at = std::find_if(table.columns.begin(), table.columns.end(),
                               [&](const FoundColumn& column) { return column.key == key; });
  if (at == table.columns.end()) throw std::out_of_range(fmt::format("{}: no column {}", table.name, key));
  return static_cast<std::size_t>(at - table.columns.begin());
}

struct Sum {
  std::string torque, parameter;
  double kinds = 0, valid_percent = 0, wrong_percent = 0, longest_s = 0, above = 0;
};

}  // namespace

FoundTable over_kinds(const FoundTable& table) {
  const std::size_t valid = column_of(table, "valid_percent");
  const std::size_t wrong = column_of(table, "wrong_of_valid_percent");
  const std::size_t longest = column_of(table, "longest_wrong_s");
  std::vector<Sum> sums;
  for (const auto& row : table.rows) {
    const auto& torque = std::get<std::string>(row.at(1));
    const auto& parameter = std::get<std::string>(row.at(2));
    auto sum = std::find_if(sums.begin(), sums.end(),
                            [&](const Sum& one) { return one.torque == torque && one.parameter == parameter; });
    if (sum == sums.end()) sum = sums.insert(sums.end(), Sum{.torque = torque, .parameter = parameter});
    const double of_valid = std::get<double>(row.at(wrong));
    const double wrong_percent = std::isnan(of_valid) ? 0 : of_valid;
    sum->kinds += 1;
    sum->valid_percent += std::get<double>(row.at(valid));
    sum->wrong_percent += wrong_percent;
    sum->longest_s = std::max(sum->longest_s, std::get<double>(row.at(longest)));
    sum->above += wrong_percent > kMostWrong_percent;
  }
  FoundTable over{
      "over_kinds",
      "Over all kinds",
      fmt::format("Means over the kinds, the longest stretch of any, and kinds in which more than {:g} % of "
                  "what is valid is wrong.",
                  kMostWrong_percent),
      {table.columns.at(1), table.columns.at(2), number_column("kinds", "kinds", ""),
       number_column("valid_percent", "valid", "%"), number_column("wrong_of_valid_percent", "of these wrong", "%"),
       number_column("longest_wrong_s", "longest", "s"), number_column("kinds_above", "kinds above", "")},
      {}};
  for (const Sum& sum : sums) {
    over.rows.push_back({sum.torque, sum.parameter, sum.kinds, sum.valid_percent / sum.kinds,
                         sum.wrong_percent / sum.kinds, sum.longest_s, sum.above});
  }
  return over;
}

}  // namespace steerid
