#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Makes every kind of page that the command writes, from short runs, for the browser test.

    page_kinds.py STEERID FOLDER

FOLDER then holds NAME.html for each kind. `study validity` is left out: its page is made as that of `study hands`, and
its shortest run takes more than a minute.
"""
import pathlib
import shutil
import subprocess
import sys

STUDIES = {
    "efficiency": ["--drives", "10"],
    "uncertainty": ["--drives", "10"],
    "column": ["--drives", "10"],
    "closed_loop": ["--drives", "10"],
    "excitation": ["--drives", "10"],
    "hands": ["--drives", "10", "--hours", "1"],
    "tracking": ["--drives", "10", "--hours", "1", "--changes", "1"],
    "faults": ["--drives", "10"],
    "soak": ["--updates", "100000"],
}


def main() -> int:
    steerid, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    work = folder / "work"
    work.mkdir(parents=True)

    def run(*words: object) -> None:
        done = subprocess.run([steerid, *map(str, words)], cwd=work, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"steerid {' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr}")

    def keep(page: pathlib.Path, name: str) -> None:
        shutil.copyfile(page, folder / f"{name}.html")

    run("simulate", "--task", "active", "--hands", "right_3", "--duration", 30, "--seed", 3, "--out", "active.csv")
    run("identify", "active.csv", "--batch", "--report", "identify.html")
    run("template", "column", "--out", "column.json")
    run("simulate", "--task", "drive", "--column", "column.json", "--duration", 30, "--seed", 3, "--out", "drive.csv")
    run("identify", "drive.csv", "--batch", "--report", "identify_by_bar.html")
    for name in ("identify", "identify_by_bar"):
        keep(work / f"{name}.html", name)

    run("study", "blind", "--cases", 4, "--seed", 7, "--out", "blind")
    keep(work / "blind/blind.html", "blind")
    records = work / "blind/records"
    record = next(records.glob("**/log.csv")).parent
    run("diagnose", "--real", record / "log.csv", "--sim", record / "sim.json", "--out", "diagnosis")
    keep(work / "diagnosis/report.html", "diagnosis")
    run("diagnose", "--batch", record.parent, "--out", "batch")
    keep(work / "batch/fleet/report.html", "fleet_of_few")
    for name, options in STUDIES.items():
        run("study", name, *options, "--out", name)
        keep(work / name / f"{name}.html", name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
