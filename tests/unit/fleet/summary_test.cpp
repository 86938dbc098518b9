// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a fleet's records have in common: outliers, clusters, reasons, and the tables of it all.
#include "fleet/summary.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "fleet/summary_tables.hpp"
#include "support/seed.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::fleet {
namespace {

using Json = nlohmann::ordered_json;

RecordNumber record(const std::string& name, const std::string& vehicle = "") {
  return {.record = name, .vehicle = vehicle};
}

/// `vehicles` means that are spread normally, and the last of them moved by `away`.
std::vector<VehicleMean> outliers_of(std::mt19937_64& draw, std::size_t vehicles, double away) {
  std::normal_distribution<double> normal;
  QuantityTally tally;
  for (std::size_t v = 0; v < vehicles; ++v) {
    const std::string name = fmt::format("V{}", v);
    const double mean = 5 + normal(draw) + (v + 1 == vehicles ? away : 0);
    tally.add(mean - 0.1, record(name + "a", name));
    tally.add(mean + 0.1, record(name + "b", name));
    tally.end_vehicle(v);
  }
  return tally.outliers();
}

TEST(Outliers, AreNamedWithTheirFarthestRecord) {
  std::mt19937_64 draw(test::seed(4));  // NOLINT(cert-msc51-cpp)
  const auto high = outliers_of(draw, 200, 12);
  ASSERT_FALSE(high.empty());
  EXPECT_EQ(high.front().vehicle, "V199");
  EXPECT_EQ(high.front().records, 2);
  EXPECT_EQ(high.front().extreme.record, "V199b");
  const auto low = outliers_of(draw, 200, -12);
  ASSERT_FALSE(low.empty());
  EXPECT_EQ(low.front().extreme.record, "V199a");
  EXPECT_TRUE(outliers_of(draw, 9, 50).empty());  // of so few nobody knows the spread
}

TEST(Outliers, AreRareInAFleetThatHasNone) {
  std::mt19937_64 draw(test::seed(5));  // NOLINT(cert-msc51-cpp)
  int fleets = 0;
  for (int i = 0; i < 400; ++i) fleets += outliers_of(draw, 1000, 0).empty() ? 0 : 1;
  // One fleet in twenty, with four standard deviations (1.1 %) and the error of the median deviation, which adds some.
  EXPECT_GT(fleets, 0.01 * 400);
  EXPECT_LT(fleets, 0.11 * 400);
}

TEST(Places, ThatAreNeighboursAreOneCluster) {
  PlaceTally places;
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{{1.5, 3}, {3, 5}, {5, 8}, {0, 0.15}}) {
    places.add({"frequency", "Hz", low, high}, record("f"));
  }
  places.add({"velocity", "rad/s", 1, 2}, record("v"));
  places.add({"velocity", "rad/s", -2, -1}, record("w"));  // the other direction
  places.add({"channel", "", 0, 1}, record("c"));
  places.add({"channel", "", 1, 2}, record("d"));  // another channel is no neighbour
  places.add({}, record("nowhere"));
  const auto clusters = places.clusters();
  ASSERT_EQ(clusters.size(), 7U);
  EXPECT_EQ(clusters[0].axis, "frequency");
  EXPECT_EQ(clusters[0].records, 3U);
  EXPECT_EQ(clusters[0].low, 1.5);
  EXPECT_EQ(clusters[0].high, 8);
  for (std::size_t i = 1; i < clusters.size(); ++i) EXPECT_EQ(clusters[i].records, 1U);
}

TEST(Reasons, AreOneWhereOnlyNamesAndNumbersDiffer) {
  ReasonTally reasons;
  reasons.add("drives/a.csv, line 7: expected a number, found \"x\"; mend it", false, record("a"));
  reasons.add("drives/b.csv, line 12: expected a number, found \"y, \"; mend it", false, record("b"));
  reasons.add("drives/c.csv: lasts 3.5 s, of 20 s", false, record("c"));
  reasons.add("drives/d.csv: lasts 13 s, of 20 s", false, record("d"));
  reasons.add("drives/e.csv: lasts 1 s, of 20 s", false, record("e"));
  reasons.add("internal error: no memory", true, record("f"));
  const auto found = reasons.reasons();
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].sentence, "lasts # s, of # s");
  EXPECT_EQ(found[0].records, 3U);
  EXPECT_EQ(found[1].sentence, "expected a number, found \"\u2026\"; mend it");
  EXPECT_EQ(found[1].examples[1].record, "b");
  EXPECT_TRUE(found[2].fault);
}

/// Sixty vehicles of four records: friction in every other vehicle, its level growing with the mileage; every tenth
/// record is unknown, every thirteenth refused.
class DrawnFleet : public ::testing::Test {
 protected:
  DrawnFleet() : summary_(kind_of("diagnose")) {
    std::mt19937_64 draw(test::seed(6));  // NOLINT(cert-msc51-cpp)
    std::normal_distribution<double> normal;
    for (int v = 0; v < 60; ++v) {
      for (int i = 0; i < 4; ++i) {
        const int number = 4 * v + i;
        RecordLine line;
        line.record = {.name = fmt::format("r{}", number), .log = "", .sim = "", .vehicle = vehicle(v)};
        line.record.mileage_km = 1000.0 * v + 10'000 * i;
        line.record.date = fmt::format("2026-0{}-01", 1 + i);
        if (number % 13 == 0) {
          line.ended = Ended::kUnusable;
          line.error = fmt::format("r.csv: lasts {} s", number);
        } else {
          line.answer =
              answer(v % 2 == 0, number % 10 == 9, 0.3 + 1e-5 * *line.record.mileage_km + 0.01 * normal(draw));
        }
        summary_.add(line);
      }
    }
    summary_.finish();
    for (FleetTable& table : summary_tables(summary_)) tables_.emplace(table.key, std::move(table));
  }

