// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "log/bad_input.hpp"
#include "plant/simulation.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::test {
namespace {

const std::string kWheel = R"("inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7)";

std::string complaint(const std::string& text) {
  try {
    (void)Simulation::from_json(text, "sim.json");
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(Simulation, ReadsTheContractsExample) {
  const auto simulation = Simulation::from_json(
      "{" + kWheel +
          R"(,"effects":[{"effect":"coulomb_friction","parameters":{"friction_nm":0.25}},{"effect":"delay"}],)" +
          R"("torque_between_samples":"held","sensors":{"angle":{"noise":1}}})",
      "sim.json");
  EXPECT_EQ(simulation.wheel.stiffness_nm_per_rad, 22.7);
  ASSERT_EQ(simulation.effects.size(), 2U);
  EXPECT_EQ(simulation.effects[0].type, &effect::coulomb_friction);
  EXPECT_EQ(simulation.effects[0].at("friction_nm"), 0.25);
  EXPECT_EQ(simulation.effects[1].at("delay_s"), effect::delay.parameters[0].preset);
  EXPECT_EQ(simulation.torque_between_samples, TorqueSignal::Between::kHeld);
  EXPECT_EQ(simulation.sensors_json, R"({"angle":{"noise":1}})");
}

TEST(Simulation, WritesWhatItReads) {
  Simulation simulation;
  simulation.wheel = {0.1 + 0.2, 1.0 / 3, 22.7};  // numbers that need all their digits
  for (const EffectType* type : effects()) {
    if (type->joint == EffectType::Joint::kAlone) continue;
    Effect effect(*type);
    effect.values.front() =
        type->parameters.front().whole ? type->parameters.front().high : effect.values.front() * (1 + 1.0 / 3);
    if (type->takes_time_course) effect.time_course_nm = {0.1, -1.0 / 7};
    simulation.effects.push_back(effect);
  }
  simulation.sensors_json = R"({"angle":{"noise_rad":0.001}})";
  const auto back = Simulation::from_json(simulation.to_json(), "sim.json");
  EXPECT_EQ(back.wheel.inertia_kgm2, simulation.wheel.inertia_kgm2);
  EXPECT_EQ(back.wheel.damping_nms_per_rad, simulation.wheel.damping_nms_per_rad);
  ASSERT_EQ(back.effects.size(), simulation.effects.size());
  for (std::size_t i = 0; i < back.effects.size(); ++i) {
    EXPECT_EQ(back.effects[i].type, simulation.effects[i].type);
    EXPECT_EQ(back.effects[i].values, simulation.effects[i].values);
    EXPECT_EQ(back.effects[i].time_course_nm, simulation.effects[i].time_course_nm);
  }
  EXPECT_EQ(back.to_json(), simulation.to_json());
}

TEST(Simulation, SaysInOneSentenceWhatIsWrongAndWhere) {
  const auto effects = [](const std::string& list) { return "{" + kWheel + ",\"effects\":" + list + "}"; };
  const std::vector<std::pair<std::string, std::vector<std::string>>> bad = {
      {"", {"sim.json, line 1", "JSON"}},
      {"{\n  \"inertia_kgm2\": 0.1,\n  oops\n}", {"line 3, column 3"}},
      {"[1]", {"top level", "an object"}},
      {R"({"inertia_kgm2":0.11})", {"damping_nms_per_rad"}},
      {R"({"inertia_kgm2":1e999})", {"sim.json"}},
      {R"({"inertia_kgm2":-1,"damping_nms_per_rad":1,"stiffness_nm_per_rad":2})", {"/inertia_kgm2", "\"-1\""}},
      {R"({"inertia_kgm2":"x","damping_nms_per_rad":1,"stiffness_nm_per_rad":2})", {"/inertia_kgm2", "number"}},
      {"{" + kWheel + R"(,"colour":1})", {"colour", "torque_between_samples"}},
      {"{" + kWheel + R"(,"sensors":[]})", {"/sensors", "object"}},
      {"{" + kWheel + R"(,"torque_between_samples":"linear"})", {"/torque_between_samples", "band_limited or held"}},
      {effects(R"({"effect":"delay"})"), {"/effects", "a list"}},
      {effects("[3]"), {"/effects/0", "an object"}},
      {effects(R"([{"parameters":{}}])"), {"/effects/0", "effect"}},
      {effects(R"([{"effect":"delay"},{"effect":"wobble"}])"), {"/effects/1/effect", "wobble", "sample_loss"}},
      {effects(R"([{"effect":"delay","parameters":{"delay_ms":3}}])"),
       {"/effects/0/parameters", "delay_ms", "delay_s"}},
      {effects(R"([{"effect":"delay","parameters":{"delay_s":3}}])"),
       {"/effects/0/parameters/delay_s", "-0.25 to 0.25"}},
      {effects(R"([{"effect":"delay","parameters":{"delay_s":null}}])"), {"/effects/0/parameters/delay_s", "null"}},
      {effects(R"([{"effect":"time_varying_stiffness","parameters":{"shape":0.5}}])"), {"shape", "whole number"}},
      {effects(R"([{"effect":"delay","time_course_nm":[]}])"), {"/effects/0", "time_course_nm"}},
      {effects(R"([{"effect":"unmeasured_torque","time_course_nm":[1,"b"]}])"), {"/effects/0/time_course_nm/1"}},
      {effects(R"([{"effect":"compliance"},{"effect":"hands_off"}])"), {"/effects", "compliance", "hands_off"}},
      {effects(R"([{"effect":"compliance"},{"effect":"compliance"}])"), {"compliance"}},
  };
  for (const auto& [text, parts] : bad) {
    const std::string said = complaint(text);
    EXPECT_EQ(said.rfind("sim.json", 0), 0U) << text << " -> " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
    for (const std::string& part : parts) EXPECT_NE(said.find(part), std::string::npos) << text << " -> " << said;
  }
}

/// As editors and shells of other systems write it.
TEST(Simulation, ReadsAFileInUtf16OrBehindAByteOrderMark) {
  const std::string text = "{" + kWheel + "}\r\n";
  std::string little = "\xff\xfe";
  std::string big = "\xfe\xff";
  for (const char c : text) {
    little += {c, '\0'};
    big += {'\0', c};
  }
  const TemporaryFolder folder;
  for (const std::string& bytes : {"\xef\xbb\xbf" + text, little, big}) {
    EXPECT_EQ(Simulation::load(folder.file("sim.json", bytes)).wheel.stiffness_nm_per_rad, 22.7);
  }
}

TEST(Simulation, AMissingFileIsBadInput) {
  EXPECT_THROW((void)Simulation::load("/nowhere/sim.json"), BadInput);
  EXPECT_THROW((void)Simulation::load("/"), BadInput);
}

/// The labelled records' vocabulary comes first, in its order; an effect that was added since stands behind it.
TEST(Vocabulary, BeginsWithThatOfTheGapRecordsInTheirOrder) {
  STEERID_SHARED_OR_SKIP(path, "gap/README.md");
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  const std::string all = text.str();
  std::vector<std::string> ids;
  const std::regex row(R"(\n\| `([a-z_]+)` \|)");
  for (std::sregex_iterator found(all.begin(), all.end(), row), end; found != end; ++found) ids.push_back((*found)[1]);
  std::erase_if(ids, [](const std::string& id) { return id == "none" || id == "parameters" || id == "unknown"; });
  std::vector<std::string> ours;
  for (const EffectType* type : effects()) ours.emplace_back(type->id);
  ASSERT_EQ(ids.size(), 22U);  // of the file, which is not ours
  ASSERT_GE(ours.size(), ids.size());
  ours.resize(ids.size());
  EXPECT_EQ(ours, ids);
}

TEST(Vocabulary, EveryParameterIsStatedSoundly) {
  const std::set<std::string> unitless = {"breakaway_ratio",     "sharpness",       "wheel_damping_share",
                                          "wheel_inertia_share", "shape",           "stiffness_ratio",
                                          "damping_exponent",    "cycles_per_turn", "loss_probability",
                                          "low_pass_shape",      "loop_shape",      "contact_shape"};
  const std::regex unit(R"(.*_(nm|rad|s|hz|rad_s|nm_per_rad|nms_per_rad|nm_per_rad3|nms2_per_rad2))");
  EXPECT_GE(effects().size(), 22U);
  for (const EffectType* type : effects()) {
    EXPECT_TRUE(type->in_plant != nullptr || type->on_record != nullptr) << type->id;
    EXPECT_FALSE(type->says.empty());
    std::set<std::string> names;
    for (const Parameter& parameter : type->parameters) {
      const std::string name(parameter.name);
      SCOPED_TRACE(std::string(type->id) + " " + name);
      EXPECT_TRUE(names.insert(name).second);
      EXPECT_TRUE(unitless.contains(name) || std::regex_match(name, unit));
      EXPECT_LT(parameter.low, parameter.high);
      EXPECT_GE(parameter.preset, parameter.low);
      EXPECT_LE(parameter.preset, parameter.high);
      EXPECT_GT(parameter.scale, 0);
      EXPECT_FALSE(parameter.says.empty());
    }
  }
}

// C = 1e9 over J = 1e-9 rings at 1e9 rad/s. The stiffest braced arm of the paper, 80.5 Nm/rad over 0.02 kg m2, at 63.
TEST(Simulation, IsRefusedWhereItIsTooStiffToBeFollowedInReasonableTime) {
  const std::string friction = R"(,"effects":[{"effect":"coulomb_friction","parameters":{"friction_nm":0.3}}]})";
  const auto wheel = [&](const char* inertia, const char* stiffness) {
    return complaint(std::string(R"({"inertia_kgm2":)") + inertia +
                     R"(,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":)" + stiffness + friction);
  };
  EXPECT_NE(wheel("1e-9", "1e9").find("too large beside its inertia"), std::string::npos);
  EXPECT_EQ(wheel("0.02", "80.5"), "");
}

TEST(Vocabulary, AnUnknownIdIsAnsweredWithAllOfThem) {
  try {
    (void)find_effect("friction");
    FAIL();
  } catch (const BadInput& error) {
    for (const EffectType* type : effects()) EXPECT_NE(std::string(error.what()).find(type->id), std::string::npos);
  }
  EXPECT_EQ(&find_effect("backlash"), &effect::backlash);
  EXPECT_THROW((void)Effect(effect::delay).at("delay_ms"), BadInput);
}

TEST(WheelArm, NaturalFrequencyIsThatOfThePapersEquationFive) {
  // J 0.1, B 1, C 22.5: xi = 1/(2 sqrt(2.25)) = 1/3, f = sqrt(8/9 x 225)/(2 pi) = sqrt(200)/(2 pi).
  const WheelArm wheel{0.1, 1, 22.5};
  EXPECT_NEAR(*wheel.damping_ratio(), 1.0 / 3, 1e-12);
  EXPECT_EQ(natural_frequency(wheel).defined, NaturalFrequency::Defined::kYes);
  EXPECT_NEAR(natural_frequency(wheel).hz, 2.2507908, 1e-6);
}

TEST(WheelArm, SaysWhyThereIsNoNaturalFrequency) {
  // The nominal row of table II, xi = 1.37.
  const WheelArm nominal{0.11, 2.9, 10.2};
  EXPECT_NEAR(*nominal.damping_ratio(), 1.37, 0.005);
  EXPECT_EQ(natural_frequency(nominal).reason(), "overdamped");
  EXPECT_EQ(natural_frequency(nominal).hz, 0.0);
  EXPECT_EQ(natural_frequency({0.1, 2, 10}).reason(), "overdamped");  // xi = 1 exactly
  EXPECT_EQ(natural_frequency({0.1, 1.999, 10}).reason(), "");
  EXPECT_EQ(natural_frequency({0.1, 1, 0}).reason(), "no stiffness");
  EXPECT_EQ(natural_frequency({0.1, 1, -3}).reason(), "no stiffness");
  EXPECT_EQ(natural_frequency({0, 1, 3}).reason(), "no inertia");
  EXPECT_EQ(natural_frequency({0.1, std::nan(""), 3}).reason(), "overdamped");
  EXPECT_FALSE((WheelArm{0.1, 1, 0}).damping_ratio().has_value());
}

}  // namespace
}  // namespace steerid::test
