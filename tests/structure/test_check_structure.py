#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Plants one breach at a time in a small tree and asks that it, and it alone, is found."""

import pathlib
import tempfile
import unittest

from check_structure import breaches

CLEAN = {
    "firmware/CMakeLists.txt": "steerid_library(base ROOT firmware)\n"
    "steerid_library(identifier ROOT firmware USES steerid_base Eigen3::Eigen)\n"
    "steerid_library(port ROOT firmware USES steerid_base)\n",
    "firmware/base/status.hpp": "#include <cstdint>\n",
    "firmware/identifier/core.hpp": '#include <Eigen/Core>\n#include <array>\n\n#include "base/status.hpp"\n'
    "struct Core { Core(const Core&) = delete; };  // a new core takes no std::vector\n",
    "firmware/port/port.hpp": '#include "base/status.hpp"\n',
    "hal/CMakeLists.txt": "steerid_library(link ROOT hal USES steerid_base steerid_port)\n",
    "hal/link/frame.hpp": '#include "port/port.hpp"\n',
    "host_sim/CMakeLists.txt": "steerid_library(plant ROOT host_sim)\n"
    "steerid_library(log ROOT host_sim)\n"
    "steerid_library(fit ROOT host_sim USES steerid_plant steerid_log fmt::fmt)\n",
    "host_sim/plant/wheel.hpp": "#include <vector>\n",
    "host_sim/log/record.hpp": "#include <unistd.h>\n#include <sys/stat.h>\n#include <iostream>\n",
    "host_sim/fit/fit.cpp": '#include <fmt/format.h>\n#include "fit/fit.hpp"\n#include "plant/wheel.hpp"\n',
    "host_sim/fit/fit.hpp": '#include "log/record.hpp"\n',
    "host_sim/gap/CMakeLists.txt": "steerid_library(gap ROOT host_sim USES steerid_plant)\n",
    "host_sim/gap/likelihood/whittle.hpp": '#include "gap/likelihood/floor.hpp"\n#include "plant/wheel.hpp"\n',
    "host_sim/gap/model/model.cpp": '#include "gap/likelihood/whittle.hpp"\n',
}


class PlantedBreaches(unittest.TestCase):
    def found(self, name=None, text=""):
        tree = CLEAN | ({name: text} if name else {})
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path, content in tree.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(content, encoding="utf-8")
            return breaches(root)

    def assert_only(self, expected, name, text):
        found = self.found(name, text)
        self.assertEqual(len(found), 1, found)
        self.assertIn(expected, found[0])

    def test_the_clean_tree_has_none(self):
        self.assertEqual(self.found(), [])

    def test_identifier_sees_no_port(self):
        found = self.found("firmware/identifier/core.hpp", '\n  # include "port/port.hpp"\n')
        self.assertIn("firmware/identifier/core.hpp:2: firmware/identifier must not see firmware/port", found)

    def test_plant_sees_no_identifier(self):
        found = self.found("host_sim/plant/wheel.hpp", '#include "identifier/core.hpp"\n')
        self.assertIn("host_sim/plant/wheel.hpp:1: host_sim/plant must not see firmware/identifier", found)

    def test_flashed_code_uses_no_heap_stream_clock_or_libm(self):
        for header in ("iostream", "vector", "string", "chrono", "map", "functional", "cmath", "thread",
                       "math.h", "stdlib.h", "new", "unistd.h"):
            self.assert_only(f"core.hpp:1: firmware/identifier is flashed and must not use <{header}>",
                             "firmware/identifier/core.hpp", f"#include <{header}>\n")

    def test_flashed_code_does_not_allocate_throw_or_dispatch(self):
        for code in ("int* p = new int;", "void f(int* p) { delete p; }", "void* p = malloc(4);", "throw 1;",
                     "struct S { virtual void f(); };", "std::unique_ptr<int> p;", "double y = std::sqrt(x);"):
            self.assert_only("core.hpp:1: ", "firmware/identifier/core.hpp", code + "\n")

    def test_words_in_comments_and_strings_are_no_code(self):
        text = '// throw it away\n/* new\n   delete */\nconst char* s = "malloc(";\n'
        self.assertEqual(self.found("firmware/identifier/core.hpp", text), [])

    def test_foreign_libraries_stay_where_they_belong(self):
        self.assert_only("wheel.hpp:1: host_sim/plant must not use <CLI/CLI.hpp>",
                         "host_sim/plant/wheel.hpp", "#include <CLI/CLI.hpp>\n")

    def test_links_follow_the_table(self):
        text = CLEAN["hal/CMakeLists.txt"].replace("steerid_base", "steerid_base\n  steerid::plant")
        self.assert_only("hal/CMakeLists.txt:1: hal/link must not link steerid_plant", "hal/CMakeLists.txt", text)

    def test_an_include_needs_its_link(self):
        text = CLEAN["host_sim/CMakeLists.txt"].replace("steerid_plant steerid_log", "steerid_log")
        self.assert_only("fit.cpp:3: host_sim/fit does not link steerid_plant", "host_sim/CMakeLists.txt", text)

    def test_rooms_of_a_folder_follow_their_table(self):
        self.assert_only("whittle.hpp:1: host_sim/gap/likelihood must not see host_sim/gap/model",
                         "host_sim/gap/likelihood/whittle.hpp", '#include "gap/model/model.hpp"\n')
        self.assert_only("gap/hall/hall.hpp:1: hall is no room of host_sim/gap", "host_sim/gap/hall/hall.hpp", "\n")
        self.assert_only("gap/hall.hpp:1: hall.hpp is no room of host_sim/gap", "host_sim/gap/hall.hpp", "\n")

    def test_a_folder_without_a_rule_is_a_breach(self):
        self.assert_only("firmware/radio is not in the table", "firmware/radio/radio.hpp", "\n")


if __name__ == "__main__":
    unittest.main()
