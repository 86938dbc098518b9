// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a fleet's report takes from an answer of either shape, and from a damaged one.
#include "fleet/record_facts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace steerid::fleet {
namespace {

using Json = nlohmann::ordered_json;

const ChangeFact* find(const RecordFacts& facts, const std::string& effect, const std::string& change) {
  for (const ChangeFact& one : facts.changes) {
    if (one.effect == effect && one.change == change) return &one;
  }
  return nullptr;
}

double value(const RecordFacts& facts, const std::string& name) {
  for (const QuantityFact& one : facts.quantities) {
    if (one.name == name) return one.value;
  }
  return NAN;
}

TEST(FactsOfADiagnosis, OfOneVerdict) {
  const RecordFacts facts = facts_of_diagnosis(Json::parse(R"({
      "verdict":"delay","ranking":[{"effect":"delay","probability":0.7},{"effect":"none","probability":0.2},
      {"effect":"unknown","probability":0.1},{"effect":"lag","probability":0.0}],
      "causes":[{"effect":"delay","parameters":{"delay_s":0.02}}],"surrogate":false,
      "gap":{"closed_fraction":0.9},"base":{"inertia_kgm2":{"value":0.1},"damping_nms_per_rad":{"value":null}}})"));
  ASSERT_EQ(facts.changes.size(), 4U);
  EXPECT_EQ(find(facts, "delay", "add")->probability, 0.7);
  EXPECT_EQ(find(facts, "delay", "add")->prior, 0.25);
  EXPECT_EQ(find(facts, "none", "")->probability, 0.2);
  EXPECT_EQ(find(facts, "unknown", "")->probability, 0.1);
  EXPECT_EQ(facts.closed, 0.9);
  EXPECT_FALSE(facts.unknown);
  EXPECT_EQ(value(facts, "delay delay_s"), 0.02);
  EXPECT_EQ(value(facts, "inertia_kgm2"), 0.1);
  EXPECT_TRUE(std::isnan(value(facts, "damping_nms_per_rad")));
}

TEST(FactsOfADiagnosis, OfSeveralChanges) {
  const RecordFacts facts = facts_of_diagnosis(Json::parse(R"({
      "verdict":"coulomb_friction","ranking":[{"effect":"coulomb_friction","probability":0.6},
      {"effect":"unknown","probability":0.4}],
      "inclusion":[{"effect":"coulomb_friction","change":"resize","probability":0.99,"prior":0.1},
      {"effect":"delay","change":"remove","probability":0.2},{"effect":"lag","probability":2}],
      "causes":[{"effect":"coulomb_friction","change":"resize","parameters":{"level_nm":0.4}}],
      "gap":{"closed_fraction":null}})"));
  ASSERT_EQ(facts.changes.size(),
            3U);  // an effect of the ranking stands in the inclusion already; no 2 is a probability
  EXPECT_EQ(find(facts, "coulomb_friction", "resize")->prior, 0.1);
  EXPECT_NEAR(find(facts, "delay", "remove")->prior, 1.0 / 3, 1e-12);
  EXPECT_EQ(find(facts, "unknown", "")->probability, 0.4);
  EXPECT_TRUE(std::isnan(facts.closed));
}

TEST(FactsOfADiagnosis, SayWhereTheUnknownLies) {
  const auto of = [](const char* fields) {
    return facts_of_diagnosis(Json::parse(std::string(R"({"verdict":"unknown","surrogate":true,
        "causes":[{"effect":"delay","parameters":{"delay_s":0.02}}],
        "where":{"axis":"frequency","range":[1.5,3.0],"unit":"Hz"})") +
                                          fields + "}"));
  };
  const RecordFacts old = of("");
  EXPECT_TRUE(old.unknown);
  EXPECT_EQ(old.unexplained.axis, "frequency");
  EXPECT_EQ(old.unexplained.high, 3.0);
  EXPECT_TRUE(std::isnan(value(old, "delay delay_s")));  // a surrogate's size is no size of the fleet
  const RecordFacts now = of(R"(,"unexplained":{"share_of_gap":0.3,
      "where":{"axis":"velocity","range":[0.1,0.2],"unit":"rad/s"},"complete":false})");
  EXPECT_EQ(now.unexplained.axis, "velocity");
  EXPECT_EQ(of(R"(,"unexplained":{"where":{"axis":"velocity","range":[null,1]}})").unexplained.axis, "frequency");
}

TEST(Facts, OfADamagedAnswerAreThoseThatItHas) {
  for (const char* text : {"null", "[]", "7", "{}", R"({"ranking":{},"inclusion":[7],"causes":[{}],"gap":3,"base":[]})",
                           R"({"verdict":"unknown","where":{"axis":3,"range":"x"}})"}) {
    EXPECT_TRUE(facts_of_diagnosis(Json::parse(text)).changes.empty()) << text;
    EXPECT_TRUE(facts_of_identification(Json::parse(text)).quantities.empty()) << text;
  }
}

TEST(FactsOfAnIdentification, AreItsValidNumbers) {
  const RecordFacts facts = facts_of_identification(Json::parse(R"({
      "inertia_kgm2":{"value":0.1,"sd":0.01,"state":"valid"},
      "stiffness_nm_per_rad":{"value":20,"sd":1,"state":"holding"},"free_run_nrmse":0.05,"doubt":"too odd",
      "batch":{"stiffness_nm_per_rad":{"value":21,"sd":1,"state":"valid"}}})"));
  EXPECT_EQ(value(facts, "inertia_kgm2"), 0.1);
  EXPECT_TRUE(std::isnan(value(facts, "stiffness_nm_per_rad")));
  EXPECT_EQ(value(facts, "batch stiffness_nm_per_rad"), 21);
  EXPECT_EQ(value(facts, "free_run_nrmse"), 0.05);
  EXPECT_EQ(facts.doubt, "too odd");
}

}  // namespace
}  // namespace steerid::fleet
