# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Records for a fleet, and what is compared of its answers."""

import shutil
import subprocess

COUNT, REFUSED = 40, 1


def make(steerid, folder):
    """Forty logs of ten seconds; one cannot be read."""
    folder.mkdir()
    for seed in range(8):
        subprocess.run([steerid, "simulate", "--task", "probe", "--duration", "10", "--seed", str(seed), "--out",
                        folder / f"r{seed:02}.csv"], check=True, capture_output=True)
    for i in range(8, COUNT):
        shutil.copy(folder / f"r{i % 8:02}.csv", folder / f"r{i:02}.csv")
    (folder / "r17.csv").write_text("time_s\nnever\n", encoding="utf-8")


def on_one_machine(steerid, question, out):
    ended = subprocess.run([steerid, *question, out], capture_output=True, text=True)
    assert ended.returncode == 1, ended.stderr  # one record is refused
    return everything(out)


def everything(folder):
    """Every file with its bytes, but what the shards said on the way."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and path.parent != folder / "fleet" / "log"}
