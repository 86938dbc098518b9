#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""What the command says at the end of each drive of a whole steering, as JSON, for drives whose truth is withheld.

    scripts/eps_predictions.py build/steerid FOLDER_OF_DRIVES > predictions.json

{"drive00": {"inertia_kgm2": {"value": .., "sd": .., "state": "valid", "valid_share": ..}, ...}, ...}: value, standard
deviation and state are those of the last tick, `valid_share` is of the ticks after 5 s.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

from eps_table import FROM_S, NAMES, columns_of, rows


def predict(steerid, log):
    with tempfile.TemporaryDirectory() as temporary:
        trace_file = pathlib.Path(temporary) / "trace.csv"
        subprocess.run(
            [steerid, "identify", str(log), "--trace", str(trace_file), "--quiet"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        trace = rows(trace_file)
    told = {}
    for name in NAMES:
        value, deviation, state = columns_of(trace[-1], name)
        states = [columns_of(row, name)[2] for row in trace if float(row["time_s"]) >= FROM_S]
        told[name] = {
            "value": value,
            "sd": deviation,
            "state": state,
            "valid_share": round(states.count("valid") / len(states), 4),
        }
    return told


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folders = sorted(log.parent for log in pathlib.Path(sys.argv[2]).glob("*/log.csv"))
    json.dump({folder.name: predict(sys.argv[1], folder / "log.csv") for folder in folders}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
