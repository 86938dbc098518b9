# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""`steerid hil` as a user runs it: a simulated drive through the emulated ECU, every estimate the same bits as in process.

usage: hil.py BUILD an386|an385 [faults]
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile


def run(*command):
    ended = subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=280)
    assert ended.returncode == 0, f"{command}: exit code {ended.returncode}\n{ended.stderr}"
    return ended.stdout


def main():
    build, board = pathlib.Path(sys.argv[1]), sys.argv[2]
    faults = sys.argv[3:] == ["faults"]
    image = build / "firmware" / f"steerid-{board}.elf"
    if shutil.which("qemu-system-arm") is None or not image.exists():
        print("skipped: no qemu-system-arm, or no image: the Arm compiler was not there")
        return 77
    steerid = build / "steerid"
    with tempfile.TemporaryDirectory() as folder:
        drive, answer = pathlib.Path(folder, "drive.csv"), pathlib.Path(folder, "hil.json")
        harder = pathlib.Path(folder, "harder.json")
        duration = 14 if faults else 8
        run(steerid, "simulate", "--task", "probe", "--duration", duration, "--seed", 5, "--out", drive)
        options = ["--lose", 2, "--damage", 2, "--delay", 1, "--reset-at", 11, "--seed", 3] if faults else []
        print(run(steerid, "hil", "--emulate", board, drive, "--json", answer, *options))
        root = pathlib.Path(__file__).resolve().parents[2]  # Debian's Python has python3-jsonschema
        if faults:
            # Nothing but damage, late samples in plenty: each frame is damaged indeed, each late sample counted.
            run(steerid, "hil", "--emulate", board, drive, "--json", harder, "--damage", 60, "--delay", 40, "--seed", 1)
            hil = json.loads(harder.read_text(encoding="utf-8"))
            wire = hil["wire"]
            assert hil["bit_identical"] is True, wire
            # A late sample that takes a damaged one's place leaves that one unsent.
            assert 0.35 < wire["delayed"] / (100 * duration) < 0.45, wire
        else:
            # By the ECU's own clock: the last estimate is that of the last sample, not of the silence behind it.
            run(steerid, "hil", "--emulate", board, drive, "--json", harder, "--real-time")
            estimate = json.loads(harder.read_text(encoding="utf-8"))["estimate"]
            assert estimate["stiffness_nm_per_rad"]["state"] != "fault", estimate
        run("/usr/bin/python3", "-B", root / "tests/schemas/check_schemas.py", steerid, root / "docs/schemas", "hil", answer)
        hil = json.loads(answer.read_text(encoding="utf-8"))

    assert hil["schema"] == "steerid.hil/1" and hil["board"] == f"mps2-{board}"
    assert hil["scalar"] == ("float" if board == "an386" else "fixed")
    assert hil["samples"] == 100 * duration
    assert hil["bit_identical"] is True and hil["different"] == 0 and hil["differences"] == []
    # The drive starts and is learned from: the comparison was not one of starting values only.
    assert hil["estimate"]["stiffness_nm_per_rad"]["state"] == "valid", hil["estimate"]
    assert hil["wire"]["frames_refused_by_host"] == 0
    if not faults:
        assert hil["wire"]["frames_refused_by_ecu"] == 0
        return 0
    wire = hil["wire"]
    assert wire["lost"] > 5 and wire["damaged"] > 5 and wire["delayed"] > 3, wire
    # Of the frames damaged since the reset, 3 s ago; a bit turned into a zero makes two of one.
    assert 0 < wire["frames_refused_by_ecu"] <= 2 * wire["damaged"], wire
    # Saved at 10 s, reset at 11 s.
    (reset,) = hil["resets"]
    assert reset["restored"] is True and reset["valid_again_after_s"] is not None, reset
    return 0


if __name__ == "__main__":
    sys.exit(main())
