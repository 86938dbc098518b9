// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/between_steps.hpp"

#include <algorithm>
#include <cstddef>

#include "log/record_quality.hpp"

namespace steerid::gap {
namespace {

/// By how much a run is off at an instant, in samples of its stretch.
struct Passage {
  double at = 0;
  double off_rad = 0;
};

std::vector<Passage> passages(std::span<const double> recorded, std::span<const double> run) {
  std::vector<Passage> out;
  for (std::size_t i = 0; i + 1 < recorded.size(); ++i) {
    if (recorded[i] == recorded[i + 1]) continue;
    out.push_back({static_cast<double>(i) + 0.5, (recorded[i] + recorded[i + 1] - run[i] - run[i + 1]) / 2});
  }
  return out;
}

void follow(std::span<const double> recorded, std::span<const double> run, double step_rad, std::span<double> angle) {
  const std::vector<Passage> passed = passages(recorded, run);
  if (passed.empty()) return;
  auto next = passed.begin();
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const auto at = static_cast<double>(i);
    while (next != passed.end() && next->at < at) ++next;
    double off = 0;
    if (next == passed.begin()) {
      off = next->off_rad;
    } else {
      const Passage& last = *(next - 1);
      off = last.off_rad;
      if (next != passed.end()) off += (next->off_rad - last.off_rad) * (at - last.at) / (next->at - last.at);
    }
    angle[i] = std::clamp(run[i] + off, recorded[i] - step_rad / 2, recorded[i] + step_rad / 2);
  }
}

}  // namespace

std::vector<double> between_steps(const Record& record, std::span<const double> run_rad, double step_rad) {
  std::vector<double> angle = record.angle_rad;
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    const std::size_t count = rows.size();
    follow(std::span(record.angle_rad).subspan(rows.begin, count), run_rad.subspan(rows.begin, count), step_rad,
           std::span(angle).subspan(rows.begin, count));
  }
  return angle;
}

}  // namespace steerid::gap
