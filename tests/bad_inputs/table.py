# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The bad inputs of bad_inputs.py, as cases: a name, what the folder holds beside the good files, a command line, and
the exit code that it has to end with.

The good files are drive.csv (10 s, probe), sim.json (a wheel) and probe.json (a probe that a diagnosis suggests).
"""

import dataclasses
import json
import math
import os
import struct

BAD_DATA, BAD_USAGE = 1, 2


@dataclasses.dataclass
class Case:
    name: str
    command: str  # steerid's arguments; {word} is a file of `files`
    ends: int
    files: dict = dataclasses.field(default_factory=dict)  # name: bytes, or a function that makes it at a path
    stdin: bytes = b""
    says: str = ""  # a word that the sentence has to hold
    stdout: str = ""  # where standard output goes, else nowhere


WHEEL = {"inertia_kgm2": 0.11, "damping_nms_per_rad": 1.5, "stiffness_nm_per_rad": 22.7}


def wheel(**changed):
    return json.dumps(WHEEL | changed).encode()


def without(key):
    return json.dumps({k: v for k, v in WHEEL.items() if k != key}).encode()


def effect(name, **parameters):
    return wheel(effects=[{"effect": name, "parameters": parameters}])


def sparse(gigabytes):
    def make(path):
        with open(path, "wb") as file:
            file.truncate(gigabytes << 30)

    return make


def link_to(target):
    return lambda path: os.symlink(target, path)


# What is no simulation. "Any JSON" of the project goes through the same reader.
NO_JSON = {
    "nothing": b"",
    "space": b" \n\t ",
    "a word": b"wheel",
    "a comma": b"{,}",
    "a trailing comma": b'{"inertia_kgm2":0.11,}',
    "half a file": wheel()[:40],
    "two values": wheel() + wheel(),
    "a key twice": wheel()[:-1] + b',"inertia_kgm2":0.2}',
    "a key twice, deep": wheel(effects=[])[:-3] + b'[{"effect":"coulomb_friction","effect":"backlash"}]}',
    "single quotes": b"{'inertia_kgm2':0.11}",
    "bytes": bytes(range(256)),
    "zeros": b"\0" * 4096,
    "half a file in UTF-16": json.dumps(WHEEL)[:40].encode("utf-16"),
    "bad UTF-8": b'{"inertia_kgm2":0.11,"damping_nms_per_rad":1.5,"stiffness_nm_per_rad":22.7,"note":"\xff\xfe"}',
    "arrays 100,000 deep": b"[" * 100_000,
    "arrays 100,000 deep, closed": b"[" * 100_000 + b"]" * 100_000,
    "objects 100,000 deep": b'{"a":' * 100_000 + b"1" + b"}" * 100_000,
    "effects 100,000 deep": wheel()[:-1] + b',"effects":' + b"[" * 100_000 + b"]" * 100_000 + b"}",
    "NaN": wheel().replace(b"0.11", b"NaN"),
    "infinity": wheel().replace(b"0.11", b"Infinity"),
    "a number beyond all": wheel().replace(b"0.11", b"1e999"),
    "a number of 100,000 digits": wheel().replace(b"0.11", b"1" * 100_000),
    "an open string": b'{"inertia_kgm2":"' + b"x" * 100_000,
    "XML": b"<wheel inertia='0.11'/>",
    "a record": b"time_s,torque_driver_nm,torque_motor_nm,angle_rad\n0,0,0,0\n",
}
NO_SIMULATION = {
    "null": b"null",
    "a number": b"3",
    "a text": b'"wheel"',
    "an array": b"[]",
    "an empty object": b"{}",
    "no inertia": without("inertia_kgm2"),
    "no damping": without("damping_nms_per_rad"),
    "no stiffness": without("stiffness_nm_per_rad"),
    "a text as inertia": wheel(inertia_kgm2="0.11"),
    "null as inertia": wheel(inertia_kgm2=None),
    "an array as inertia": wheel(inertia_kgm2=[0.11]),
    "true as inertia": wheel(inertia_kgm2=True),
    "an inertia of zero": wheel(inertia_kgm2=0),
    "a negative inertia": wheel(inertia_kgm2=-0.1),
    "a negative damping": wheel(damping_nms_per_rad=-1),
    "a negative stiffness": wheel(stiffness_nm_per_rad=-1),
    "an enormous inertia": wheel(inertia_kgm2=1e300),
    "stiff and dry": wheel(inertia_kgm2=1e-6, stiffness_nm_per_rad=1e9, effects=[{"effect": "coulomb_friction"}]),
    "stiff and slack": wheel(inertia_kgm2=1e-6, stiffness_nm_per_rad=1e9, effects=[{"effect": "backlash"}]),
    "stiff and cubic": wheel(inertia_kgm2=1e-6, stiffness_nm_per_rad=1e9, effects=[{"effect": "cubic_stiffness"}]),
    "stiff with the hands off": wheel(inertia_kgm2=1e-6, stiffness_nm_per_rad=1e9, effects=[{"effect": "hands_off"}]),
    "another name": wheel(inertia=0.1),
    "effects that are no list": wheel(effects={}),
    "an effect that is no object": wheel(effects=["coulomb_friction"]),
    "an effect without a name": wheel(effects=[{"parameters": {}}]),
    "an effect of no name": wheel(effects=[{"effect": 3}]),
    "an unknown effect": effect("coulomb_fricton"),
    "an unknown parameter": effect("coulomb_friction", friction=0.4),
    "a parameter out of range": effect("coulomb_friction", friction_nm=-1),
    "a parameter that is a text": effect("coulomb_friction", friction_nm="0.4"),
    "parameters that are a list": wheel(effects=[{"effect": "coulomb_friction", "parameters": [0.4]}]),
    "an enormous parameter": effect("coulomb_friction", friction_nm=1e300),
    "an endless delay": effect("delay", delay_s=1e9),
    "a time course that is a text": wheel(effects=[{"effect": "unmeasured_torque", "time_course_nm": "x"}]),
    "a torque between samples of no kind": wheel(torque_between_samples="straight"),
}

HEADER = b"time_s,torque_driver_nm,torque_motor_nm,angle_rad\n"


def rows(count=1000, stamp=lambda i: i * 0.01, row=lambda i: f"0,{i % 7},{0.01 * (i % 11)}", header=HEADER):
    return header + "".join(f"{stamp(i)},{row(i)}\n" for i in range(count)).encode()


# What is no record.
NO_RECORD = {
    "nothing": b"",
    "a header": HEADER,
    "one row": rows(1),
    "forty rows": rows(40),
    "no header": rows(header=b""),
    "another header": rows(header=b"a,b,c,d\n"),
    "no time": rows(header=b"t,torque_driver_nm,torque_motor_nm,angle_rad\n"),
    "no angle": rows(header=b"time_s,torque_driver_nm,torque_motor_nm,theta\n"),
    "a column twice": rows(header=b"time_s,torque_driver_nm,angle_rad,angle_rad\n"),
    "a word in a cell": rows().replace(b"0.05,0,5", b"0.05,zero,5", 1),
    "infinity in a cell": rows(row=lambda i: "inf,0,0" if i == 5 else "0,0,0.1"),
    "too few cells": rows().replace(b"0.05,0,5,", b"0.05,0,", 1),
    "time goes back": rows(stamp=lambda i: i * 0.01 if i < 500 else i * 0.01 - 3),
    "time stands still": rows(stamp=lambda i: 1.0),
    "ten rows a second": rows(stamp=lambda i: i * 0.1),
    "all NaN": rows(row=lambda i: "nan,nan,nan"),
    "bytes": bytes(range(256)) * 40,
    "zeros": b"\0" * 100_000,
    "an open quote": HEADER + b'"' + b"x" * 10_000,
    "a line without end": b"x" * 3_000_000,
    "a million commas": HEADER + b"," * 1_000_000,
    "a simulation": wheel(),
    "a page": b"<!doctype html><html></html>",
    "a ZIP": b"PK\x03\x04" + bytes(1000),
    "a Matlab file": b"MATLAB 5.0 MAT-file" + bytes(1000),
    "an MDF": b"MDF     4.10    " + bytes(1000),
    "HDF5": b"\x89HDF\r\n\x1a\n" + bytes(1000),
    "stamps beyond all": rows(stamp=lambda i: 1e300 * i),
    "a clock that jumps from 0 to the epoch": rows(300, stamp=lambda i: i * 0.01 if i == 0 else 1.7e9 + i * 1e5),
}

MCAP = b"\x89MCAP0\r\n"


def mcap(*records):
    """Each of a kind and a content, behind the length that it has."""
    return MCAP + b"".join(bytes([kind]) + struct.pack("<Q", len(content)) + content for kind, content in records)


def text(words):
    return struct.pack("<I", len(words)) + words


def mcap_chunk(method, size, packed, checksum=0):
    return (6, struct.pack("<QQQI", 0, 0, size, checksum) + text(method) + struct.pack("<Q", len(packed)) + packed)


def mcap_messages(encoding, schema, definition, messages):
    channel = (4, struct.pack("<HH", 1, 1) + text(b"/a") + text(encoding) + text(b""))
    return mcap((1, text(b"") + text(b"")), (3, struct.pack("<H", 1) + text(b"a/B") + text(schema) + text(definition)), channel,
                *[(5, struct.pack("<HIQQ", 1, i, i * 10**7, i * 10**7) + message) for i, message in enumerate(messages)])


NO_RECORD |= {
    "MCAP: its first bytes": MCAP,
    "MCAP: cut in its first bytes": MCAP[:6],
    "MCAP: zeros": MCAP + bytes(100_000),
    "MCAP: bytes": MCAP + bytes(range(1, 256)) * 40,
    "MCAP: a record of 2^63 bytes": MCAP + b"\x05" + b"\xff" * 7 + b"\x7f",
    "MCAP: a record of 200 MiB that is not there": MCAP + b"\x05" + struct.pack("<Q", 200 << 20),
    "MCAP: an attachment of 2^64 - 1 bytes": MCAP + b"\x09" + b"\xff" * 8 + b"x",
    "MCAP: no messages": mcap((1, text(b"") + text(b"")), (15, bytes(4))),
    "MCAP: a message without its channel": mcap((5, bytes(40))),
    "MCAP: a message of three bytes": mcap((5, bytes(3))),
    "MCAP: a channel without its schema": mcap((4, struct.pack("<HH", 1, 7) + text(b"/a") + text(b"cdr") + text(b""))),
    "MCAP: a topic that is longer than its record": mcap((4, struct.pack("<HHI", 1, 0, 1 << 30))),
    "MCAP: a chunk of no method": mcap(mcap_chunk(b"bz2", 10, b"x")),
    "MCAP: a chunk that is no zstd": mcap(mcap_chunk(b"zstd", 10, b"x" * 10)),
    "MCAP: a chunk that is no lz4": mcap(mcap_chunk(b"lz4", 10, b"x" * 10)),
    "MCAP: a chunk of 2^60 bytes": mcap(mcap_chunk(b"lz4", 1 << 60, b"x" * 10)),
    "MCAP: a chunk of nothing that is 255 MiB": mcap(mcap_chunk(b"zstd", 255 << 20, b"")),
    "MCAP: a chunk with a wrong checksum": mcap(mcap_chunk(b"", 9, b"\x05" + bytes(8), 1)),
    "MCAP: a chunk of half a record": mcap(mcap_chunk(b"", 9, b"\x05\x20" + bytes(7))),
    "MCAP: messages of protobuf": mcap_messages(b"protobuf", b"protobuf", b"x", [b"x"] * 100),
    "MCAP: a definition that holds itself": mcap_messages(b"cdr", b"ros2msg", b"B b", [b"\0\1\0\0x"] * 100),
    "MCAP: a definition of nothing": mcap_messages(b"cdr", b"ros2msg", b"", [b"\0\1\0\0x"] * 100),
    "MCAP: lists of 2^32 - 1": mcap_messages(b"cdr", b"ros2msg", b"float64[] x\nint8[][] y", [b"\0\1\0\0" + b"\xff" * 40] * 100),
    "MCAP: JSON that is none": mcap_messages(b"json", b"jsonschema", b"{}", [b"{"] * 100),
    "MCAP: JSON 100,000 deep": mcap_messages(b"json", b"jsonschema", b"{}", [b'{"a":' * 100_000 + b"1" + b"}" * 100_000] * 3),
    "MCAP: JSON of two columns": mcap_messages(b"json", b"jsonschema", b"{}", [b'{"a":1,"b":2}'] * 100),
    "MCAP: ten messages": mcap_messages(b"json", b"jsonschema", b"{}", [b'{"angle_rad":1,"torque_bar_nm":2}'] * 10),
    "MCAP: stamps beyond all": mcap_messages(
        b"json", b"jsonschema", b"{}", [b'{"angle_rad":1,"torque_bar_nm":2,"stamp":{"sec":1e300,"nanosec":1}}'] * 100),
    "MCAP: a clock that goes back": mcap_messages(
        b"json", b"jsonschema", b"{}",
        [b'{"angle_rad":1,"torque_bar_nm":2,"stamp":{"sec":%d,"nanosec":1}}' % (1000 - i) for i in range(100)]),
}

NUMBERS = {  # option: the command that has it
    "--duration": "simulate --task probe --out out.csv",
    "--seed": "simulate --task probe --out out.csv",
    "--unmeasured": "simulate --task probe --out out.csv",
    "--steering": "simulate --task drive --out out.csv",
    "--change-to": "simulate --task drive --change step --out out.csv",
    "--change-at": "simulate --task drive --change step --change-to 30 --out out.csv",
    "--change-over": "simulate --task drive --change ramp --change-to 30 --out out.csv",
    "--drift": "experiment --out out",
    "--unmeasured ": "experiment --out out",
    "--probe": "experiment --out out",
    "--unmeasured  ": "study faults --out out",
    "--drives": "study efficiency --out out",
    "--hours": "study tracking --out out",
    "--updates": "study soak --out out",
    "--minutes": "study validity --out out",
    "--angle-offset": "study tracking --out out",
    "--lose": "hil --emulate an386 drive.csv",
    "--damage": "hil --emulate an386 drive.csv",
    "--delay": "hil --emulate an386 drive.csv",
    "--delay-ticks": "hil --emulate an386 drive.csv",
    "--reset-at": "hil --emulate an386 drive.csv",
    "--threads": "diagnose --batch folder --out out",
}
def prediction(count=2000, angle=lambda i: 0.1 * math.sin(0.05 * i), stamp=lambda i: 0.005 * i):
    return "time_s,angle_rad\n".encode() + "".join(f"{stamp(i):.4f},{angle(i):.9g}\n" for i in range(count)).encode()


# What another simulator did not make of drive.csv.
NO_PREDICTION = {
    "nothing": b"",
    "a name alone": b"time_s,angle_rad\n",
    "other columns": b"t,theta\n0,0\n",
    "half of the record": prediction(1000),
    "another clock": prediction(stamp=lambda i: 100 + 0.005 * i),
    "milliseconds": prediction(stamp=lambda i: 5 * i),
    "ten rows a second": prediction(100, stamp=lambda i: 0.1 * i),
    "a hole": prediction(angle=lambda i: math.nan if i == 700 else 0.0),
    "degrees": prediction(angle=lambda i: 57.3 * 0.1 * math.sin(0.05 * i)),
    "a simulator that diverges": prediction(angle=lambda i: 0.1 * math.exp(0.05 * i)),
    "a wheel that rests": prediction(angle=lambda i: 0.0),
    "an infinite angle": prediction(angle=lambda i: math.inf if i == 3 else 0.0),
}

NO_NUMBERS = ["nan", "-nan", "inf", "1e999", "-1", "", "ten", "0x10", "1,5", "1e", "'1 2'"]


def numbers():
    for option, command in NUMBERS.items():
        for text in NO_NUMBERS:
            yield Case(f"{command.split()[0]} {option.strip()} {text}", f"{command} {option} {text or chr(39) * 2}",
                       BAD_USAGE)


def readers():
    for name, text in (NO_JSON | NO_SIMULATION).items():
        yield Case(f"simulation: {name}", "simulate --task probe --sim bad.json --out out.csv", BAD_DATA,
                   {"bad.json": text}, says="bad.json")
    for name, text in NO_JSON.items():
        yield Case(f"diagnose, simulation: {name}", "diagnose --real drive.csv --sim bad.json --out out", BAD_DATA,
                   {"bad.json": text}, says="bad.json")
        yield Case(f"probe: {name}", "simulate --task probe --probe bad.json --out out.csv", BAD_DATA,
                   {"bad.json": text}, says="bad.json")
        yield Case(f"column: {name}", "simulate --task drive --column bad.json --out out.csv", BAD_DATA,
                   {"bad.json": text}, says="bad.json")
    for name, text in NO_PREDICTION.items():
        yield Case(f"prediction: {name}", "diagnose --real drive.csv --pred bad.csv --out out", BAD_DATA,
                   {"bad.csv": text}, says="bad.csv")
    for value in (None, [], "x", 3, {}, {"probe": None}, {"probe": []}, {"probe": {"rms_nm": "x"}}):
        text = json.dumps({"next_experiment": value}).encode()
        yield Case(f"probe: next_experiment {value}", "simulate --task probe --probe bad.json --out out.csv", BAD_DATA,
                   {"bad.json": text}, says="bad.json")
    for name, text in NO_RECORD.items():
        yield Case(f"identify: {name}", "identify bad.csv --json out.json", BAD_DATA, {"bad.csv": text}, says="bad.csv")
        yield Case(f"diagnose: {name}", "diagnose --real bad.csv --sim sim.json --out out", BAD_DATA, {"bad.csv": text},
                   says="bad.csv")
        yield Case(f"replay: {name}", "simulate --sim sim.json --replay bad.csv --out out.csv", BAD_DATA,
                   {"bad.csv": text}, says="bad.csv")


def files():
    """Inputs that are there no longer, endless, or no files; outputs that are inputs, or have no place."""
    overwritten = [
        "identify drive.csv --json drive.csv",
        "identify drive.csv --json ./drive.csv",
        "identify drive.csv --trace link.csv",
        "identify drive.csv --report drive.csv",
        "identify drive.csv --json out.json --report out.json",
        "identify drive.csv --json out.json --trace ./out.json",
        "identify drive.csv --json - --trace -",
        "simulate --sim sim.json --replay drive.csv --out drive.csv",
        "simulate --sim sim.json --replay drive.csv --out sim.json",
        "simulate --task probe --sim sim.json --out sim.json",
        "simulate --task probe --probe probe.json --out ./probe.json",
        "diagnose --sim out/sim_with_effect.json --real drive.csv --out out",
        "hil --emulate an386 drive.csv --json drive.csv",
        "diagnose --batch nested --out nested",
        "identify --folder nested --out nested",
    ]
    record = {"link.csv": link_to("drive.csv"), "out/sim_with_effect.json": wheel(), "folder/a.csv": rows(),
              "folder/a.json": wheel(), "nested/a/log.csv": rows(40), "nested/a/sim.json": wheel(),
              "nested/a/report.html": b"my own"}
    for command in overwritten:
        yield Case(f"overwrites: {command}", command, BAD_USAGE, record)
    yield Case("a batch's record called ...csv", "diagnose --batch odd --out out/in", BAD_DATA,
               {"odd/...csv": rows(), "odd/...json": wheel()})
    for command in ("identify missing.csv", "simulate --task probe --sim missing.json --out out.csv",
                    "diagnose --real missing.csv --sim sim.json --out out", "diagnose --batch missing --out out",
                    "identify --folder missing --out out", "merge missing --out out", "hil --emulate an386 missing.csv",
                    "simulate --task drive --column missing.json --out out.csv", "identify drive.csv --json no/out.json",
                    "simulate --task probe --out no/out.csv", "identify drive.csv --report /proc/out.html",
                    "identify folder", "simulate --task probe --sim folder --out out.csv",
                    "identify drive.csv --json folder", "simulate --task probe --out folder"):
        yield Case(f"no such place: {command}", command, BAD_DATA, {"folder/a.txt": b"x"})
    endless = {"zero": link_to("/dev/zero"), "holes": sparse(4096), "fifo": os.mkfifo, "loop": link_to("loop")}
    for name, make in endless.items():
        if name != "loop":  # which is no file of a probe, and then no number
            yield Case(f"{name}: --probe", f"simulate --task probe --probe {name} --out out.csv", BAD_DATA, {name: make})
        for command in ("identify {}", "simulate --task probe --sim {} --out out.csv", "diagnose --real drive.csv --sim {} --out out",
                        "diagnose --real {} --sim sim.json --out out", "hil --emulate an386 {}", "hil drive.csv --port {}",
                        "simulate --task drive --column {} --out out.csv", "merge {} --out out"):
            yield Case(f"{name}: {command}", command.format(name), BAD_DATA, {name: make})
    for encoding in ("protobuf", "ros1"):
        yield Case(f"MCAP: {encoding}, and how it is converted", "identify bad.mcap", BAD_DATA,
                   {"bad.mcap": mcap_messages(encoding.encode(), encoding.encode(), b"x", [b"x"] * 100)},
                   says="convert it with mcap cat bad.mcap --topics /a --json | python3")
    bursts = "".join(f"{0.1 * (i // 50) + 0.0001 * (i % 50):.4f},{i % 7},{i % 5}\n" for i in range(5000))
    yield Case("bursts", "identify bad.csv", BAD_DATA,
               {"bad.csv": b"time_s,torque_bar_nm,angle_rad\n" + bursts.encode()}, says="bad.csv: expected the time at which")
    yield Case("an output pipe that nobody reads", "identify drive.csv --json fifo", BAD_DATA, {"fifo": os.mkfifo})
    for command in ("identify drive.csv", "identify drive.csv --quiet --json -", "simulate --task probe --quiet --out -",
                    "--help", "--version"):
        yield Case(f"standard output is full: {command}", command, BAD_DATA, stdout="/dev/full")
    for name in ("two\nlines.csv", "tab\there.csv", "\x1b[31mred.csv", "ä\xff.csv"):
        yield Case(f"a file called {name!r}", f"identify '{name}'", BAD_DATA)
    yield Case("a folder of links that go round", "identify --folder round --out out", BAD_DATA,
               {"round/a.csv": link_to("a.csv"), "round/b.csv": rows(40)})
    yield Case("a batch with one deep simulation", "diagnose --batch deep --out out", BAD_DATA,
               {"deep/a.csv": rows(), "deep/a.json": NO_JSON["arrays 100,000 deep"]})
    for name, text in (("nothing", b""), ("no JSON", b"key"), ("an array", b"[]"), ("no sets", b"{}"), ("null", b"null"),
                       ("sets of a number", b'{"sets":3}')):
        yield Case(f"a blind key: {name}", "study blind score --out out", BAD_DATA,
                   {"out/sealed_key.json": text, "out/key.json": text}, says="out")


def usage():
    for command in ("", "identfy drive.csv", "identify", "identify drive.csv --bogus", "identify a b", "simulate",
                    "simulate --task", "simulate --task pasive --out out.csv", "simulate --task probe",
                    "simulate --task probe --hands left --out out.csv", "simulate --task probe --effect friction --out o",
                    "simulate --task probe --noise loud --out out.csv", "simulate --task probe --eps rough --out out.csv",
                    "simulate --replay drive.csv --out out.csv", "simulate --task probe --replay drive.csv --out out.csv",
                    "diagnose", "diagnose --real drive.csv --out out", "diagnose --real drive.csv --sim sim.json",
                    "diagnose --sim sim.json --out out", "diagnose --batch . --real drive.csv --out out",
                    "diagnose --real drive.csv --sim sim.json --out out --without friction", "identify drive.csv --scalar half",
                    "identify drive.csv --torque-offset maybe", "identify drive.csv --columns angle",
                    "identify drive.csv --columns engle=angle_rad", "identify drive.csv --columns angle=angle_rad:mile",
                    "identify drive.csv --columns =", "identify drive.csv --columns angle=angle_rad,angle=angle_rad",
                    "identify drive.csv --sign torque=-1", "identify drive.csv --sign torque_motor=2", "identify drive.csv --sign 3",
                    "identify drive.csv --folder .", "identify --folder .", "identify --json-lines --folder . --out out",
                    "identify drive.csv --shard 1/2", "identify --folder . --out out --shard 3/2", "merge", "merge --out out",
                    "identify --folder . --out out --shard x", "identify --folder . --out out --shard 0/2", "study nothing",
                    "study", "study efficiency", "hil", "hil drive.csv", "hil --emulate an999 drive.csv", "experiment",
                    "simulate --task probe --out out.mcap --mcap-messages xml", "identify drive.csv --layout out.xml",
                    "identify drive.csv --trace out.csv --layout out.csv", "identify drive.csv --trace out.csv --layout drive.csv",
                    "hil --emulate an386 --port /dev/null drive.csv", "identify drive.csv --json", "--bogus"):
        yield Case(f"usage: {command}", command, BAD_USAGE)
    for line in (b"{", b"[]", b"3", b"{}", b'{"log":3}', b'{"log":"missing.csv"}', b'{"log":"two\\nlines"}'):
        yield Case(f"a request: {line.decode()}", "identify --json-lines", 0, stdin=line + b"\n")


def all_cases():
    yield from numbers()
    yield from readers()
    yield from files()
    yield from usage()
