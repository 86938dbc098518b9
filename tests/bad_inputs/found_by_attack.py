#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""What strangers found who tried to break the host tools and the daemon, row by row: each try again, and what is right.

    found_by_attack.py STEERID [STEERID_ECU]      the rows of the daemon are skipped aloud without it

Where the strangers' own table is found (logs/found_by_attack.md beside this repository or in STEERID_DATA), every row
of it has to have its tries here.
"""

import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

import bad_inputs
import table
from table import BAD_DATA, BAD_USAGE, Case, link_to, rows, sparse, wheel

HERE = pathlib.Path(__file__).resolve().parent


class Tools:
    """The programs, and a folder with the good files of table.py."""

    def __init__(self, steerid, ecu, good):
        self.steerid, self.ecu, self.good = steerid, ecu, good

    def folder(self, files):
        name = tempfile.TemporaryDirectory()
        bad_inputs.prepare(pathlib.Path(name.name), self.good, Case("", "", 0, files))
        return name

    def run(self, folder, *words, **options):
        return subprocess.run([self.steerid, *words], cwd=folder, capture_output=True, text=True, timeout=200,
                              check=False, **options)


def case(command, ends, files=None, says="", **more):
    return lambda tools: bad_inputs.faults(tools.steerid, tools.good, Case(command, command, ends, files or {}, says=says, **more))


def others_go_on(files, without):
    """A batch of three good records and one bad one answers the three and says why it has no answer to the fourth."""

    def tried(tools):
        good = {f"set/{name}/{file}": (tools.good / source).read_bytes() for name in ("a", "b", "c")
                for file, source in (("log.csv", "drive.csv"), ("sim.json", "sim.json"))}
        with tools.folder(good | {f"set/bad/{name}": made for name, made in files.items()}) as folder:
            done = tools.run(folder, "diagnose", "--batch", "set", "--out", "out", "--quiet")
            answers = sorted(path.parent.name for path in pathlib.Path(folder, "out").glob("*/diagnosis.json"))
            told = pathlib.Path(folder, "out/table.csv").read_text(encoding="utf-8")
        if done.returncode != BAD_DATA:
            yield f"ended with {done.returncode}: {done.stderr[:200]}"
        if answers != ["a", "b", "c"]:
            yield f"answered {answers}"
        if without not in told and without not in done.stderr:
            yield f"did not name {without}"
        if "internal error" in done.stderr + told:
            yield "called it a fault of its own"

    return tried


def gap_costs_nothing(stamp):
    """An answer or a sentence; a gap is no memory."""

    def tried(tools):
        with tools.folder({"gap.csv": rows(1200, stamp=stamp)}) as folder:
            code, said, memory = bad_inputs.run(tools.steerid, pathlib.Path(folder), Case("", "identify gap.csv", 0))
        if code not in (0, BAD_DATA) or "internal error" in said:
            yield f"ended with {code}: {said[:200]}"
        if memory > 300 << 20:
            yield f"took {memory >> 20} MiB"

    return tried


def kept_answer_is_not_taken(change):
    """A kept answer that is none is no answer: the record is diagnosed anew."""

    def tried(tools):
        with tools.folder({"set/a/log.csv": (tools.good / "drive.csv").read_bytes(), "set/a/sim.json": wheel()}) as folder:
            tools.run(folder, "diagnose", "--batch", "set", "--out", "out", "--quiet")
            answer = pathlib.Path(folder, "out/a/diagnosis.json")
            whole = answer.read_bytes()
            answer.write_bytes(change(whole))
            done = tools.run(folder, "diagnose", "--batch", "set", "--out", "out", "--quiet")
            again = answer.read_bytes()
        if done.returncode != 0:
            yield f"ended with {done.returncode}: {done.stderr[:200]}"
        if again != whole:
            yield "did not diagnose anew"

    return tried


def other_verdict(text):
    return lambda answer: re.sub(rb'"verdict":\s*"[^"]*",?', text, answer, count=1)


def ends_tidily(how, ends):
    """Ended in mid-work by a signal, or stopped by the limit of a file's size: nothing is left of what was not whole."""

    def tried(tools):
        limit = resource.RLIMIT_FSIZE if how is None else None
        with tools.folder({}) as folder:
            before = bad_inputs.state_of(pathlib.Path(folder))
            started = subprocess.Popen(
                [tools.steerid, "simulate", "--task", "probe", "--duration", "3000", "--out", "out.csv", "--quiet"],
                cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                preexec_fn=None if limit is None else lambda: resource.setrlimit(limit, (100_000, 100_000)))
            if how is not None:
                # Once the unfinished file is there, the program is in mid-work; it may be done before we look.
                while started.poll() is None and not list(pathlib.Path(folder).glob(".*partial*")):
                    time.sleep(0.001)
                started.send_signal(how)
            said = started.communicate()[1]
            after = bad_inputs.state_of(pathlib.Path(folder))
        code = started.returncode
        if how is not None and code == 0:
            after.pop("out.csv", None)  # it was done before the signal came
        elif code != ends:
            yield f"ended with {code} in place of {ends}: {said[:200]}"
        if after != before:
            yield f"left {sorted(set(after) - set(before))}"

    return tried


