#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Nothing is half written. Of every command calls by which it changes a folder fail as on a full disk, one after the
other, and are the moment of a SIGTERM or a SIGINT (failing_calls.cpp). After that

    - every file is either what it was before, or what the undisturbed command writes, byte for byte
    - no other file is there, but for the journal of a batch of records, whose lines are whole
    - a full disk ends with 1 and a sentence, a signal as signals end a program, or the command was done already

    whole.py STEERID FAILING_CALLS [WORD]      only the commands that hold WORD
"""

import concurrent.futures
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys

import commands

program, library = (pathlib.Path(name).resolve() for name in sys.argv[1:3])
only = sys.argv[3] if len(sys.argv) > 3 else ""
MOST_CALLS = 2000  # of a command: a sweep that does not end is a fault of this test
TIMEOUT_S = 120
OLD = b"what was here before\n"


def heed_signals():
    """Whoever starts this test in the background may have had SIGINT ignored: the program would leave it so."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def run(command, folder, call=0, how=""):
    environment = dict(os.environ, NO_COLOR="1")
    if call:
        environment |= {"LD_PRELOAD": str(library), "FAILING_FOLDER": str(folder), "FAILING_CALL": str(call),
                        "FAILING_HOW": how, "FAILING_PROGRAM": program.name}
    started = subprocess.Popen([program, *command.arguments()], cwd=folder, env=environment, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, preexec_fn=heed_signals)
    try:
        _, errors = started.communicate(timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        waits = [path.read_text() for path in pathlib.Path(f"/proc/{started.pid}/task").glob("*/syscall")]
        started.kill()
        _, errors = started.communicate()
        errors += f"\nsteerid hangs, its threads in the system calls {waits}".encode()
    return subprocess.CompletedProcess(started.args, started.returncode, None, errors)


def fresh(inputs, command, folder, old):
    """The inputs, and with `old` something in the place of every file that the command will write."""
    shutil.copytree(inputs, folder)
    if old:
        for option, place in command.outputs.items():
            if not place.endswith("/"):
                (folder / place).write_bytes(OLD)
    return folder


def whole_lines(journal):
    return journal.endswith(b"\n") and all(json.loads(line) for line in journal.split(b"\n") if line)


def faults_of(command, before, after, whole, ended, call, how):
    """Sentences."""
    for name, held in after.items():
        if "fleet/shard_" in name and name.endswith(".jsonl") and whole_lines(held):  # a journal, from which an interrupted batch goes on
            continue
        if held not in (before.get(name), whole.get(name)):
            yield f"{name} is neither old nor whole ({len(held)} bytes)"
    for name in before.keys() - after.keys():
        yield f"{name} is gone"
    errors = ended.stderr.decode(errors="replace")
    done = all(after.get(name) == held for name, held in whole.items())
    if ended.returncode == 0:
        if not done:
            yield "it says that it is done, and is not"
    elif how == "full":
        if ended.returncode != 1 or not errors.strip().splitlines()[-1].startswith("steerid: "):
            yield f"it ends with {ended.returncode}: {errors!r}"
    elif ended.returncode != -int(how):
        yield f"it ends with {ended.returncode}, not by signal {how}: {errors!r}"


def next_call(call, how, slow):
    """Every call at first, then one in some: the rest of a long command is more of the same, and a signal takes the same
    way everywhere."""
    if how == "full" and call < (6 if slow else 10):
        return call + 1
    return call + {"full": 3, str(int(signal.SIGTERM)): 4, str(int(signal.SIGINT)): 7}[how] * (3 if slow else 1)


def sweep(inputs, work, command):
    """How many calls there were, and what went wrong."""
    faults = []
    base = fresh(inputs, command, work / "whole", False)
    ended = run(command, base)
    if ended.returncode != 0:
        return 0, [f"{command.name}: undisturbed it ends with {ended.returncode}: {ended.stderr.decode()}"]
    whole = commands.state_of(base)
    calls = 0
    for how in ("full", str(int(signal.SIGTERM)), str(int(signal.SIGINT))):
        call = 1
        while call < MOST_CALLS:
            folder = fresh(inputs, command, work / f"{how}_{call}", call % 2 == 0)
            before = commands.state_of(folder)
            ended = run(command, folder, call, how)
            after = commands.state_of(folder)
            faults += [f"{command.name}, call {call}, {how}: {fault}"
                       for fault in faults_of(command, before, after, whole, ended, call, how)]
            shutil.rmtree(folder)
            if how == "full":
                if ended.returncode == 0:
                    calls = call - 1
                    break
            elif call >= calls:
                break
            call = next_call(call, how, command.slow)
    return calls, faults


def main():
    tried = subprocess.run([program, "--version"], env=dict(os.environ, LD_PRELOAD=str(library)), capture_output=True,
                           check=False)
    if tried.returncode != 0:
        print("SKIPPED: this program takes no preloaded library, as one with a sanitizer:", tried.stderr.decode())
        return
    with commands.prepared(program, only) as (folder, inputs, chosen):
        works = [folder / f"work{i}" for i in range(len(chosen))]
        for work in works:
            work.mkdir()
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            swept = list(pool.map(lambda pair: sweep(inputs, *pair), zip(works, chosen)))
    faults = [fault for _, found in swept for fault in found]
    for command, (calls, _) in zip(chosen, swept):
        print(f"{calls:5} calls  {command.name}")
        if command.outputs and calls < 3:
            faults.append(f"{command.name}: {calls} calls are too few to write anything")
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


main()
