#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Every output of every command in the place of each of its inputs, and of each of its other outputs, by every way that a
place can be named: refused with 2 and a sentence before anything is computed, and nothing has changed. And on standard
output, "-": what stands there is the file and nothing else.

    apart.py STEERID [WORD]      only the commands that hold WORD
"""

import concurrent.futures
import itertools
import os
import pathlib
import shutil
import subprocess
import sys

import commands

program = pathlib.Path(sys.argv[1]).resolve()
only = sys.argv[2] if len(sys.argv) > 2 else ""
BAD_USAGE = 2


def as_it_is(folder, name):
    return name


def behind_a_dot(folder, name):
    return f"./{name}"


def by_another_folder(folder, name):
    return f"records/../{name}"


def whole(folder, name):
    return str(folder / name)


def by_a_symbolic_link(folder, name):
    (folder / "link").symlink_to(name)
    return "link"


def by_a_hard_link(folder, name):
    os.link(folder / name, folder / "link")
    return "link"


WAYS = [as_it_is, behind_a_dot, by_another_folder, whole, by_a_symbolic_link, by_a_hard_link]


def run(folder, words, **more):
    return subprocess.run([program, *words], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, check=False, **more)


def refused(inputs, work, command, places, prepare):
    """Sentences on what went wrong when outputs are put to these places."""
    folder = work / "run"
    shutil.copytree(inputs, folder)
    places = prepare(folder, places)
    before = commands.state_of(folder)
    words = command.arguments(places)
    ended = run(folder, words)
    errors = ended.stderr.decode(errors="replace")
    faults = []
    if ended.returncode != BAD_USAGE or not errors.startswith("steerid: "):
        faults.append(f"{' '.join(words)}: ends with {ended.returncode}: {errors!r}")
    if commands.state_of(folder) != before:
        faults.append(f"{' '.join(words)}: files have changed")
    shutil.rmtree(folder)
    return faults



def each_refusal(inputs, work, command):
    files = {option: place for option, place in command.outputs.items() if not place.endswith("/")}
    for option, name, way in itertools.product(files, command.inputs, WAYS):
        yield from refused(inputs, work, command, {}, lambda folder, _: {option: way(folder, name)})
    for (one, place), other, way in itertools.product(files.items(), files, WAYS):
        if one == other:
            continue

        def prepare(folder, _):
            if way in (by_a_symbolic_link, by_a_hard_link):
                (folder / place).write_bytes(b"here before\n")
            return {other: way(folder, place)}

        yield from refused(inputs, work, command, {}, prepare)
    for one, other in itertools.combinations(files, 2):
        yield from refused(inputs, work, command, {}, lambda folder, _: {one: "-", other: "-"})


def each_on_standard_output(inputs, work, command):
    """Each file on standard output while the others are files: the same bytes, and nothing of what is printed."""
    for option, place in command.outputs.items():
        if place.endswith("/"):
            continue
        folder = work / "dash"
        shutil.copytree(inputs, folder)
        plain = run(folder, command.arguments())
        expected = (folder / place).read_bytes() if plain.returncode == 0 else plain.stderr
        before = {name: (folder / name).read_bytes() for name in (*command.inputs, place)}
        ended = run(folder, command.arguments({option: "-"}))
        if place.endswith(".mcap"):
            pass  # "-" has no ending: it is CSV
        elif ended.returncode != 0 or ended.stdout != expected:
            yield (f"{command.name}, {option} -: ends with {ended.returncode}; {len(ended.stdout)} bytes in place of "
                   f"{len(expected)}: {ended.stdout[:80]!r} {ended.stderr.decode()[-200:]!r}")
        if any((folder / name).read_bytes() != held for name, held in before.items()) or (folder / "-").exists():
            yield f"{command.name}, {option} -: files have changed"
        shutil.rmtree(folder)


def each_folder(inputs, work):
    """Folders: the file of an answer is an input, as one that the program or a user has put there."""
    for words, name, source in [
            ("diagnose --real drive.csv --sim gap/sim_with_effect.json --out gap", "gap/sim_with_effect.json", "sim.json"),
            ("diagnose --real gap/report.html --sim sim.json --out gap", "gap/report.html", "drive.csv"),
            ("diagnose --real drive.csv --sim sim.json --out linked", "gap/diagnosis.json", "sim.json"),
            ("identify figures/02_torque.csv --figures figures", "figures/02_torque.csv", "drive.csv"),
            ("identify drive.csv --trace figures/02_torque.csv --figures figures", "figures/none.csv", "drive.csv"),
            ("identify --folder records --out records", "records/b.csv", "drive.csv"),
            ("diagnose --batch records --out records", "records/b.csv", "drive.csv")]:
        folder = work / "folders"
        shutil.copytree(inputs, folder)
        (folder / name).parent.mkdir(exist_ok=True)
        shutil.copy(folder / source, folder / name)
        if "linked" in words:
            (folder / "linked").mkdir()
            (folder / "linked/diagnosis.json").symlink_to(folder / "drive.csv")
        before = commands.state_of(folder)
        ended = run(folder, words.split())
        after = commands.state_of(folder)
        changed = [key for key, held in before.items() if after.get(key) != held]
        if ended.returncode != BAD_USAGE or changed:
            yield f"{words}: ends with {ended.returncode}, changed {changed}: {ended.stderr.decode()!r}"
        shutil.rmtree(folder)


def main():
    with commands.prepared(program, only) as (folder, inputs, chosen):

        def faults_of(pair):
            number, command = pair
            work = folder / f"work{number}"
            work.mkdir()
            return [*each_refusal(inputs, work, command),
                    *([] if command.slow else each_on_standard_output(inputs, work, command))]

        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            faults = [fault for found in pool.map(faults_of, enumerate(chosen)) for fault in found]
        if not only:
            faults += each_folder(inputs, folder / "folders")
    print("\n".join(faults))
    print(f"{len(chosen)} commands, {len(faults)} faults")
    sys.exit(1 if faults else 0)


main()
