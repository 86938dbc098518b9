#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Every note, doubt, caution and next command that a command prints stands in its JSON and on its page, on records with
something to be said of: units, counts, exchanged channels, signs, stamps, gaps, spikes, no probe.

    notes.py STEERID [WORD]      only the records that hold WORD
"""

import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import commands

program = pathlib.Path(sys.argv[1]).resolve()
only = sys.argv[2] if len(sys.argv) > 2 else ""

BEGINS = re.compile(r"^(note:|note {2,}|not credible:|with caution:|next:)\s*(.*)")
IN_PAGE = re.compile(r'<script type="application/json" id="document">(.*?)</script>', re.DOTALL)


def rows_of(log):
    lines = [line for line in log.read_text().splitlines() if not line.startswith("#")]
    header, *rows = csv.reader(lines)
    return header, [[float(cell) for cell in row] for row in rows]


def write(log, header, rows):
    log.write_text("\n".join([",".join(header)] + [",".join(f"{cell:.9g}" for cell in row) for row in rows]) + "\n")


def changed(**columns):
    """A way to change a log: each named column by a function of its number."""
    def change(header, rows):
        for row in rows:
            for name, by in columns.items():
                row[header.index(name)] = by(row[header.index(name)])
        return header, rows
    return change


def renamed(**names):
    return lambda header, rows: ([names.get(name, name) for name in header], rows)


def exchanged(header, rows):
    return ([{"angle_rad": "torque_driver_nm", "torque_driver_nm": "angle_rad"}.get(name, name) for name in header], rows)


def spiked(header, rows):
    rows[500][header.index("angle_rad")] += 3
    return header, rows


def without_rows(first, last):
    return lambda header, rows: (header, rows[:first] + rows[last:])


def without_column(name):
    def change(header, rows):
        at = header.index(name)
        return header[:at] + header[at + 1:], [row[:at] + row[at + 1:] for row in rows]
    return change


# Of the drive with all torques known: what is done to it, a word that has to be said of it, and by which commands where
# not by all.
KNOWN = {
    "degrees": (changed(angle_rad=math.degrees), "deg"),
    "counts": (changed(angle_rad=lambda angle: round(angle * 4096 / math.tau * 4)), "counts"),
    "millinewton metres": (changed(torque_driver_nm=lambda t: 1000 * t, torque_motor_nm=lambda t: 1000 * t), "mnm"),
    "exchanged channels": (exchanged, "exchanged"),
    "a torque that is turned round": (changed(torque_motor_nm=lambda t: -t), "sign"),
    "no unit in the name": (renamed(angle_rad="angle"), "states no unit"),
    "stamps of too few digits": (changed(time_s=lambda t: math.floor(t * 20) / 20), "stamp"),
    "a spike": (spiked, "stand alone", ("identify", "diagnose", "simulate --replay")),
    "a gap": (without_rows(800, 900), ""),
    "a constant torque": (changed(torque_motor_nm=lambda t: t + 0.7), "constant torque", ("identify", "inspect")),
}
BY_BAR = {
    "a bar without a probe": (without_column("probe_nm"), "no probe", ("identify",)),
    "a bar in degrees": (changed(angle_rad=math.degrees), "deg"),
    "a bar beside its rim": (lambda header, rows: (header, rows), "agree"),
    "a bar that is turned round": (changed(torque_bar_nm=lambda t: -t, torque_rim_nm=lambda t: -t), "negative"),
}


def said_in(text):
    return [found.group(2).strip() for line in text.splitlines() if (found := BEGINS.match(line)) and found.group(2).strip()]


def strings_in(value):
    """Every text of a document of JSON."""
    if isinstance(value, str):
        yield value
    for one in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from strings_in(one)


def page_text(page):
    return " ".join(strings_in(json.loads(IN_PAGE.search(page.read_text(encoding="utf-8")).group(1)))) + page.read_text(
        encoding="utf-8")


def main():
    faults, told = [], 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*words):
            ended = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, check=False)
            if ended.returncode == 1:
                return [ended.stderr.strip()], False  # refused: its one sentence is all there is
            if ended.returncode != 0:
                faults.append(f"{' '.join(words)}: ends with {ended.returncode}: {ended.stderr}")
            return said_in(ended.stdout), ended.returncode == 0

        run("template", "sim", "--out", "sim.json")
        run("simulate", "--task", "probe", "--duration", "20", "--out", "known.csv")
        run("simulate", "--task", "drive", "--probe", "1", "--duration", "30", "--out", "bar.csv")
        emulated = 0
        for source, records in (("known.csv", KNOWN), ("bar.csv", BY_BAR)):
            for what, (change, word, *by) in records.items():
                if only not in what:
                    continue
                write(folder / "log.csv", *change(*rows_of(folder / source)))
                runs = {"identify": (run("identify", "log.csv", "--batch", "--json", "o.json", "--report", "o.html"), "o"),
                        "inspect": (run("inspect", "log.csv", "--json", "i.json"), "i")}
                if source == "known.csv":
                    runs["diagnose"] = (run("diagnose", "--real", "log.csv", "--sim", "sim.json", "--out", "gap",
                                            "--time-limit", "1"), "gap/diagnosis")
                    if (folder / "gap/report.html").exists():
                        shutil.move(folder / "gap/report.html", folder / "gap/diagnosis.html")
                    runs["simulate --replay"] = (run("simulate", "--sim", "sim.json", "--replay", "log.csv", "--out",
                                                     "p.csv"), None)
                if commands.emulates(program) and emulated < 2:  # what is said does not hang on the board
                    emulated += 1
                    runs["hil"] = (run("hil", "--emulate", "an386", "log.csv", "--json", "h.json"), "h")
                for command, ((sentences, done), files) in runs.items():
                    told += len(sentences)
                    if word and command in (by[0] if by else runs) and not any(word in sentence for sentence in sentences):
                        faults.append(f"{what}: {command} says nothing of \"{word}\": {sentences}")
                    if not done:
                        continue
                    places = {"p.csv": (folder / "p.csv").read_text()} if files is None else {
                        f"{files}.json": " ".join(strings_in(json.loads((folder / f"{files}.json").read_text())))}
                    if files and (folder / f"{files}.html").exists():
                        places[f"{files}.html"] = page_text(folder / f"{files}.html")
                    for place, held in places.items():
                        faults += [f"{what}: {command} prints and {place} lacks: {sentence}"
                                   for sentence in sentences if sentence not in held]
    print("\n".join(faults))
    print(f"{told} sentences were printed")
    assert only or told > 50, "so few sentences decide nothing"
    sys.exit(1 if faults else 0)


main()
