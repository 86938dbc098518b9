// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The answer of `steerid identify`: natural frequency, JSON, table and trace, from numbers computed by hand.
#include "apps/identification.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "apps/answers.hpp"
#include "apps/credibility.hpp"
#include "apps/driver_timeline.hpp"
#include "apps/first_look.hpp"
#include "apps/identification_json.hpp"
#include "apps/identification_table.hpp"
#include "apps/identification_trace.hpp"

namespace steerid {
namespace {

// J = 0.04, B = 0.4, C = 10: xi = 0.4 / (2 sqrt(0.4)) = 0.316228 = sqrt(0.1), and
// sqrt((1 - 0.1) 10 / 0.04) / (2 pi) = 15 / (2 pi) = 2.387324 Hz.
Identification ringing_arm() {
  Identification found;
  found.method = "recursive";
  found.inertia_kgm2 = {0.04, 0.001, ParameterState::kValid};
  found.damping_nms_per_rad = {0.4, 0.01, ParameterState::kValid};
  found.stiffness_nm_per_rad = {10.0, 0.1, ParameterState::kHolding};
  found.amplitude_fit_percent = 97.5;
  found.free_run_nrmse = 0.03;
  return found;
}

TEST(FrequencyAnswer, OfAnUnderdampedArm) {
  const FrequencyAnswer frequency = frequency_answer(ringing_arm());
  EXPECT_NEAR(frequency.hz.value(), 2.387324, 1e-6);
  EXPECT_NEAR(frequency.damping_ratio.value(), 0.316228, 1e-6);
  EXPECT_EQ(frequency.reason, "");
}

TEST(FrequencyAnswer, NominalRowOfTableTwoIsOverdamped) {
  Identification found = ringing_arm();
  found.inertia_kgm2.value = 0.11;
  found.damping_nms_per_rad.value = 2.9;
  found.stiffness_nm_per_rad.value = 10.2;
  const FrequencyAnswer frequency = frequency_answer(found);
  EXPECT_FALSE(frequency.hz);
  EXPECT_NEAR(frequency.damping_ratio.value(), 1.37, 0.005);  // 2.9 / (2 sqrt(0.11 10.2))
  EXPECT_NE(frequency.reason.find("overdamped"), std::string::npos);
}

TEST(FrequencyAnswer, NoneWithoutEveryParameter) {
  Identification found = ringing_arm();
  found.inertia_kgm2.state = ParameterState::kNotExcited;
  EXPECT_EQ(frequency_answer(found).reason, "inertia is not excited");
  EXPECT_FALSE(frequency_answer(found).hz);
  EXPECT_FALSE(frequency_answer(found).damping_ratio);
}

TEST(FrequencyAnswer, NoneForStiffnessThatMayBeZero) {
  Identification found = ringing_arm();
  found.stiffness_nm_per_rad.sd = 5.1;
  EXPECT_EQ(frequency_answer(found).reason, "stiffness cannot be told from zero");
  found.stiffness_nm_per_rad.sd = 4.9;
  EXPECT_TRUE(frequency_answer(found).hz);
  found.stiffness_nm_per_rad = {-3.0, 0.1, ParameterState::kValid};
  EXPECT_FALSE(frequency_answer(found).hz);
}

TEST(FromPublished, MicroUnitsAndTheEndOfTheirRange) {
  const IdentifiedParameter known = from_published({110'000, 250, ParameterState::kValid});
  EXPECT_DOUBLE_EQ(known.value, 0.11);
  EXPECT_DOUBLE_EQ(known.sd, 0.00025);
  EXPECT_EQ(known.state, ParameterState::kValid);
  EXPECT_TRUE(std::isinf(from_published({0, std::numeric_limits<std::int32_t>::max(), {}}).sd));
}

TEST(IdentificationJson, HoldsTheContract) {
  Identification batch = ringing_arm();
  batch.method = "batch_gauss_newton";
  batch.stiffness_nm_per_rad = {};
  batch.stiffness_nm_per_rad.state = ParameterState::kNotExcited;
  batch.free_run_nrmse.reset();
  const auto json = nlohmann::json::parse(identification_json(ringing_arm(), batch).dump());

  EXPECT_EQ(json.at("schema"), "steerid.identify/1");
  EXPECT_EQ(json.at("method"), "recursive");
  EXPECT_EQ(json.at("inertia_kgm2"), nlohmann::json::parse(R"({"value":0.04,"sd":0.001,"state":"valid"})"));
  EXPECT_EQ(json.at("damping_nms_per_rad").at("value"), 0.4);
  EXPECT_EQ(json.at("stiffness_nm_per_rad").at("state"), "holding");
  EXPECT_NEAR(json.at("natural_frequency_hz").at("value").get<double>(), 2.387324, 1e-6);
  EXPECT_NEAR(json.at("damping_ratio").get<double>(), 0.316228, 1e-6);
  EXPECT_EQ(json.at("amplitude_fit_percent"), 97.5);
  EXPECT_EQ(json.at("free_run_nrmse"), 0.03);

  const auto& second = json.at("batch");
  EXPECT_EQ(second.at("method"), "batch_gauss_newton");
  EXPECT_TRUE(second.at("stiffness_nm_per_rad").at("sd").is_null());  // infinite: JSON has no word for it
  EXPECT_TRUE(second.at("natural_frequency_hz").at("value").is_null());
  EXPECT_EQ(second.at("natural_frequency_hz").at("reason"), "stiffness is not excited");
  EXPECT_TRUE(second.at("damping_ratio").is_null());
  EXPECT_TRUE(second.at("free_run_nrmse").is_null());
}

TEST(IdentificationJson, HasNoBatchUnlessAsked) {
  EXPECT_FALSE(identification_json(ringing_arm(), std::nullopt).contains("batch"));
}

TEST(IdentificationTable, ShowsNoNumberForWhatWasNotIdentified) {
  Identification found = ringing_arm();
  found.inertia_kgm2 = {0.123456, 0.04, ParameterState::kNotExcited};
  const std::string table = identification_table(found);
  EXPECT_EQ(table.find("0.12345"), std::string::npos) << table;
  EXPECT_NE(table.find("not excited"), std::string::npos) << table;
  EXPECT_NE(table.find("inertia is not excited"), std::string::npos) << table;
  EXPECT_NE(identification_table(ringing_arm()).find("2.387  Hz"), std::string::npos);
}

TEST(Doubt, TakesTheAnswerBackAndSaysWhy) {
  Identification found = ringing_arm();
  refuse(found, "torque_motor seems to have the wrong sign");
  const std::string table = identification_table(found);
  EXPECT_EQ(table.find("0.04 "), std::string::npos) << table;
  EXPECT_NE(table.find("fault"), std::string::npos) << table;
  const auto json = nlohmann::json::parse(identification_json(found, std::nullopt).dump());
  EXPECT_TRUE(json.at("inertia_kgm2").at("value").is_null());
  EXPECT_EQ(json.at("inertia_kgm2").at("state"), "fault");
  EXPECT_EQ(json.at("doubt"), "torque_motor seems to have the wrong sign");
  EXPECT_FALSE(frequency_answer(found).hz);
  EXPECT_FALSE(nlohmann::json::parse(identification_json(ringing_arm(), std::nullopt).dump()).contains("doubt"));
}

TEST(Limit, StandsWhereThereIsNoValue) {
  Identification found = ringing_arm();
  found.inertia_kgm2 = {.value = 5e-5, .state = ParameterState::kNotExcited, .at_most = 0.00123};
  EXPECT_NE(identification_table(found).find("<= 0.00123"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(identification_json(found, std::nullopt).dump()).at("inertia_kgm2").at("at_most"),
            0.00123);
}

/// A steady drive in closed form: J 0.1, B 1.2, C 20, three tones by the driver and three by the motor.
Record two_torques(double motor_sign) {
  constexpr double kTurn = 6.283185307179586;
  Record record;
  for (int k = 0; k < 3'000; ++k) {
    const double t = 0.01 * k;
    double driver = 0, motor = 0, angle = 0;
    const auto add = [&](double& torque, double sign, double amplitude, double frequency_hz) {
      const double w = kTurn * frequency_hz;
      const std::complex<double> gain = 1.0 / std::complex<double>(20 - 0.1 * w * w, 1.2 * w);
      const auto at = std::polar(amplitude, w * t);
      torque += at.real();
      angle += sign * (gain * at).real();
    };
    for (const double f : {0.3, 0.9, 1.9}) add(driver, 1, 1, f);
    for (const double f : {0.5, 1.4, 3.1}) add(motor, -1, 0.7, f);
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(driver);
    record.torque_motor_nm.push_back(motor_sign * motor);
    record.angle_rad.push_back(angle + 1e-4 * std::sin(1e4 * t * t));
  }
  return record;
}

TEST(FirstLook, DoubtsAChannelWithTheWrongSignAndNoOther) {
  EXPECT_EQ(first_look(two_torques(1), {}).doubt, "");
  const std::string doubt = first_look(two_torques(-1), {}).doubt;
  EXPECT_NE(doubt.find("torque_motor seems to have the wrong sign"), std::string::npos) << doubt;
  EXPECT_NE(doubt.find("--sign torque_motor=-1"), std::string::npos) << doubt;
}

/// A bar of a column whose arm follows the motor: it reads the arm's own torque, or nothing at all.
TEST(FirstLook, DoubtsATransducerThatStandsStillWhileTheWheelMoves) {
  Record record = two_torques(1);
  record.torque_bar_nm = record.torque_driver_nm;
  record.channels = kAngleValid | kTorqueMotorValid | kTorqueBarValid;
  EXPECT_EQ(first_look(record, {}).doubt, "");
  for (const double reading_nm : {0.0, -1.25}) {
    std::ranges::fill(record.torque_bar_nm, reading_nm);
    const std::string doubt = first_look(record, {}).doubt;
    EXPECT_NE(doubt.find(fmt::format("torque_bar is {:g} Nm in every row", reading_nm)), std::string::npos) << doubt;
  }
  std::ranges::fill(record.angle_rad, 0.1);  // nobody touches the wheel
  EXPECT_EQ(first_look(record, {}).doubt, "");
  record.torque_bar_nm.back() += 1e-3;  // one count
  EXPECT_EQ(first_look(record, {}).doubt, "");
}

TEST(Trace, TimeGoesOnInAFault) {
  Record record;
  for (int k = 0; k < 300; ++k) {
    if (k >= 200 && k < 250) continue;  // lost
    const double phase = 0.2 * k;
    record.time_s.push_back(7.0 + 0.01 * k);
    record.torque_driver_nm.push_back(std::sin(phase));
    record.torque_motor_nm.push_back(k >= 100 && k < 150 ? 1e4 : 0.0);  // beyond what any motor can
    record.angle_rad.push_back(0.05 * std::sin(phase - 1));
  }
  const FirmwareRun run = run_firmware(record, Scalar::kFloat, {});
  ASSERT_EQ(run.estimates.size(), 300U);
  ASSERT_EQ(run.time_s.size(), 300U);
  EXPECT_EQ(run.estimates[140].stiffness.state, ParameterState::kFault);
  EXPECT_EQ(run.estimates[240].stiffness.state, ParameterState::kFault);
  for (std::size_t k = 0; k < 300; ++k) EXPECT_NEAR(run.time_s[k], 7.0 + 0.01 * static_cast<double>(k), 1e-9);
}

TEST(Trace, OneRowAnEstimate) {
  Estimate estimate;
  estimate.stamp_us = 1'250'000;  // since when it is faulty
  estimate.inertia = {110'000, 250, ParameterState::kValid};
  estimate.damping = {1'500'000, std::numeric_limits<std::int32_t>::max(), ParameterState::kNotExcited};
  estimate.stiffness = {22'700'000, 10'000, ParameterState::kHolding};
  estimate.driver = DriverState::kBraced;
  estimate.hands = HandCount::kTwo;
  const auto path = std::filesystem::path(::testing::TempDir()) / "steerid_trace_test.csv";
  write_trace(path, {{estimate}, {1.5}, {}});

  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_EQ(text.str(),
            "time_s,inertia_kgm2,inertia_sd_kgm2,inertia_state,damping_nms_per_rad,damping_sd_nms_per_rad,"
            "damping_state,stiffness_nm_per_rad,stiffness_sd_nm_per_rad,stiffness_state,driver_state,hands,"
            "inertia_low_kgm2,inertia_high_kgm2,damping_low_nms_per_rad,damping_high_nms_per_rad,"
            "stiffness_low_nm_per_rad,stiffness_high_nm_per_rad\n"
            "1.500000,0.110000,0.000250,valid,1.500000,,not excited,22.700000,0.010000,holding,braced,two,"
            "0.109510,0.110490,,,22.680400,22.719600\n");  // 1.96 deviations to either side
  std::filesystem::remove(path);
}

FirmwareRun told(const PortUnits& units) {
  FirmwareRun run{{}, {}, units};
  for (int i = 0; i < 400; ++i) {
    Estimate estimate;
    estimate.driver = i < 100 ? DriverState::kUnknown : (i < 300 ? DriverState::kBraced : DriverState::kHandsOff);
    estimate.hands = i < 200 ? HandCount::kUnknown : (i < 300 ? HandCount::kTwo : HandCount::kNone);
    run.estimates.push_back(estimate);
    run.time_s.push_back(5 + 0.01 * i);
  }
  return run;
}

TEST(DriverTimeline, HoldsEverySpanOnceWithoutAHole) {
  const DriverTimeline timeline = driver_timeline(told({}), {});
  const auto& spans = timeline.spans;
  ASSERT_EQ(spans.size(), 4U);
  EXPECT_DOUBLE_EQ(spans.front().from_s, 5);
  for (std::size_t i = 1; i < spans.size(); ++i) EXPECT_EQ(spans[i].from_s, spans[i - 1].to_s);
  EXPECT_NEAR(spans[2].from_s, 7, 1e-9);
  EXPECT_NEAR(spans.back().to_s, 8.99, 1e-9);
  const auto json = driver_json(timeline);
  EXPECT_EQ(json.at("state"), "hands_off");
  EXPECT_EQ(json.at("hands"), "none");
  EXPECT_EQ(json.at("timeline").at(2).at("hands"), "two");
  const std::string text = driver_lines(timeline);
  EXPECT_NE(text.find("hands_off 24.8 %, braced 50.1 %, unknown 25.1 %"), std::string::npos) << text;
  EXPECT_NE(text.find("7.0 to 8.0 s      braced, hands: two"), std::string::npos) << text;
}

TEST(DriverTimeline, TellsNothingOfAMachineThatIsNoSteeringWheel) {
  const DriverTimeline timeline = driver_timeline(told({.torque_nm = 1000, .angle_rad = 1}), {});
  EXPECT_TRUE(timeline.spans.empty());
  EXPECT_TRUE(driver_json(timeline).at("state").is_null());
  EXPECT_EQ(driver_json(timeline).at("reason"), "this is no steering wheel");
  EXPECT_EQ(driver_lines(timeline), "nothing is told of a driver: this is no steering wheel\n");
}

Identification of_inertia(double value, double sd, Equation equation = Equation::kDriverMotor) {
  Identification found;
  found.equation = equation;
  found.inertia_kgm2 = {value, sd, ParameterState::kValid};
  return found;
}

// Production wheels have 0.02 to 0.05 kg m2, and an arm comes on top of it; the lightest arm alone has 0.02.
TEST(DriverTimeline, TellsNothingOfWhatIsLighterThanAnyWheelBeyondItsInterval) {
  EXPECT_NE(driver_timeline(told({}), of_inertia(0.012, 0.001)).none_since.find("J of 0.012 kg m2 is less than"),
            std::string::npos);
  EXPECT_TRUE(driver_timeline(told({}), of_inertia(0.012, 0.005)).none_since.empty());
  EXPECT_TRUE(driver_timeline(told({}), of_inertia(0.02, 0.0001)).none_since.empty());
  EXPECT_TRUE(driver_timeline(told({}), of_inertia(0.012, 0.001, Equation::kRim)).none_since.empty());
  EXPECT_FALSE(driver_timeline(told({}), of_inertia(0.007, 0.001, Equation::kRim)).none_since.empty());
  Identification unknown = of_inertia(0.012, 0.001);
  unknown.inertia_kgm2.state = ParameterState::kConverging;
  EXPECT_TRUE(driver_timeline(told({}), unknown).none_since.empty());
}

TEST(DriverTimeline, TellsNothingOfARecordInDoubtOrOfOneThatNeverToldAnything) {
  Identification doubted;
  doubted.doubt = "the torques are written the wrong way round";
  EXPECT_EQ(driver_timeline(told({}), doubted).none_since, "the record is in doubt");
  FirmwareRun run = told({});
  forget_driver(run);
  const DriverTimeline timeline = driver_timeline(run, {});
  EXPECT_TRUE(timeline.spans.empty());
  EXPECT_FALSE(driver_json(timeline).contains("timeline"));
  EXPECT_NE(driver_lines(timeline).find("at no time was C valid"), std::string::npos);
  run.estimates[3].stiffness.state = ParameterState::kValid;
  EXPECT_NE(driver_timeline(run, {}).none_since.find("tell for long enough who holds the wheel"), std::string::npos);
  run.estimates[7].hands = HandCount::kTwo;
  EXPECT_EQ(driver_timeline(run, {}).spans.size(), 3U);
}

TEST(Credibility, AWeakProbeIsNotSaidToShowNothingThatTheWholeRecordShows) {
  const auto reason = [](const Evidence& evidence) {
    return credibility_lines(credibility("log.csv", Equation::kBar, {}, evidence));
  };
  Evidence evidence;
  evidence.probe = ProbeMisfit{.driven_nats = 50, .nats = -1, .share = 0.02, .share_by_noise = 0.02};
  EXPECT_NE(reason(evidence).find("too weak"), std::string::npos);
  EXPECT_EQ(reason(evidence).find("--batch"), std::string::npos);
  evidence.record_tells = true;
  EXPECT_NE(reason(evidence).find("the whole of it does (--batch)"), std::string::npos);
  evidence.anything_valid = true;
  EXPECT_EQ(reason(evidence).find("too weak"), std::string::npos);
  // e^0 times is no likelihood ratio that anybody reads.
  evidence.probe->nats = 0.3;
  EXPECT_NE(reason(evidence).find("answers it (hardly likelier than not)"), std::string::npos);
  evidence.probe->nats = 5.2;
  EXPECT_NE(reason(evidence).find("answers it (e^5 times likelier)"), std::string::npos);
}

}  // namespace
}  // namespace steerid
