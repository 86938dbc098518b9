# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Forty records in ten shards on a real Slurm cluster of two nodes, on which a node dies and a task fails: the answer
has the same bytes as that of one machine, and every record was answered once.

    slurm.py SOURCE_DIR BUILD_DIR

The second node holds two tasks when one of them is killed, and then its slurmd. The other task lives on unseen, while
Slurm starts its shard anew on the first node: the case in which a shard could be answered twice. On the first node a
task's steerid is killed when it first begins.
"""

import os
import pathlib
import re
import sys
import tempfile

import cluster
import records
from cluster import wait_for

SKIPPED = 77
SHARDS = 10
PATIENCE_S = 150  # for one step, on a machine that is busy with other things

RESTARTED = f"shard {{}} of {SHARDS} on n1, attempt 1, restart 1\n"
RETRIED = f"shard {{}} of {SHARDS} on n1, attempt 2, restart 0\n"

# Stands for steerid: the real one, once it is let through.
GATE = r"""#!/bin/bash
if [ "$SLURMD_NODENAME" = n2 ] && [ ! -e "$GATE/open" ]; then
  touch "$GATE/held.$SLURM_ARRAY_TASK_ID"
  until [ -e "$GATE/open" ]; do sleep 0.1; done
elif [ "${SLURM_ARRAY_TASK_ID-}" ] && mkdir "$GATE/failed" 2>/dev/null; then
  echo "$SLURM_ARRAY_TASK_ID" > "$GATE/failed/shard"
  kill -9 $$
fi
exec "$REAL_STEERID" "$@"
"""


def fill_and_break(slurm, gate, log):
    """Waits until the second node holds two tasks, kills one and then the node's slurmd, and lets the other go on when
    its shard has been begun anew. Gives the numbers of both shards, the one that lived on last."""
    dies, lives = wait_for("two tasks on the second node", lambda: two(gate), PATIENCE_S)
    for process in slurm.processes(SLURM_ARRAY_TASK_ID=dies, SLURMD_NODENAME="n2"):
        cluster.kill(process)
    slurm.kill_server("n2")
    wait_for("the shard of the lost task begun anew", lambda: RESTARTED.format(lives)
             in (log / f"shard_{lives}.log").read_text(), PATIENCE_S)
    (gate / "open").touch()
    return dies, lives


def two(gate):
    held = sorted(path.suffix[1:] for path in gate.glob("held.*"))
    return held if len(held) == 2 else None


def answered(log):
    """How many records were answered anew, over all attempts at all shards."""
    said = re.findall(r"(\d+) records, (\d+) kept from an earlier run, (\d+) not usable", log)
    return sum(int(records) - int(kept) - int(refused) for records, kept, refused in said)


def main(source, build):
    absent = cluster.missing_programs()
    if absent:
        print(f"SKIPPED for want of {', '.join(absent)}: apt-get install slurmctld slurmd slurm-client")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="steerid-slurm-") as scratch:
        return on_a_cluster(pathlib.Path(scratch), source, build / "steerid")


def on_a_cluster(scratch, source, steerid):
    drives, gate, out, whole = (scratch / name for name in ("drives", "gate", "out", "whole"))
    gate.mkdir()
    records.make(steerid, drives)
    (scratch / "steerid").write_text(GATE, encoding="utf-8")
    (scratch / "steerid").chmod(0o755)
    question = ["identify", "--folder", str(drives), "--no-report", "--out"]
    expected = records.on_one_machine(steerid, question, whole)

    with cluster.Cluster(scratch / "cluster") as slurm:
        said = slurm.run(source / "scripts/fleet/fleet.sh", "slurm", "--shards", SHARDS, "--", *question, out,
                         STEERID=str(scratch / "steerid"), REAL_STEERID=str(steerid), GATE=str(gate))
        print(said, end="")
        log = out / "fleet" / "log"
        try:
            killed, lost = fill_and_break(slurm, gate, log)
            wait_for("the merge", lambda: not slurm.run("squeue", "-h"), PATIENCE_S)
            assert (out / "table.csv").exists(), "nothing was merged"
        except BaseException:
            show(log, slurm)
            raise

    logs = {path.stem.removeprefix("shard_"): path.read_text() for path in log.glob("shard_*.log")}
    failed = (gate / "failed" / "shard").read_text().strip()
    for shard in logs:
        assert (RESTARTED.format(shard) in logs[shard]) == (shard == lost), logs[shard]
        assert (RETRIED.format(shard) in logs[shard]) == (shard in (failed, killed)), logs[shard]
    merged = records.everything(out)
    assert merged == expected, sorted(set(merged) ^ set(expected))
    assert answered("".join(logs.values())) == records.COUNT - records.REFUSED, logs
    return 0


def show(log, slurm):
    for path in [*sorted(log.glob("*.log")), *sorted(slurm.folder.glob("*.log"))]:
        print(f"---- {path.name}\n{path.read_text()[-3000:]}")


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(os.path.abspath(sys.argv[2]))))
