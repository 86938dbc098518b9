#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Takes the licence from one file at a time and asks that it is missed there, and there alone."""

import pathlib
import tempfile
import unittest

from licence import head, lacks, licensed, sources

TREE = {
    "CMakeLists.txt": "project(x)\n",
    "run.sh": "#!/usr/bin/env bash\necho\n",
    "firmware/base/status.hpp": "// The manual.\n#include <cstdint>\n",
    "host_sim/report/page/src/style.css": "a {}\n",
    "host_sim/report/page/src/template.html": "<!doctype html>\n<html></html>\n",
    "hal/mps2_an386/link.ld": "MEMORY {}\n",
}
NO_SOURCE = {"README.md": "x\n", "tests/fixture.json": "{}\n", "host_sim/report/page/node_modules/x.ts": "x\n"}


class Licences(unittest.TestCase):
    def missed(self, without):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path, text in (TREE | NO_SOURCE).items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text, encoding="utf-8")
            for path, comment in sources(root):
                if str(path.relative_to(root)) not in without:
                    path.write_text(licensed(path.read_text(encoding="utf-8"), comment), encoding="utf-8")
            return [str(p.relative_to(root)) for p, c in sources(root) if lacks(p.read_text(encoding="utf-8"), c)]

    def test_a_licensed_tree_lacks_nothing(self):
        self.assertEqual(self.missed([]), [])

    def test_each_file_is_missed_alone(self):
        for path in TREE:
            self.assertEqual(self.missed([path]), [path])

    def test_the_line_that_has_to_be_first_stays_first(self):
        text = licensed(TREE["run.sh"], ("# ", ""))
        self.assertTrue(text.startswith("#!/usr/bin/env bash\n# SPDX-FileCopyrightText: "))
        self.assertTrue(text.endswith("\n\necho\n"))

    def test_the_manual_stands_apart(self):
        comment = ("// ", "")
        self.assertTrue(lacks(head(comment) + "// The manual.\n", comment))
        self.assertFalse(lacks(head(comment) + "\n// The manual.\n", comment))


if __name__ == "__main__":
    unittest.main()
