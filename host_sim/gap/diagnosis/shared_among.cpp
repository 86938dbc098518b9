// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/shared_among.hpp"

#include <map>

namespace steerid::gap {

std::vector<double> shared_among(std::size_t count, const std::function<double(std::uint64_t)>& closed) {
  std::map<std::uint64_t, double> known;
  const auto ask = [&](std::uint64_t made) {
    const auto found = known.find(made);
    return found != known.end() ? found->second : known.emplace(made, closed(made)).first->second;
  };
  std::vector<double> shares(count, 0.0);
  for (std::size_t begin = 0; begin < count; ++begin) {
    for (const std::size_t step : {std::size_t{1}, count - 1}) {  // forwards, backwards
      std::uint64_t made = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t next = (begin + k * step) % count;
        const double before = ask(made);
        made |= std::uint64_t{1} << next;
        shares[next] += (ask(made) - before) / static_cast<double>(2 * count);
      }
    }
  }
  return shares;
}

}  // namespace steerid::gap
