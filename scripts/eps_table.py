#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The labelled drives of a whole steering, identified by the command and held against their truth: a Markdown table.

    scripts/eps_table.py build/steerid ../shared/eps/dev

A row a drive: for J, B and C the share of the ticks after 5 s that is valid and within 15 %, and the share that is valid
and wrong (farther from the truth than 1.96 standard deviations and than a tenth of it; of a wheel without hands a tenth
of 0.02 kg m2, 0.1 Nms/rad, 2 Nm/rad), in percent; the longest wrong stretch of the three in seconds.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

KINDS = ["stays", "C changes", "there and back", "C swings", "hands leave"]
TRUTH = {"inertia_kgm2": "J", "damping_nms_per_rad": "B", "stiffness_nm_per_rad": "C"}
# What is small for a driver.
NAMES = {"inertia_kgm2": 0.02, "damping_nms_per_rad": 0.1, "stiffness_nm_per_rad": 2.0}
FROM_S = 5.0


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def columns_of(trace_row, name):
    """Value, deviation and state of a parameter: quantity_unit, quantity_sd_unit, quantity_state."""
    quantity, unit = name.split("_", 1)
    return (
        float(trace_row[name]),
        float(trace_row[f"{quantity}_sd_{unit}"]),
        trace_row[f"{quantity}_state"],
    )


def score(steerid, folder):
    with tempfile.TemporaryDirectory() as temporary:
        trace_file = pathlib.Path(temporary) / "trace.csv"
        subprocess.run(
            [steerid, "identify", str(folder / "log.csv"), "--trace", str(trace_file), "--quiet"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        trace = rows(trace_file)
    truth = rows(folder / "truth.csv")
    counts = {name: [0, 0, 0] for name in NAMES}  # close, wrong, ticks
    run = {name: 0 for name in NAMES}
    longest = 0
    at = 0
    for row in trace:
        time_s = float(row["time_s"])
        while at + 1 < len(truth) and float(truth[at + 1]["time_s"]) <= time_s + 0.005:
            at += 1
        if time_s < FROM_S:
            continue
        for name, small in NAMES.items():
            value, deviation, state = columns_of(row, name)
            true = float(truth[at][TRUTH[name]])
            error = abs(value - true)
            scale = max(true, small)
            close = state == "valid" and error <= 0.15 * scale
            wrong = state == "valid" and error > 1.96 * deviation and error > 0.1 * scale
            counts[name][0] += close
            counts[name][1] += wrong
            counts[name][2] += 1
            run[name] = run[name] + 1 if wrong else 0
            longest = max(longest, run[name])
    return counts, longest * 0.01


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    steerid, dev = sys.argv[1], pathlib.Path(sys.argv[2])
    with open(dev / "key.json", encoding="utf-8") as file:
        key = json.load(file)
    print("| drive | arm | Tv, Nm rms | probe, Nm rms | J | B | C | wrong: J, B, C | longest |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, drawn in sorted(key.items()):
        counts, longest = score(steerid, dev / name)
        share = [[100 * count[i] / count[2] for count in counts.values()] for i in (0, 1)]
        print(
            f"| {name[-2:]} | {KINDS[drawn['kind']]} | {drawn['Ca'] * drawn['intent']:.1f} | {drawn['probe']:g} | "
            + " | ".join(f"{percent:.0f}" for percent in share[0])
            + " | "
            + ", ".join(f"{percent:.1f}" for percent in share[1])
            + f" % | {longest:.1f} s |"
        )


if __name__ == "__main__":
    main()
