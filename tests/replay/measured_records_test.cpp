// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Published records of real machines through the whole of `steerid identify`: reader, resampling, the firmware's loop.
// Limits: the published figure and what dry friction, which the model lacks, can do to it (docs/real_records.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "apps/driver_timeline.hpp"
#include "apps/first_look.hpp"
#include "apps/identification.hpp"
#include "log/log_reader.hpp"
#include "log/resample.hpp"
#include "support/shared_data.hpp"

namespace steerid {
namespace {

struct Found {
  IdentifiedParameter inertia, damping, stiffness;
  FirstLook look;
  DriverTimeline driver;
};

Found found_in(const std::filesystem::path& path, const char* columns, const char* sign) {
  LogFormat format;
  if (*columns != '\0') format.columns = parse_columns(columns);
  if (*sign != '\0') format.reversed = parse_sign(sign);
  const Record record = resample_100hz(read_log(path, format)).record;
  const FirstLook look = first_look(record, {});
  const FirmwareRun run = run_firmware(record, Scalar::kFloat, look.units);
  const Estimate& last = run.estimates.back();
  const double unit = run.units.parameter();
  Identification found;
  found.equation = record.equation();
  found.doubt = look.doubt;
  found.inertia_kgm2 = from_published(last.inertia, unit);
  return {found.inertia_kgm2, from_published(last.damping, unit), from_published(last.stiffness, unit), look,
          driver_timeline(run, found)};
}

TEST(MeasuredRecords, LinearDriveShowsItsMassAndNoConfidentSpring) {
  STEERID_SHARED_OR_SKIP(path, "data/emps.csv");
  const Found found = found_in(path, "torque_motor=force_n,angle=position_m", "torque_motor");
  EXPECT_EQ(found.inertia.state, ParameterState::kValid);
  // Four of its own standard deviations of 0.8 %; friction is no noise, and looks like 1 to 3 % of mass.
  EXPECT_NEAR(found.inertia.value, 95.1089, 0.035 * 95.1089);
  // 203.5 viscous, and 65 for friction seen above 2 Hz; 208 for friction at all frequencies alike.
  EXPECT_GT(found.damping.value, 203.5);
  EXPECT_LT(found.damping.value, 203.5 + 208.0);
  // C is zero, and nothing is said of it. Friction can look like 15 N/m; behind the whitening filter, which takes out
  // the slow motion that would part a spring from friction, it looks like 104 +- 143: a deviation is of noise, and
  // friction is none.
  EXPECT_EQ(found.stiffness.state, ParameterState::kNotExcited);
  EXPECT_GT(found.stiffness.value, -15.0);
  EXPECT_LT(found.stiffness.value, 15.0 + 3.5 * found.stiffness.sd);
  EXPECT_LT(found.stiffness.sd, 150.0);
}

TEST(MeasuredRecords, HandlebarShowsItsInertia) {
  STEERID_SHARED_OR_SKIP(path, "data/handlebar_multisine.csv");
  const Found found = found_in(path, "torque_motor=motor_torque_nm", "torque_motor");
  EXPECT_EQ(found.inertia.state, ParameterState::kValid);
  // The published model has Coulomb friction beside it. To this one friction is noise, slow and fast; what it looks
  // like in phase with the acceleration is up to a tenth of the inertia.
  EXPECT_NEAR(found.inertia.value, 0.0428, 0.10 * 0.0428);
  EXPECT_GT(found.damping.value, 0.168);  // what its friction alone looks like
  EXPECT_LT(found.damping.value, 0.40);
  EXPECT_NE(found.stiffness.state, ParameterState::kValid);
  EXPECT_TRUE(found.look.notes.empty());
  EXPECT_EQ(found.look.doubt, "");
}

// None of these is a steering wheel that somebody holds, and nothing is told of a driver on any, but that nobody holds
// the handlebar, which has the inertia of a steering wheel and no spring. The ankle is missing: the recursive J of
// 0.012
// +- 0.005 kg m2 does not exclude a wheel of 0.019, and it is told to be braced.
TEST(MeasuredRecords, NothingIsToldOfADriverWhereThereIsNone) {
  struct Case {
    const char* file;
    const char* columns;
    const char* sign;
    const char* since;
  };
  for (const Case& one :
       {Case{"emps", "torque_motor=force_n,angle=position_m", "torque_motor", "no steering wheel"},
        Case{"handlebar_multisine", "torque_motor=motor_torque_nm", "torque_motor", ""},
        Case{"handlebar_multisine", "torque_motor=motor_torque_nm", "", "in doubt"},
        Case{"sydney_leg_inner", "", "", "no steering wheel"}, Case{"odrive_cogging_slow", "", "", "at no time"},
        Case{"brfd_backlash_0p25hz_30lb", "", "", "at no time"}, Case{"bam_xl330_kp400", "", "", "at no time"},
        Case{"dfki_pendulum_ddp", "", "", "at no time"}}) {
    STEERID_SHARED_OR_SKIP(path, std::string("data/") + one.file + ".csv");
    const DriverTimeline driver = found_in(path, one.columns, one.sign).driver;
    const auto held = [](const DriverSpan& span) {
      return span.state != DriverState::kUnknown && span.state != DriverState::kHandsOff;
    };
    EXPECT_TRUE(std::ranges::none_of(driver.spans, held)) << one.file;
    EXPECT_EQ(driver.spans.empty(), *one.since != '\0') << one.file;
    EXPECT_NE(driver.none_since.find(one.since), std::string::npos) << one.file << ": " << driver.none_since;
  }
}

TEST(MeasuredRecords, TorqueTheWrongWayRoundIsNoticed) {
  STEERID_SHARED_OR_SKIP(path, "data/handlebar_multisine.csv");
  const Found found = found_in(path, "torque_motor=motor_torque_nm", "");
  EXPECT_NE(found.inertia.state, ParameterState::kValid);
  EXPECT_NE(found.damping.state, ParameterState::kValid);
  EXPECT_NE(found.stiffness.state, ParameterState::kValid);
  EXPECT_NE(found.look.doubt.find("--sign torque_motor=-1"), std::string::npos) << found.look.doubt;
}

TEST(MeasuredRecords, AnkleIsAStiffLightJointHeldOffItsZero) {
  STEERID_SHARED_OR_SKIP(path, "data/ankle_perturbation.csv");
  const Found found = found_in(path, "torque_driver=torque_nm", "torque_driver");
  EXPECT_EQ(found.look.doubt, "");
  EXPECT_TRUE(found.look.torque_offset);
  EXPECT_EQ(found.stiffness.state, ParameterState::kValid);
  // The batch fit, which shares no code with the recursion, has 0.0146, 0.68 and 70; the missing reflex sets them
  // apart, J most: after 22 s the pulses show it no better than the noise, and it stays where it was then.
  EXPECT_NEAR(found.inertia.value, 0.0146, 0.25 * 0.0146);
  EXPECT_NEAR(found.damping.value, 0.677, 0.10 * 0.677);
  EXPECT_NEAR(found.stiffness.value, 70.0, 0.15 * 70.0);
}

}  // namespace
}  // namespace steerid
