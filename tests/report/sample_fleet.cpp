// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Writes the page of a fleet that the browser test opens: two hundred vehicles of four drawn answers.
//
//   report_sample_fleet FOLDER
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <random>
#include <string>

#include "apps/fleet_page.hpp"
#include "fleet/answer_table.hpp"
#include "fleet/summary.hpp"

namespace {

using Json = nlohmann::ordered_json;

/// Friction in every third vehicle, growing with the mileage; one vehicle far out; every ninth answer unknown.
Json drawn_answer(std::mt19937_64& draw, int vehicle, int number, double mileage_km) {
  std::normal_distribution<double> normal;
  const bool unknown = number % 9 == 8;
  const bool friction = vehicle % 3 == 0 && !unknown;
  Json out = Json::parse(R"({"surrogate":false,"causes":[],"gap":{}})");
  out["verdict"] = unknown ? "unknown" : friction ? "coulomb_friction" : "none";
  out["ranking"] = {{{"effect", "coulomb_friction"}, {"probability", friction ? 0.96 : 0.01}},
                    {{"effect", "delay"}, {"probability", 0.01}},
                    {{"effect", "none"}, {"probability", friction || unknown ? 0.01 : 0.96}},
                    {{"effect", "unknown"}, {"probability", unknown ? 0.96 : 0.01}}};
  out["where"] = {{"axis", number % 2 == 0 ? "frequency" : "velocity"},
                  {"range", {number % 2 == 0 ? 1.5 : 0.2, number % 2 == 0 ? 3.0 : 0.4}},
                  {"unit", number % 2 == 0 ? "Hz" : "rad/s"}};
  out["gap"]["closed_fraction"] = unknown ? 0.3 : 0.95 + 0.02 * normal(draw);
  const double stiffness = (vehicle == 77 ? 60 : 22) + 2 * normal(draw);
  out["base"] = {{"inertia_kgm2", {{"value", 0.11 + 0.005 * normal(draw)}}},
                 {"damping_nms_per_rad", {{"value", 1.5 + 0.1 * normal(draw)}}},
                 {"stiffness_nm_per_rad", {{"value", stiffness}}}};
  if (friction) {
    const double level = 0.3 + 2e-6 * mileage_km + 0.02 * normal(draw);
    out["causes"] = {{{"effect", "coulomb_friction"}, {"parameters", {{"level_nm", level}}}}};
  }
  return out;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    (void)std::fputs("usage: report_sample_fleet FOLDER\n", stderr);
    return 2;
  }
  std::mt19937_64 draw(11);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same page every time
  steerid::fleet::Summary summary(steerid::fleet::kind_of("diagnose"));
  for (int vehicle = 0; vehicle < 200; ++vehicle) {
    for (int i = 0; i < 4; ++i) {
      const int number = 4 * vehicle + i;
      steerid::fleet::RecordLine line;
      line.record = {.name = fmt::format("drive_{:04}", number),
                     .log = "",
                     .sim = "",
                     .vehicle = fmt::format("VIN{:03}", vehicle),
                     .date = fmt::format("2026-{:02}-15", 1 + 2 * i),
                     .mileage_km = 500.0 * vehicle + 15'000 * i};
      if (number % 37 == 0) {
        line.ended = steerid::fleet::Ended::kUnusable;
        line.error =
            fmt::format("drive_{:04}/log.csv: lasts {} s, of 20 s that are needed; <b>record</b> more", number, i);
      } else {
        line.answer = drawn_answer(draw, vehicle, number, *line.record.mileage_km);
      }
      summary.add(line);
    }
  }
  summary.finish();
  const std::filesystem::path folder = words[1];
  std::filesystem::create_directories(folder);
  steerid::report::write_page(folder / "fleet.html", steerid::fleet_page(summary, folder));
}
