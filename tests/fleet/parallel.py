# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Forty records in ten shards by GNU parallel, of which one is killed at its first attempt: the answer has the same bytes
as that of one machine. Without further attempts the merge names the shard that is missing, and the same command ends
what it left.

    parallel.py SOURCE_DIR BUILD_DIR
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import records

SKIPPED = 77

# Stands for steerid: the real one, once it has been killed at the third shard as often as $KILL says.
KILLED = r"""#!/bin/bash
if [[ "$*" = *"--shard 3/10"* ]]; then
  for ((i = 0; i < KILL; ++i)); do
    if mkdir "$KILLS/$i" 2>/dev/null; then kill -9 $$; fi
  done
fi
exec "$REAL_STEERID" "$@"
"""


def main(source, build):
    if not shutil.which("parallel"):
        print("SKIPPED for want of GNU parallel: apt-get install parallel")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="steerid-parallel-") as scratch:
        check(pathlib.Path(scratch), source / "scripts" / "fleet" / "fleet.sh", build / "steerid")
    return 0


def check(scratch, fleet, steerid):
    drives = scratch / "drives of a fleet"
    records.make(steerid, drives)
    (scratch / "steerid").write_text(KILLED, encoding="utf-8")
    (scratch / "steerid").chmod(0o755)
    question = ["identify", "--folder", drives, "--no-report", "--out"]
    whole = records.on_one_machine(steerid, question, scratch / "whole")

    def in_shards(out, kill, *options):
        kills = scratch / f"kills.{out}.{kill}"
        kills.mkdir()
        return subprocess.run(
            [fleet, "parallel", "--shards", "10", "--with=--jobs=2", *options, "--", *question, scratch / out],
            env={**os.environ, "STEERID": scratch / "steerid", "REAL_STEERID": steerid, "KILLS": kills, "KILL": str(kill)},
            capture_output=True, text=True)

    ended = in_shards("killed once", 1)
    assert ended.returncode == 0, ended.stderr
    assert records.everything(scratch / "killed once") == whole

    ended = in_shards("killed", 1, "--attempts=1")
    assert ended.returncode == 1 and "shard 3 of 10 is missing" in ended.stderr, ended
    assert not (scratch / "killed" / "table.csv").exists()
    ended = in_shards("killed", 0)
    assert ended.returncode == 0, ended.stderr
    assert records.everything(scratch / "killed") == whole
    log = (scratch / "killed" / "fleet" / "log" / "parallel.log").read_text(encoding="utf-8")
    said = re.findall(r"(\d+) records, (\d+) kept from an earlier run, (\d+) not usable", log)
    anew = sum(int(count) - int(kept) - int(refused) for count, kept, refused in said)
    assert anew == records.COUNT - records.REFUSED, log

    for words in (["slum"], ["parallel"], ["parallel", "--shards", "0", "--", "identify"],
                  ["parallel", "--shards", "2", "--", "identify", "--folder", drives],
                  ["parallel", "--shards", "2", "--", *question, scratch / "x", "--shard", "1/2"]):
        ended = subprocess.run([fleet, *words], capture_output=True, text=True)
        assert ended.returncode == 2 and ended.stderr.count("\n") == 1, ended


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(os.path.abspath(sys.argv[2]))))
