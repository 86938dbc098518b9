// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How records are listed, dealt out to shards, and brought together again.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "fleet/answer_table.hpp"
#include "fleet/calendar.hpp"
#include "fleet/merge.hpp"
#include "fleet/record_list.hpp"
#include "fleet/shard_file.hpp"
#include "fleet/shard_set.hpp"
#include "log/bad_input.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::fleet {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string said_by(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Shard, IsThatOfThePathsSha256) {
  // printf a/log.csv | sha256sum | cut -c1-16: 5f51414610d60d09 and so on, as a number modulo 7, plus 1 (Python).
  std::map<std::string, std::size_t> expected = {{"a/log.csv", 5}, {"b.csv", 2}, {"2026/käse.csv", 3}, {"x", 2}};
  for (const auto& [path, number] : expected) {
    for (std::size_t k = 1; k <= 7; ++k) EXPECT_EQ(Shard({k, 7}).holds(path), k == number) << path;
  }
}

TEST(Shard, IsReadFromKOfN) {
  EXPECT_EQ(parse_shard("3/10").number, 3U);
  EXPECT_EQ(parse_shard("3/10").of, 10U);
  for (const char* bad : {"", "3", "0/4", "5/4", "3/", "/3", "a/b", "1/2/3", "-1/2", "1 /2"}) {
    EXPECT_THROW((void)parse_shard(bad), BadOption) << bad;
  }
}

TEST(Calendar, CountsDaysAsUnixDoes) {
  EXPECT_EQ(days_of("1970-01-01"), 0.0);
  EXPECT_EQ(days_of("2000-03-01"), 11017.0);  // date -ud 2000-03-01 +%s over 86400
  EXPECT_EQ(days_of("2026-05-01T12:00"), 20574.5);
  EXPECT_EQ(days_of("2026-05-01T12:00:00Z"), 20574.5);
  for (const char* bad :
       {"", "2026", "2026-13-01", "2026-02-30", "2026-05-01T25:00", "2026-05-01T12:00x", "1.5.2026"}) {
    EXPECT_FALSE(days_of(bad).has_value()) << bad;
  }
  EXPECT_EQ(date_of(20574.9), "2026-05-01");
}

class Lists : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<ListedRecord> of(const std::string& text) const {
    return records_on(folder_.file("list.csv", text), folder_.path());
  }
  [[nodiscard]] std::string complaint(const std::string& text) const {
    const std::string all = said_by([&] { (void)of(text); });
    return all.substr(all.find("list.csv"));
  }

  test::TemporaryFolder folder_;
};

TEST_F(Lists, SayWhatIsKnownOfARecord) {
  const auto records =
      of("# ours\nrecord,vehicle,date,mileage_km,driver\nb.csv,V2,2026-05-01,10.5,x\n\na,V1,,,\nc/d/log.csv,V2,,7,\n");
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[0].name, "a");  // by vehicle, then by name
  EXPECT_EQ(records[0].log, "a/log.csv");
  EXPECT_EQ(records[0].sim, "a/sim.json");
  EXPECT_FALSE(records[0].mileage_km.has_value());
  EXPECT_EQ(records[1].name, "b");
  EXPECT_EQ(records[1].sim, "b.json");
  EXPECT_EQ(records[1].date, "2026-05-01");
  EXPECT_EQ(records[1].mileage_km, 10.5);
  EXPECT_EQ(records[2].name, "c/d");
  EXPECT_EQ(of("record,sim\na,models/s.json\n")[0].sim, "models/s.json");
}

TEST_F(Lists, AreRefusedByLine) {
  EXPECT_EQ(complaint("name\na\n"),
            "list.csv, line 1: expected a header with the column record, found \"name\"; the columns are record, sim, "
            "vehicle, date and mileage_km");
  EXPECT_NE(complaint("record\n../a\n").find("line 2, column 'record': expected a path within"), std::string::npos);
  EXPECT_NE(complaint("record\n/a\n").find("line 2, column 'record'"), std::string::npos);
  EXPECT_NE(complaint("record,date\na,yesterday\n").find("line 2, column 'date'"), std::string::npos);
  EXPECT_NE(complaint("record,mileage_km\na,far\n").find("line 2, column 'mileage_km'"), std::string::npos);
  EXPECT_NE(complaint("record,vehicle\na\n").find("line 2: expected 2 cells, found 1"), std::string::npos);
  EXPECT_NE(complaint("record\na\na.csv\n").find("expected records of different names"), std::string::npos);
  EXPECT_NE(complaint("record\n").find("expected a record a line"), std::string::npos);
}

/// Twenty records, three of them refused, one by a fault; dealt out to `of` shards below `root`, each in its own
/// folder.
class Merging : public ::testing::Test {
 protected:
  static constexpr std::size_t kRecords = 20;

