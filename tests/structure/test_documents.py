#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The check of documents finds planted breaches and lets sound documents be."""

import pathlib
import tempfile
import unittest

from documents import breaches


class Documents(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)
        self.write("docs/adr/0007-a-decision.md", "# 7. A decision\n\n## What `it` costs, and more\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def test_sound_documents_pass(self):
        self.write("docs/a.md", "[x](adr/0007-a-decision.md#what-it-costs-and-more) [y](#top) [z](https://example.org)\n# Top\n")
        self.write("firmware/x.hpp", "// docs/adr/0007 says why.\n")
        self.assertEqual(breaches(self.root), [])

    def test_what_looks_like_a_link_in_code_is_none(self):
        self.write("docs/a.md", "`[options](none)`\n\n```\n[at](none)\n```\n")
        self.assertEqual(breaches(self.root), [])

    def test_a_link_to_a_file_that_is_not_there_is_found(self):
        self.write("docs/a.md", "\n[x](adr/0008-none.md)\n")
        self.assertEqual(breaches(self.root), ["docs/a.md:2: there is no adr/0008-none.md"])

    def test_a_link_over_two_lines_is_found(self):
        self.write("docs/a.md", "[two\nlines](none.md)\n")
        self.assertEqual(breaches(self.root), ["docs/a.md:1: there is no none.md"])

    def test_a_heading_that_is_not_there_is_found(self):
        self.write("docs/a.md", "[x](adr/0007-a-decision.md#costs)\n")
        self.assertEqual(breaches(self.root), ["docs/a.md:1: 0007-a-decision.md has no heading #costs"])

    def test_a_comment_that_cites_no_decision_is_found(self):
        self.write("firmware/x.hpp", "// docs/adr/0009-gone.md\n")
        self.assertEqual(breaches(self.root), ["firmware/x.hpp:1: there is no decision 0009-gone.md"])


if __name__ == "__main__":
    unittest.main()
