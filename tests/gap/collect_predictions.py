# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Collects the answers of `steerid diagnose --batch` into one file: {"case000": {"verdict": .., "ranking": [..]}, ..}.

usage: collect_predictions.py DIR_OF_ANSWERS OUT.json [sets]

With `sets` the changes, what remains, every effect's probability and the program are collected as well: what an answer
says of a simulation that has effects. Curves and evidence for the page are left out.
"""

import json
import pathlib
import sys


SINGLE = ["verdict", "ranking"]
SETS = ["schema", *SINGLE, "causes", "unexplained", "inclusion", "gap", "base", "notes", "program"]


def main(answers, out, kind="single"):
    cases = {}
    for found in sorted(pathlib.Path(answers).glob("*/diagnosis.json")):
        diagnosis = json.loads(found.read_text())
        cases[found.parent.name] = {key: diagnosis[key] for key in (SETS if kind == "sets" else SINGLE)}
    rows = [f"{json.dumps(name)}: {json.dumps(case)}" for name, case in cases.items()]  # one line a record
    pathlib.Path(out).write_text("{\n" + ",\n".join(rows) + "\n}\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
