// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the command says of itself: help, manual page, completion and the files to begin with.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "plant/effects/vocabulary.hpp"
#include "support/steerid_command.hpp"

namespace steerid {
namespace {

class Manual : public test::SteeridCommand {};

TEST_F(Manual, HelpOfACommandIsThatCommandsHelp) {
  EXPECT_EQ(run("help identify").out, run("identify --help").out);
  EXPECT_EQ(run("help study blind draw").out, run("study blind draw --help").out);
  EXPECT_EQ(run("help").out, run("--help").out);
  EXPECT_EQ(run("help identfy").exit_code, 2);
}

TEST_F(Manual, ThePageHasEveryCommandAndOption) {
  const Ended page = run("manual");
  ASSERT_EQ(page.exit_code, 0);
  for (const char* words : {".SH steerid identify", ".SH steerid study blind draw", "\\-\\-torque\\-offset",
                            "passive|active|probe|drive", "\\-\\-no\\-report", ".SH EXIT STATUS"}) {
    EXPECT_NE(page.out.find(words), std::string::npos) << words;
  }
}

TEST_F(Manual, BashCompletesCommandsOptionsAndWords) {
  ASSERT_EQ(run("completion --out steerid.bash").exit_code, 0);
  const auto completed = [&](const std::string& words) {
    write("ask.sh", "source ./steerid.bash\nCOMP_WORDS=(" + words +
                        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_steerid\necho \"${COMPREPLY[*]}\"\n");
    const std::string line = "cd '" + folder().string() + "' && bash ask.sh >asked 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c): our own words
    return read("asked");
  };
  EXPECT_EQ(completed("steerid identi"), "identify\n");
  EXPECT_EQ(completed("steerid identify --torque"), "--torque-offset\n");
  EXPECT_EQ(completed("steerid identify --scalar fi"), "fixed\n");
  EXPECT_EQ(completed("steerid study blind dr"), "draw\n");
  EXPECT_EQ(completed("steerid simulate --task p"), "passive probe\n");
  EXPECT_EQ(completed("steerid identify --json steerid.b"), "steerid.bash\n");
}

TEST_F(Manual, ATemplateIsTakenAsItStands) {
  ASSERT_EQ(run("template sim --out sim.json").exit_code, 0);
  ASSERT_EQ(run("template column --out column.json").exit_code, 0);
  EXPECT_EQ(run("simulate --task probe --duration 5 --sim sim.json --out a.csv").exit_code, 0) << read("err");
  EXPECT_EQ(run("simulate --task drive --duration 5 --column column.json --out b.csv").exit_code, 0) << read("err");
  EXPECT_NE(run("template daemon").out.find("\"can\": \"can0\""), std::string::npos);
  EXPECT_EQ(run("template wheel").exit_code, 2);
}

/// What a template offers in comments is taken, too: each effect alone, with the parameters shown.
TEST_F(Manual, EveryEffectOfTheTemplateIsTaken) {
  const std::string text = run("template sim").out;
  for (const EffectType* type : effects()) {
    const std::size_t at = text.find("// {\"effect\":\"" + std::string(type->id) + "\"");
    ASSERT_NE(at, std::string::npos) << type->id;
    const std::string effect = text.substr(at + 3, text.find('\n', at) - at - 3);
    write("sim.json",
          R"({"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7,"effects":[)" + effect + "]}");
    EXPECT_EQ(run("simulate --task probe --duration 2 --sim sim.json --out a.csv").exit_code, 0) << read("err");
    for (const Parameter& parameter : type->parameters) {
      EXPECT_NE(text.find("//   " + std::string(parameter.name)), std::string::npos) << parameter.name;
    }
  }
}

}  // namespace
}  // namespace steerid
