#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Gives a steerid program every bad input of table.py and asks of each:

    - it ends with the exit code of the table: 1 for bad data, 2 for bad usage
    - it says one sentence on standard error, beginning with "steerid: "; bad usage adds where the help is
    - it neither crashes nor takes more than 60 s of processor time (a guard, not a benchmark) nor 1 GiB of memory
    - it leaves every file as it was, and none behind

    bad_inputs.py STEERID [WORD]      only the cases whose name holds WORD
"""

import concurrent.futures
import os
import pathlib
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

import table

MOST_BYTES = 1 << 30
MOST_PROCESSOR_S = 60
MOST_WAIT_S = 200  # a program that waits for ever takes no processor time
AT_ONCE = 8  # most of those that wait do so for a partner of a pipe


def state_of(folder):
    """Every file below `folder`, with what is in it; folders are no files, and an empty one may stay."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_symlink():
            found[name] = os.readlink(path)
        elif path.is_file():
            found[name] = path.read_bytes() if path.stat().st_size < MOST_BYTES else path.stat().st_size
        elif not path.is_dir():
            found[name] = "no file"
    return found


def prepare(folder, good, case):
    for path in good.iterdir():
        shutil.copy(path, folder)
    for name, made in case.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if callable(made):
            made(path)
        else:
            path.write_bytes(made)


def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_PROCESSOR_S, MOST_PROCESSOR_S))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(program, folder, case):
    """Exit code, standard error and the most memory taken."""
    with tempfile.TemporaryFile() as errors, tempfile.TemporaryFile() as requests:
        requests.write(case.stdin)
        requests.seek(0)
        with open(case.stdout or os.devnull, "wb") as out:
            started = subprocess.Popen([program, *shlex.split(case.command)], cwd=folder, stdin=requests, stdout=out,
                                       stderr=errors, preexec_fn=limits)
        waited = 0.0
        while True:
            pid, status, usage = os.wait4(started.pid, os.WNOHANG)
            if pid == started.pid:
                break
            time.sleep(0.005)
            waited += 0.005
            if waited > MOST_WAIT_S:
                started.kill()
        started.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        return started.returncode, errors.read().decode("utf-8", "replace"), usage.ru_maxrss * 1024


def faults(program, good, case):
    """What is wrong with how the program took a case."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder, good, case)
        before = state_of(folder)
        code, said, memory = run(program, folder, case)
        after = state_of(folder)
    if code != case.ends:
        yield f"ended with {code} in place of {case.ends}"
    if case.ends != 0:
        lines = said.splitlines()
        if case.ends == table.BAD_USAGE and len(lines) == 2 and lines[1].startswith("Try `steerid"):
            lines.pop()
        if len(lines) != 1 or not lines[0].startswith("steerid: "):
            yield "did not say one sentence"
        elif "internal error" in lines[0]:
            yield "called it a fault of its own"
        elif case.says not in lines[0]:
            yield f"did not name {case.says}"
    if memory > MOST_BYTES:
        yield f"took {memory >> 20} MiB"
    for path in sorted(before.keys() | after.keys()):
        if before.get(path) != after.get(path):
            # A batch says why in its table, and a fleet's tables are made of what could be answered.
            kept = case.ends == table.BAD_DATA and (path.endswith("table.csv") or "/fleet/" in f"/{path}")
            if not kept:
                yield f"{'left' if path not in before else 'changed'} {path}"
    if code != case.ends:
        yield f"said {said[:300]!r}"


def main():
    program, word = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2] if len(sys.argv) > 2 else ""
    cases = [case for case in table.all_cases() if word in case.name]
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        good = pathlib.Path(name)
        make = [program, "simulate", "--task", "probe", "--duration", "10", "--out", str(good / "drive.csv"), "--quiet"]
        subprocess.run(make, check=True)
        (good / "sim.json").write_bytes(table.wheel())
        (good / "probe.json").write_bytes(b'{"rms_nm":0.5,"lowest_hz":0.2,"highest_hz":5}')
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            found = pool.map(lambda case: list(dict.fromkeys(faults(program, good, case))), cases)
        for case, wrong in zip(cases, found):
            failed += 1 if wrong else 0
            if wrong:
                print(f"{case.name!r}\n    steerid {case.command}\n    " + "\n    ".join(wrong), flush=True)
    print(f"{len(cases)} bad inputs, {failed} taken otherwise than they should be")
    return 1 if failed or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