  static RecordLine line(std::size_t i) {
    RecordLine out;
    out.record = {.name = "r" + std::to_string(i),
                  .log = "r" + std::to_string(i) + "/log.csv",
                  .sim = "",
                  .vehicle = "V" + std::to_string(i % 4),
                  .date = "2026-05-01",
                  .mileage_km = 10.0 * static_cast<double>(i)};
    out.made_from = {{"log", {{"bytes", i}, {"sha256", "0"}}}};
    if (i % 7 == 3) {
      out.ended = i == 3 ? Ended::kFault : Ended::kUnusable;
      out.error = "expected \"a\", found\n" + std::to_string(i);
    } else {
      out.answer = Json::parse(R"({"verdict":"delay","ranking":[{"effect":"delay","probability":0.75},
          {"effect":"none","probability":0.25}],"gap":{"sim_nrmse":0.5,"refit_nrmse":0.25,"with_effect_nrmse":0.125,
          "floor_nrmse":0.0625,"closed_fraction":null}})");
      out.answer["gap"]["sim_nrmse"] = 1.0 / static_cast<double>(i + 1);
    }
    return out;
  }

  [[nodiscard]] ShardHeader header(const Shard& shard) const {
    return {.command = "diagnose",
            .program = "p",
            .options = {{"seed", 1}, {"sign", ""}},
            .shard = shard,
            .records = 0,
            .records_in_all = kRecords,
            .list_sha256 = "l"};
  }

  [[nodiscard]] fs::path write_shard(const fs::path& out, ShardHeader header) const {
    std::map<std::pair<std::string, std::string>, RecordLine> own;
    for (std::size_t i = 0; i < kRecords; ++i) {
      const RecordLine one = line(i);
      if (header.shard.holds(one.record.log)) own[{one.record.vehicle, one.record.name}] = one;
    }
    header.records = own.size();
    fs::create_directories(out / kFleetFolder);
    const fs::path file = out / kFleetFolder / shard_file_name(header.shard);
    std::ofstream text(file, std::ios::binary);
    text << to_line(header);
    for (const auto& [place, one] : own) {
      text << to_line(one);
      if (one.ended != Ended::kAnswered) continue;
      fs::create_directories(out / one.record.name);
      std::ofstream(out / one.record.name / "diagnosis.json") << one.record.name;
    }
    return out;
  }

  [[nodiscard]] std::vector<fs::path> shards(std::size_t of) const {
    std::vector<fs::path> out;
    for (std::size_t k = 1; k <= of; ++k) {
      out.push_back(write_shard(folder_.path() / (std::to_string(k) + "of" + std::to_string(of)), header({k, of})));
    }
    return out;
  }

  /// Every file below `folder` with its bytes.
  [[nodiscard]] std::map<std::string, std::string> everything(const fs::path& folder) const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) out[entry.path().lexically_relative(folder).string()] = read(entry.path());
    }
    return out;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Merging, GivesTheSameBytesForEveryNumberOfShards) {
  const Merged merged = merge(shards(1), folder_.path() / "m1", {});
  EXPECT_EQ(merged.records, kRecords);
  EXPECT_EQ(merged.answered, 17U);
  EXPECT_EQ(merged.unusable, 2U);
  EXPECT_EQ(merged.faults, 1U);
  const auto one = everything(folder_.path() / "m1");
  EXPECT_TRUE(one.contains("table.csv"));
  EXPECT_TRUE(one.contains("r4/diagnosis.json"));
  EXPECT_FALSE(one.contains("r3/diagnosis.json"));
  for (const std::size_t of : {2UL, 3UL, 10UL, 50UL}) {
    auto given = shards(of);
    std::ranges::reverse(given);
    const fs::path out = folder_.path() / ("m" + std::to_string(of));
    (void)merge(given, out, {});
    EXPECT_EQ(everything(out), one) << of;
  }
}

