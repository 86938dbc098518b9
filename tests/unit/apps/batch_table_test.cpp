// How the records of a batch ended: who is at fault, the table, and the way the command ends.
#include "apps/batch_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "log/bad_input.hpp"
#include "support/temporary_folder.hpp"

namespace steerid {
namespace {

BatchRow diagnosed(const std::string& name) {
  return row_of(name, [](BatchRow& row) {
    row.answer = cells_of(nlohmann::ordered_json::parse(R"({"verdict":"delay","ranking":[{"probability":0.75}],
        "gap":{"sim_nrmse":0.5,"refit_nrmse":0.25,"with_effect_nrmse":0.125,"floor_nrmse":0.0625,"closed_fraction":null}})"));
  });
}

BatchRow unusable(const std::string& name, const std::string& why) {
  return row_of(name, [&](BatchRow&) { throw BadInput(why); });
}

BatchRow faulty(const std::string& name, const std::string& why) {
  return row_of(name, [&](BatchRow&) { throw std::logic_error(why); });
}

TEST(BatchTable, TellsWhoIsAtFault) {
  EXPECT_EQ(diagnosed("a").ended, BatchRow::Ended::kDiagnosed);
  EXPECT_EQ(unusable("a", "too short").ended, BatchRow::Ended::kUnusable);
  EXPECT_EQ(unusable("a", "too short").error, "too short");
  EXPECT_EQ(faulty("a", "a matrix of no size").ended, BatchRow::Ended::kFault);
  EXPECT_EQ(faulty("a", "a matrix of no size").error, "internal error: a matrix of no size");
}

TEST(BatchTable, EndsAsItsWorstRow) {
  const BatchRow good = diagnosed("a");
  const BatchRow bad = unusable("b", "too short");
  const BatchRow fault = faulty("c", "a matrix of no size");
  EXPECT_NO_THROW(end_as_the_worst({good, good}, "table.csv"));
  EXPECT_THROW(end_as_the_worst({good, bad}, "table.csv"), BadInput);
  EXPECT_THROW(end_as_the_worst({fault, bad, good}, "table.csv"), std::runtime_error);
  try {
    end_as_the_worst({bad, fault}, "table.csv");
  } catch (const BadInput&) {
    FAIL() << "a fault of the program passes for bad data";
  } catch (const std::exception&) {
  }
  EXPECT_EQ(batch_summary({good, bad}), "2 records, 0 kept from an earlier run, 1 not usable");
  EXPECT_EQ(batch_summary({good, bad, fault}),
            "3 records, 0 kept from an earlier run, 1 not usable, 1 ended in a fault of this program");
}

TEST(BatchTable, QuotesWhatWouldBreakARow) {
  const test::TemporaryFolder folder;
  write_batch_table(folder.path() / "table.csv", {diagnosed("left, right"), unusable("b", "expected \"a\", found\n2")});
  std::ifstream in(folder.path() / "table.csv");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(text,
            "case,verdict,probability,sim_nrmse,refit_nrmse,with_effect_nrmse,floor_nrmse,closed_fraction,error\n"
            "\"left, right\",delay,0.75,0.5,0.25,0.125,0.0625,,\n"
            "b,,,,,,,,\"expected \"\"a\"\", found\\x0a2\"\n");
}

}  // namespace
}  // namespace steerid
