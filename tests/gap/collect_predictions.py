# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Collects the answers of `steerid diagnose --batch` into one file: {"case000": {"verdict": .., "ranking": [..]}, ..}.

usage: collect_predictions.py DIR_OF_ANSWERS OUT.json
"""

import json
import pathlib
import sys


def main(answers, out):
    cases = {}
    for found in sorted(pathlib.Path(answers).glob("*/diagnosis.json")):
        diagnosis = json.loads(found.read_text())
        cases[found.parent.name] = {"verdict": diagnosis["verdict"], "ranking": diagnosis["ranking"]}
    rows = [f"{json.dumps(name)}: {json.dumps(case)}" for name, case in cases.items()]  # one line a record
    pathlib.Path(out).write_text("{\n" + ",\n".join(rows) + "\n}\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
