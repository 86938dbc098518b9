#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The check of the table of constants finds what is missing, left over or different on either side."""

import pathlib
import tempfile
import unittest

from thresholds import breaches, constants

CODE = """// constexpr double kInAComment = 1;
namespace steerid {
/* constexpr double kInAnother = 1;
   over two lines */
inline constexpr double kShare = 0.022;  // of the applied torque
void f(double y = kShare) {
  constexpr std::array kBands_hz = {
      0.1,  // slow
      1.0};
  static constexpr int kRounds{4};
  const Roles kSeen = {Role::kFit, Role::kChoose};
  const bool same = kShare == y;
  constexpr char kMark[] = "a; // b";
}
}
"""
TABLE = """# Constants

| constant | value | unit | what it decides | source |
| --- | --- | --- | --- | --- |
| `kShare` (`a/x.cpp`) | `0.022` | share | a | b |
| `kBands_hz` (`a/x.cpp`) | `{ 0.1, 1.0}` | Hz | a | b |
| `kRounds` (`a/x.cpp`) | `{4}` | rounds | a | b |
| `kSeen` (`a/x.cpp`) | `{Role::kFit, Role::kChoose}` | parts | a | b |
| `kMark` (`a/x.cpp`) | `"a; // b"` | text | a | b |
"""


class Thresholds(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)
        self.write(CODE, TABLE)

    def write(self, code, table):
        for name, text in (("host_sim/gap/a/x.cpp", code), ("docs/thresholds.md", table)):
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")

    def test_what_agrees_passes(self):
        self.assertEqual(breaches(self.root), [])
        self.assertEqual([one.name for one in constants(self.root)], ["kShare", "kBands_hz", "kRounds", "kSeen", "kMark"])

    def test_a_constant_without_a_row_is_found(self):
        self.write(CODE, TABLE.replace("| `kRounds` (`a/x.cpp`) | `{4}` | rounds | a | b |\n", ""))
        self.assertEqual(breaches(self.root), ["host_sim/gap/a/x.cpp:10: kRounds is missing in docs/thresholds.md"])

    def test_a_row_without_a_constant_is_found(self):
        self.write(CODE.replace("kRounds", "kTurns"), TABLE)
        self.assertEqual(breaches(self.root), ["host_sim/gap/a/x.cpp:10: kTurns is missing in docs/thresholds.md",
                                               "docs/thresholds.md:7: there is no kRounds in host_sim/gap/a/x.cpp"])

    def test_a_row_of_another_file_is_none(self):
        self.write(CODE, TABLE.replace("`kShare` (`a/x.cpp`)", "`kShare` (`a/y.cpp`)"))
        self.assertEqual(breaches(self.root), ["host_sim/gap/a/x.cpp:5: kShare is missing in docs/thresholds.md",
                                               "docs/thresholds.md:5: there is no kShare in host_sim/gap/a/y.cpp"])

    def test_another_value_is_found_on_either_side(self):
        expected = "docs/thresholds.md:5: kShare is {}; in the code it is {}"
        self.write(CODE.replace("0.022", "0.03"), TABLE)
        self.assertEqual(breaches(self.root), [expected.format("0.022", "0.03")])
        self.write(CODE, TABLE.replace("`0.022`", "`0.03`"))
        self.assertEqual(breaches(self.root), [expected.format("0.03", "0.022")])

    def test_a_name_may_stand_in_a_file_twice(self):
        self.write(CODE + "constexpr double kShare = 0.5;\n", TABLE)
        self.assertEqual(breaches(self.root), ["host_sim/gap/a/x.cpp:16: kShare is missing in docs/thresholds.md"])
        self.write(CODE + "constexpr double kShare = 0.5;\n", TABLE + "| `kShare` (`a/x.cpp`) | `0.5` | share | a | b |\n")
        self.assertEqual(breaches(self.root), [])

    def test_a_row_with_an_empty_cell_is_found(self):
        self.write(CODE, TABLE.replace("| share | a | b |", "| share | a |  |"))
        self.assertIn("docs/thresholds.md:5: a row is | `kName` (`file`) | value | unit | what it decides | source |",
                      breaches(self.root))

    def test_only_what_a_script_writes_may_be_a_link(self):
        linked = TABLE.replace("`0.022`", "[calibrated](results/a.md)")
        self.write(CODE, linked)
        self.assertEqual(breaches(self.root), ["docs/thresholds.md:5: kShare is a link; in the code it is 0.022"])
        self.write("// Written by scripts/a.py\nconstexpr double kShare = 1;\n", "\n".join(linked.splitlines()[:5]))
        self.assertEqual(breaches(self.root), [])
        self.write("// Written by scripts/a.py\nconstexpr double kShare = 1;\n", "\n".join(TABLE.splitlines()[:5]))
        self.assertEqual(breaches(self.root), [
            "docs/thresholds.md:5: kShare is 0.022; in the code it is what a script writes, and its row a link"])


if __name__ == "__main__":
    unittest.main()