TEST_F(Merging, TablesHoldEveryRecordOnceByVehicleAndName) {
  (void)merge(shards(3), folder_.path() / "m", {});
  const std::string table = read(folder_.path() / "m" / "table.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 21);
  EXPECT_TRUE(
      table.starts_with("case,verdict,probability,sim_nrmse,refit_nrmse,with_effect_nrmse,floor_nrmse,"
                        "closed_fraction,error\nr0,delay,0.75,1,0.25,0.125,0.0625,,\nr12,delay,"))
      << table;
  EXPECT_NE(table.find("\nr3,,,,,,,,\"expected \"\"a\"\", found 3\"\n"), std::string::npos) << table;
}

/// Three changes that are sure share one in the ranking.
TEST_F(Merging, StatesAnAnswersOwnProbability) {
  const AnswerKind& kind = kind_of("diagnose");
  Json answer = line(0).answer;
  EXPECT_EQ(kind.cells(answer).at(1), "0.75");
  answer["probability"] = 0.96;
  EXPECT_EQ(kind.cells(answer).at(1), "0.96");
  EXPECT_EQ(digest(kind, answer).at("probability"), 0.96);
}

TEST_F(Merging, NamesWhatIsMissing) {
  auto given = shards(4);
  std::size_t held = 0;
  for (std::size_t i = 0; i < kRecords; ++i) held += Shard{2, 4}.holds(line(i).record.log) ? 1 : 0;
  given.erase(given.begin() + 1);
  EXPECT_EQ(said_by([&] { (void)merge(given, folder_.path() / "m", {}); }),
            "shard 2 of 4 is missing, with " + std::to_string(held) + " of 20 records; run it again with --shard K/4");
  EXPECT_FALSE(fs::exists(folder_.path() / "m"));
  const Merged merged = merge(given, folder_.path() / "m", {.allow_missing = true});
  EXPECT_EQ(merged.missing_shards, std::vector<std::size_t>{2});
  EXPECT_EQ(merged.records, kRecords - held);
}

TEST_F(Merging, RefusesShardsOfAnotherRun) {
  const auto complaint = [&](const std::function<void(ShardHeader&)>& change) {
    const fs::path a = write_shard(folder_.path() / "a", header({1, 2}));
    ShardHeader other = header({2, 2});
    change(other);
    const fs::path b = write_shard(folder_.path() / "b", other);
    const std::string said = said_by([&] { (void)merge({a, b}, folder_.path() / "m", {}); });
    fs::remove_all(folder_.path() / "b");
    EXPECT_FALSE(fs::exists(folder_.path() / "m"));
    return said.substr(said.find("found"));
  };
  const std::string advice = "; run it again, or merge shards of one run only";
  EXPECT_EQ(complaint([](ShardHeader& h) { h.program = "q"; }), "found answers of another program" + advice);
  EXPECT_EQ(complaint([](ShardHeader& h) { h.options["seed"] = 2; }), "found seed 2 beside 1" + advice);
  EXPECT_EQ(complaint([](ShardHeader& h) { h.options["new"] = 2; }), "found other options" + advice);
  EXPECT_EQ(complaint([](ShardHeader& h) { h.command = "identify"; }), "found identify beside diagnose" + advice);
  EXPECT_EQ(complaint([](ShardHeader& h) { h.list_sha256 = "k"; }),
            "found another list of records (20 beside 20)" + advice);
  EXPECT_EQ(complaint([](ShardHeader& h) { h.shard = {2, 3}; }), "found 3 shards beside 2" + advice);
}

TEST_F(Merging, TakesOneShardTwiceOnlyWhereItIsTheSame) {
  auto given = shards(2);
  fs::copy(given[0], folder_.path() / "again", fs::copy_options::recursive);
  given.push_back(folder_.path() / "again");
  EXPECT_EQ(merge(given, folder_.path() / "m", {}).records, kRecords);
  ShardHeader forged = header({1, 2});
  const fs::path file = write_shard(folder_.path() / "again", forged) / kFleetFolder / shard_file_name({1, 2});
  std::string text = read(file);
  text.replace(text.find("0.75"), 4, "0.76");
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_NE(said_by([&] { (void)merge(given, folder_.path() / "m", {}); }).find("expected the same answers as in"),
            std::string::npos);
}

TEST_F(Merging, RefusesADamagedShard) {
  const auto given = shards(2);
  const fs::path file = given[0] / kFleetFolder / shard_file_name({1, 2});
  const std::string whole = read(file);
  const auto said = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return said_by([&] { (void)merge(given, folder_.path() / "m", {}); });
  };
  const std::size_t last = whole.rfind('\n', whole.size() - 2) + 1;
  EXPECT_NE(said(whole.substr(0, last)).find(" records, found "), std::string::npos);
  EXPECT_NE(said(whole.substr(0, whole.size() - 5)).find("a line that is cut off"), std::string::npos);
  EXPECT_NE(said(whole.substr(0, last) + "{}\n").find("expected a record of a shard"), std::string::npos);
  EXPECT_NE(said("").find("an empty file"), std::string::npos);
  EXPECT_NE(said("record\n").find("expected the table of a shard"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_.path() / "m" / "table.csv"));
  // A record that belongs to the other shard.
  const std::string other = read(given[1] / kFleetFolder / shard_file_name({2, 2}));
  EXPECT_NE(said(whole.substr(0, last) + other.substr(other.rfind('\n', other.size() - 2) + 1))
                .find("expected records of shard 1/2"),
            std::string::npos);
}

}  // namespace
}  // namespace steerid::fleet
