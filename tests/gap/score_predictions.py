# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Scores predictions of withheld records, one effect missing, against their key.

usage: score_predictions.py PREDICTIONS.json KEY.json [--expect NAME=VALUE ...]

PREDICTIONS.json is made by collect_predictions.py. KEY.json is a path, or one within ../shared or the folder that
STEERID_DATA names; where it is missing the program says so and ends with 77, which ctest counts as skipped. Prints
    right              verdicts that are the label, of `records`
    false_alarms       effects named where the label is none or parameters
    unknown_right      records with an effect outside the vocabulary that are called unknown
    mean_probability   of the label
    brier              sum over verdicts of (probability - 1 for the label, else 0)^2, mean over records (Brier 1950)
With --expect ends with 1 unless every figure, rounded to the digits of its VALUE, is VALUE.
"""

import argparse
import json
import os
import pathlib
import sys

NO_EFFECT = ("none", "parameters")
SKIPPED = 77


def score(predictions, key):
    """The figures above, by name."""
    figures = {"records": len(key), "right": 0, "false_alarms": 0, "unknown_right": 0}
    probability = brier = 0.0
    for name, case in key.items():
        label, verdict = case["label"], predictions[name]["verdict"]
        ranking = {entry["effect"]: entry["probability"] for entry in predictions[name]["ranking"]}
        figures["right"] += verdict == label
        figures["false_alarms"] += label in NO_EFFECT and verdict not in (*NO_EFFECT, "unknown")
        figures["unknown_right"] += label == verdict == "unknown"
        probability += ranking.get(label, 0.0)
        brier += sum((p - (effect == label)) ** 2 for effect, p in ranking.items())
    figures["mean_probability"] = probability / len(key)
    figures["brier"] = brier / len(key)
    return figures


def found(path):
    """`path`, or `path` within the folder of measured records; None where there is none."""
    shared = pathlib.Path(__file__).resolve().parents[2].parent / "shared"
    for folder in (pathlib.Path(), pathlib.Path(os.environ.get("STEERID_DATA", shared))):
        if (folder / path).is_file():
            return folder / path
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("predictions", type=pathlib.Path)
    parser.add_argument("key")
    parser.add_argument("--expect", nargs="*", default=[], metavar="NAME=VALUE")
    options = parser.parse_args()
    key = found(options.key)
    if key is None:
        print(f"SKIPPED: no {options.key} in ../shared; set STEERID_DATA to the folder that holds it")
        return SKIPPED
    figures = score(json.loads(options.predictions.read_text()), json.loads(key.read_text()))
    wrong = False
    for name, value in figures.items():
        print(f"{name} {value:.6g}")
    for name, expected in (entry.split("=") for entry in options.expect):
        digits = len(expected.partition(".")[2])
        if round(figures[name], digits) != float(expected):
            print(f"{name} is {figures[name]:.6g}; the documents say {expected}")
            wrong = True
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
