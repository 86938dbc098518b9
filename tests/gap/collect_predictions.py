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
    pathlib.Path(out).write_text(json.dumps(cases, indent=1) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
