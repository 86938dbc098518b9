# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""MC/DC of what is flashed: runs the instrumented tests and compares what they leave uncovered with the list of gaps.

usage: mcdc.py BUILD_MCDC
Every decision of firmware/ must show that each of its conditions decides by itself (MC/DC), and every branch must be
taken both ways, unless gaps.txt beside this file names it with a reason. A gap that is closed must leave the list.
Instances of a template count together: they are the same lines.
"""

import json
import os
import pathlib
import subprocess
import sys

LLVM = pathlib.Path("/usr/lib/llvm-19/bin")
TESTS = ["base", "port", "identifier", "app"]


def uncovered(exported, source):
    """(file, line of code) -> what is missing there."""
    missing = {}
    conditions = decisions = branches = 0
    for file in exported["files"]:
        path = pathlib.Path(file["filename"])
        lines = path.read_text(encoding="utf-8").splitlines()
        pairs, ways = {}, {}
        for record in file["mcdc_records"]:
            shown = pairs.setdefault(tuple(record[:4]), [False] * len(record[-1]))
            pairs[tuple(record[:4])] = [a or b for a, b in zip(shown, record[-1])]
        for record in file["branches"]:
            taken = ways.setdefault(tuple(record[:4]), [0, 0])
            ways[tuple(record[:4])] = [taken[0] + record[4], taken[1] + record[5]]

        def add(where, what):
            key = (str(path.relative_to(source)), lines[where[0] - 1].strip())
            missing.setdefault(key, []).append(what)

        for where, shown in pairs.items():
            decisions += 1
            conditions += len(shown)
            for number, one in enumerate(shown, start=1):
                if not one:
                    add(where, f"condition {number} of {len(shown)} never decides")
        for where, (yes, no) in ways.items():
            branches += 2
            text = lines[where[0] - 1][where[1] - 1 : where[3] - 1] if where[0] == where[2] else "..."
            if yes == 0:
                add(where, f"never true: {text}")
            if no == 0:
                add(where, f"never false: {text}")
    return missing, (decisions, conditions, branches)


def named(path):
    """(file, line of code) -> reason."""
    gaps, key = {}, None
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("#") or not line.strip():
            continue
        if line.startswith(" "):
            gaps[key] = (gaps[key] + " " + line.strip()).strip()
        else:
            file, _, code = line.partition(": ")
            key = (file, code.strip())
            gaps[key] = ""
    assert all(gaps.values()), "a gap without a reason"
    return gaps


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    source = pathlib.Path(__file__).resolve().parents[2]
    programs = [build / "tests" / "unit" / f"test_{name}" for name in TESTS]
    profiles = []
    for program in programs:
        profiles.append(build / f"{program.name}.profraw")
        subprocess.run([program, "--gtest_brief=1"], check=True, stdout=subprocess.DEVNULL, env={**os.environ, "LLVM_PROFILE_FILE": str(profiles[-1])})
    merged = build / "mcdc.profdata"
    subprocess.run([LLVM / "llvm-profdata", "merge", "-sparse", *profiles, "-o", merged], check=True)
    headers = sorted((source / "firmware").rglob("*.hpp"))
    objects = [word for program in programs[1:] for word in ("-object", program)]
    answer = subprocess.run(
        [LLVM / "llvm-cov", "export", programs[0], *objects, "-instr-profile", merged, *headers],
        check=True, capture_output=True, text=True,
    )
    missing, (decisions, conditions, branches) = uncovered(json.loads(answer.stdout)["data"][0], source)
    gaps = named(pathlib.Path(__file__).with_name("gaps.txt"))

    print(f"{decisions} decisions of {conditions} conditions, {branches} branches; {len(gaps)} places named as gaps")
    assert decisions > 40 and branches > 400, "the coverage looks at something else"
    unnamed = {key: what for key, what in missing.items() if key not in gaps}
    closed = [key for key in gaps if key not in missing]
    for (file, code), what in unnamed.items():
        print(f"{file}: {code}\n    " + "; ".join(what))
    for file, code in closed:
        print(f"closed, take it off the list: {file}: {code}")
    return 1 if unnamed or closed else 0


if __name__ == "__main__":
    sys.exit(main())