  static std::string vehicle(int v) { return fmt::format("V{}", 100 + v); }

  static Json answer(bool friction, bool unknown, double level) {
    Json out = Json::parse(R"({"gap":{"closed_fraction":0.9},"base":{"inertia_kgm2":{"value":0.1}},"causes":[]})");
    out["verdict"] = unknown ? "unknown" : friction ? "coulomb_friction" : "none";
    out["ranking"] = {{{"effect", "coulomb_friction"}, {"probability", friction && !unknown ? 0.98 : 0.01}},
                      {{"effect", "none"}, {"probability", !friction && !unknown ? 0.98 : 0.01}},
                      {{"effect", "unknown"}, {"probability", unknown ? 0.98 : 0.01}}};
    out["where"] = {{"axis", "frequency"}, {"range", {1.5, 3.0}}, {"unit", "Hz"}};
    if (friction && !unknown) {
      out["causes"] = {{{"effect", "coulomb_friction"}, {"parameters", {{"level_nm", level}}}}};
    }
    return out;
  }

  /// The cell of the row whose first cells are `first`, in the column of this key; null where there is none.
  [[nodiscard]] Json cell(const std::string& table, const std::vector<std::string>& first, const std::string& key) {
    const FleetTable& of = tables_.at(table);
    write_table(folder_.path(), of);
    std::ifstream in(folder_.path() / (table + ".jsonl"));
    for (std::string line; std::getline(in, line);) {
      const Json row = Json::parse(line);
      bool same = true;
      for (std::size_t i = 0; i < first.size(); ++i) same = same && row.at(of.columns[i].key) == first[i];
      if (same) return row.at(key);
    }
    return nullptr;
  }

  test::TemporaryFolder folder_;
  Summary summary_;
  std::map<std::string, FleetTable> tables_;
};

TEST_F(DrawnFleet, IsCounted) {
  EXPECT_EQ(summary_.records(), 240U);
  EXPECT_EQ(summary_.answered(), 221U);  // 19 multiples of 13 below 240
  EXPECT_EQ(summary_.vehicles(), 60U);
  EXPECT_EQ(cell("refused", {"unusable", "lasts # s"}, "records"), 19);
  EXPECT_EQ(cell("unknown", {"frequency"}, "share_of_unknown"), 1);
}

TEST_F(DrawnFleet, SharesAreThoseThatWereDrawn) {
  // Half of the vehicles, less the unknown tenth: 45 %. Between vehicles that always and that never have it, an
  // interval is nearly as wide as that of sixty coins: 1.96 * 0.5 / sqrt(60) = 13 % to either side.
  const double share = cell("changes", {"coulomb_friction", "add"}, "share").get<double>();
  const double low = cell("changes", {"coulomb_friction", "add"}, "share_low").get<double>();
  const double high = cell("changes", {"coulomb_friction", "add"}, "share_high").get<double>();
  EXPECT_NEAR(share, 0.45, 0.06);
  EXPECT_GT(high - low, 0.15);
  EXPECT_LT(high - low, 0.3);
  EXPECT_EQ(cell("changes", {"coulomb_friction", "add"}, "vehicles"), 30);
}

TEST_F(DrawnFleet, DriftsByWhatWasDrawn) {
  const std::vector<std::string> level = {"coulomb_friction level_nm", "mileage"};
  EXPECT_EQ(cell("drift", level, "vehicles"), "within");
  EXPECT_LE(cell("drift", level, "slope_low").get<double>(), 0.1);
  EXPECT_GE(cell("drift", level, "slope_high").get<double>(), 0.1);
  EXPECT_NEAR(cell("drift", level, "slope").get<double>(), 0.1, 0.01);  // 1e-5 a kilometre
  EXPECT_EQ(cell("drift", level, "drifts"), "drifts");
  EXPECT_EQ(cell("drift", {"inertia_kgm2", "mileage"}, "drifts"), "");
  EXPECT_NEAR(cell("drift", {"coulomb_friction level_nm", "date"}, "slope").get<double>(), 0.1 / 30.4 * 365.25, 0.05);
}

TEST_F(DrawnFleet, EveryCountLeadsToATableOfRecords) {
  std::map<std::string, FleetTable> lists;
  for (FleetTable& list : record_tables(summary_)) lists.emplace(list.key, std::move(list));
  std::size_t counts = 0;
  for (const auto& [key, table] : tables_) {
    for (const auto& row : table.rows) {
      ASSERT_EQ(row.size(), table.columns.size()) << key;
      for (const FleetCell& one : row) {
        const auto* count = std::get_if<CountOf>(&one);
        if (count == nullptr || count->number == 0) continue;
        ++counts;
        ASSERT_TRUE(lists.contains(count->list)) << key << ": " << count->list;
        const double listed = static_cast<double>(lists.at(count->list).rows.size());
        EXPECT_GE(listed, std::min(count->number, 24.0)) << count->list;  // 25, or 12 from either end
        EXPECT_LE(listed, count->number) << count->list;
      }
    }
  }
  EXPECT_GE(counts, 7U);
}

TEST_F(DrawnFleet, TablesAreCsvToo) {
  write_table(folder_.path(), tables_.at("changes"));
  std::ifstream in(folder_.path() / "changes.csv");
  std::string header;
  std::string first;
  std::getline(in, header);
  std::getline(in, first);
  EXPECT_EQ(header, "effect,change,share,share_low,share_high,records,vehicles,clearest");
  EXPECT_TRUE(first.starts_with("coulomb_friction,add,0.4")) << first;
}

}  // namespace
}  // namespace steerid::fleet