def proposes_no_probe(tools):
    """With the angle turned round nothing explains the record, and no probe is asked for that no motor can play."""
    with tools.folder({}) as folder:
        tools.run(folder, "simulate", "--task", "active", "--duration", "30", "--seed", "3", "--out", "active.csv", "--quiet")
        lines = pathlib.Path(folder, "active.csv").read_text(encoding="utf-8").splitlines()
        header, *cells = [line.split(",") for line in lines if not line.startswith("#")]
        angle = header.index("angle_rad")
        turned = [",".join([*row[:angle], str(-float(row[angle])), *row[angle + 1:]]) for row in cells]
        pathlib.Path(folder, "turned.csv").write_text("\n".join([",".join(header), *turned, ""]), encoding="utf-8")
        done = tools.run(folder, "diagnose", "--real", "turned.csv", "--sim", "sim.json", "--out", "out", "--quiet")
        next_experiment = json.loads(pathlib.Path(folder, "out/diagnosis.json").read_text(encoding="utf-8"))["next_experiment"]
        page = pathlib.Path(folder, "out/report.html").read_text(encoding="utf-8")
    if done.returncode != 0 or next_experiment["separates"]:
        yield f"proposed {next_experiment}"
    if "Let the EPS motor play" in page:
        yield "asked for a probe on the page"


def daemon(arguments, says, ends=1, config=None):
    def tried(tools):
        with tools.folder({} if config is None else {"ecu.json": config}) as folder:
            done = subprocess.run([tools.ecu, *arguments], cwd=folder, capture_output=True, text=True, timeout=20, check=False)
        if done.returncode != ends or says not in done.stderr or len(done.stderr.splitlines()) != 1:
            yield f"ended with {done.returncode}: {done.stderr[:200]}"

    return tried


DEEP = table.NO_JSON["arrays 100,000 deep, closed"]
STIFF = {"inertia_kgm2": 1e-6, "stiffness_nm_per_rad": 1e9}


def stiff(name):
    return wheel(**STIFF, effects=[{"effect": name}])


# The beginning of a row of the strangers' table, and its tries.
ROWS = {
    "any JSON": [
        case("simulate --task probe --sim deep.json --out out.csv", BAD_DATA, {"deep.json": DEEP}, "deep.json"),
        case("simulate --task drive --column deep.json --out out.csv", BAD_DATA, {"deep.json": DEEP}, "deep.json"),
        case("simulate --task probe --probe deep.json --out out.csv", BAD_DATA, {"deep.json": DEEP}, "deep.json"),
        others_go_on({"log.csv": rows(), "sim.json": DEEP}, "bad"),
    ],
    "a simulation that is stiff": [
        *(case("simulate --task probe --sim stiff.json --out out.csv", BAD_DATA, {"stiff.json": stiff(name)}, "stiff.json")
          for name in ("coulomb_friction", "backlash", "cubic_stiffness", "hands_off")),
        case("diagnose --real drive.csv --sim stiff.json --out out", BAD_DATA, {"stiff.json": stiff("coulomb_friction")},
             "stiff.json"),
    ],
    "a time stamp that jumps far ahead": [
        gap_costs_nothing(lambda i: i * 0.01 if i < 600 else 1e9 + i * 0.01),
        case("identify bad.csv", BAD_DATA, {"bad.csv": rows(stamp=lambda i: i * 0.01 if i < 600 else 1e300)}, "bad.csv"),
    ],
    "`identify X --json X`": [case("identify drive.csv --json drive.csv", BAD_USAGE)],
    "`--duration nan`": [case("simulate --task probe --duration nan --out out.csv", BAD_USAGE),
                         case("simulate --task probe --probe nan --out out.csv", BAD_USAGE)],
    "`experiment --drift nan`": [case(command, BAD_USAGE) for command in (
        "experiment --drift nan --out out", "experiment --unmeasured nan --out out", "study faults --unmeasured nan --out out",
        "hil --emulate an386 drive.csv --lose nan", "hil --emulate an386 drive.csv --reset-at nan")],
    "`--probe /dev/zero`": [case("simulate --task probe --probe /dev/zero --out out.csv", BAD_DATA, says="/dev/zero")],
    "record, simulation or output a pipe": [
        *(case(command, BAD_DATA, {"pipe": os.mkfifo}, "pipe") for command in (
            "identify pipe", "diagnose --real drive.csv --sim pipe --out out", "identify drive.csv --json pipe")),
        case("hil drive.csv --port /dev/zero", BAD_DATA, says="/dev/zero"),
    ],
    "a `--batch` folder with symlink loops": [others_go_on({"log.csv": link_to("log.csv"), "sim.json": wheel()}, "bad")],
    "a kept answer in `--batch`": [
        kept_answer_is_not_taken(other_verdict(b"")),
        kept_answer_is_not_taken(other_verdict(b'"verdict": 3,')),
        *(case("study blind score --out out", BAD_DATA, {"out/sealed/key.json": key, "out/sealed_key.json": key}, "out")
          for key in (b"key", b"", b"{}")),
    ],
    "`--probe diagnosis.json`": [
        case("simulate --task probe --probe diagnosis.json --out out.csv", BAD_DATA,
             {"diagnosis.json": b'{"next_experiment":%s}' % value}, "diagnosis.json") for value in (b"null", b"[]", b'"x"')],
    "standard output full": [case("identify drive.csv", BAD_DATA, stdout="/dev/full"),
                             case("simulate --task probe --quiet --out -", BAD_DATA, stdout="/dev/full")],
    "file size limit reached": [ends_tidily(None, BAD_DATA), ends_tidily(signal.SIGTERM, -signal.SIGTERM),
                                ends_tidily(signal.SIGINT, -signal.SIGINT)],
    "a file name with a line break": [case("identify 'two\nlines.csv'", BAD_DATA)],
    "files of 4 TB with holes": [case("identify holes", BAD_DATA, {"holes": sparse(4096)}, "holes"),
                                 case("simulate --task probe --sim holes --out out.csv", BAD_DATA, {"holes": sparse(4096)})],
    "`diagnose --batch` with a record named": [
        case("diagnose --batch odd --out out/in", BAD_DATA, {"odd/...csv": rows(), "odd/...json": wheel(),
                                                             "out/diagnosis.json": b"my own", "out/report.html": b"my own"})],
    "`diagnose --batch` with `--out`": [
        case("diagnose --batch own --out own", BAD_USAGE, {"own/a/log.csv": rows(40), "own/a/sim.json": wheel(),
                                                           "own/a/report.html": b"my own"})],
    "`simulate --replay d.csv --out d.csv`": [
        case(command, BAD_USAGE, {"link.csv": link_to("drive.csv"), "out/sim_with_effect.json": wheel()}) for command in (
            "simulate --sim sim.json --replay drive.csv --out drive.csv", "simulate --task probe --sim sim.json --out sim.json",
            "hil --emulate an386 drive.csv --json drive.csv", "identify drive.csv --json ./drive.csv",
            "diagnose --real drive.csv --sim out/sim_with_effect.json --out out",
            "simulate --sim sim.json --replay drive.csv --out link.csv")],
    "200 rows with a gap of 1e5 s": [
        gap_costs_nothing(lambda i: i * 0.01 + (1e5 if i >= 200 else 0)),
        gap_costs_nothing(lambda i: i * 0.01 if i == 0 else 1.7e9 + i * 0.01)],
    "daemon: empty config": [daemon(["--config", "ecu.json", "--dry-run"], "is empty; it needs at least", config=b"")],
    "daemon: `--make-safe` fails": [
        daemon(["--config", "ecu.json", "--make-safe"], "gpiochip77",
               config=b'{"can":"can0","lines":{"valid":{"chip":"gpiochip77","line":1}}}')],
    "daemon: config with 1e999": [
        daemon(["--config", "ecu.json", "--dry-run"], "too large", config=b'{"can":"can0","priority":1e999}'),
        daemon(["--config", "/dev/zero", "--dry-run"], "is no regular file")],
    "a next experiment of 0.0004 Nm": [proposes_no_probe],  # not in the table; found later
    "JSON with a key twice": [
        case("simulate --task probe --sim twice.json --out out.csv", BAD_DATA, {"twice.json": table.NO_JSON["a key twice"]},
             "twice.json")],
}


def rows_of_the_table():
    """The first cell of each row, as the strangers wrote it."""
    for place in (os.environ.get("STEERID_DATA"), HERE.parents[2] / "shared"):
        found = pathlib.Path(place, "logs/found_by_attack.md") if place else None
        if found and found.is_file():
            lines = [line for line in found.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
            return [line.split("|")[1].strip() for line in lines[2:]]
    return None


def main():
    steerid = str(pathlib.Path(sys.argv[1]).resolve())
    ecu = str(pathlib.Path(sys.argv[2]).resolve()) if len(sys.argv) > 2 else None
    failed = skipped = tries = 0
    known = rows_of_the_table()
    for row in known or []:
        if not any(row.startswith(begin) for begin in ROWS):
            failed += 1
            print(f"no try for the row {row!r}")
    if known is None:
        print("the strangers' table is not here: that every row of it is tried is not checked")
    with tempfile.TemporaryDirectory() as name:
        good = pathlib.Path(name)
        subprocess.run([steerid, "simulate", "--task", "probe", "--duration", "20", "--out", good / "drive.csv", "--quiet"],
                       check=True)
        (good / "sim.json").write_bytes(wheel())
        tools = Tools(steerid, ecu, good)
        for row, all_tries in ROWS.items():
            if row.startswith("daemon") and ecu is None:
                skipped += 1
                print(f"{row}: SKIPPED, this build has no steerid-ecu")
                continue
            for number, tried in enumerate(all_tries, 1):
                tries += 1
                for wrong in tried(tools):
                    failed += 1
                    print(f"{row}, try {number}: {wrong}", flush=True)
    print(f"{len(ROWS)} rows, {tries} tries, {skipped} rows skipped, {failed} taken otherwise than they should be")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
