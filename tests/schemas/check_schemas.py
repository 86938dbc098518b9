#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Holds the JSON that the command writes, and the templates that it reads, against docs/schemas.

    check_schemas.py STEERID SCHEMAS                     runs the commands
    check_schemas.py STEERID SCHEMAS KIND FILE           a file that was written already, as experiment.json
    check_schemas.py STEERID SCHEMAS studies FOLDER      a folder for each study, of runs that were made already
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema

program, schemas = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
found = 0
seen = set()


def check(name, document, part=None):
    """Fails when the document does not match; and when a schema of its own keys would not notice a missing one. Of a
    schema with a part for each kind of line, `part` names it."""
    global found
    seen.add((name, part))
    schema = json.loads((schemas / f"{name}.schema.json").read_text(encoding="utf-8"))
    if part is not None:
        schema = schema["$defs"][part]
    validator = jsonschema.Draft202012Validator if hasattr(jsonschema, "Draft202012Validator") else jsonschema.Draft7Validator
    validator.check_schema(schema)
    for error in validator(schema).iter_errors(document):
        print(f"{name}: {list(error.absolute_path)}: {error.message[:300]}")
        found += 1
    for key in schema["required"]:
        if validator(schema).is_valid({k: v for k, v in document.items() if k != key}):
            print(f"{name}: nobody would miss {key}")
            found += 1


def load(path):
    """JSON with lines of comment, as the templates have them."""
    text = re.sub(r"(^|[\s,{])//[^\n]*", r"\1", path.read_text(encoding="utf-8"))
    return json.loads(text)


def check_lines(file, part):
    """A fleet's table; how many lines it has."""
    lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    for line in lines:
        check("fleet", line, part)
    return len(lines)


def check_fleet(steerid, folder):
    """Twelve vehicles of two records each, one of which is unlike the others, and a log that is none."""
    rows = ["record,vehicle,date,mileage_km"]
    for i in range(24):
        name, inertia = f"r{i}", 0.2 if i // 2 == 5 else 0.11
        sim = {"inertia_kgm2": inertia, "damping_nms_per_rad": 1.5, "stiffness_nm_per_rad": 22.7 + i // 2 + i % 2}
        (folder / "fleet" / name).mkdir(parents=True)
        (folder / "fleet" / name / "sim.json").write_text(json.dumps(sim))
        steerid("simulate", "--task", "probe", "--duration", "10", "--seed", str(i), "--sim", f"fleet/{name}/sim.json",
                "--out", f"fleet/{name}/log.csv")
        rows.append(f"{name},v{i // 2},2026-{1 + i % 2 * 5:02}-0{1 + i % 9},{1000 * i}")
    (folder / "fleet" / "bad").mkdir()
    (folder / "fleet" / "bad" / "log.csv").write_text("no log")
    rows.append("bad,v9,2026-01-01,1")
    (folder / "list.csv").write_text("\n".join(rows) + "\n")
    steerid("identify", "--folder", "fleet", "--list", "list.csv", "--out", "found", "--no-report", ends=1)
    tables = folder / "found" / "fleet"
    checked = {table.stem: check_lines(table, table.stem) for table in tables.glob("*.jsonl")}
    empty = {name for name, lines in checked.items() if not lines}
    assert checked["records"] == 25 and empty <= {"changes", "unknown"}, checked  # which are of diagnoses, below
    steerid("identify", "--folder", "fleet", "--out", "part", "--shard", "1/3", "--no-report", ends=None)
    first, *lines = (folder / "part/fleet/shard_1_of_3.jsonl").read_text(encoding="utf-8").splitlines()
    check("fleet", json.loads(first), "shard")
    for line in lines:
        check("fleet", json.loads(line), "records")
    # A wheel that no effect of what is left of the vocabulary explains.
    steerid("diagnose", "--batch", "car", "--sim", "sim.json", "--out", "gaps", "--no-report", "--without",
            "coulomb_friction,stribeck_friction,asymmetric_friction,presliding_hysteresis,backlash,quadratic_damping")
    assert check_lines(folder / "gaps/fleet/changes.jsonl", "changes") > 0
    assert check_lines(folder / "gaps/fleet/unknown.jsonl", "unknown") > 0


def check_blind(folder, opened):
    """The sealed key beside what was scored, and a key that lies open."""
    check("blind", load(folder / "blind.json"))
    check("blind_key", load(folder / "sealed" / "key.json"), "sealed")
    for case in load(opened).values():
        check("blind_key", case, "case")


def check_studies(folder):
    """Every study, each in a folder of its name; all but `study validity`, whose shortest run takes more than a minute
    and whose files one writer makes with those of the other findings."""
    part = {"efficiency": "steady", "uncertainty": "steady", "closed_loop": "closed_loop"}
    for name in (*part, "column", "excitation", "tracking", "hands", "faults", "soak"):
        check("study", load(folder / name / f"{name}.json"), part.get(name, "findings"))


def check_lines_of_json(folder):
    """Requests and answers of --json-lines: one that is answered and one that cannot be."""
    asked = {"identify": [{"log": "drive.csv"}, {"id": "b", "log": "missing.csv"}],
             "diagnose": [{"real": "drive.csv", "sim": "sim.json"}, {"id": [2], "real": "drive.csv", "sim": "missing.json"}]}
    for command, requests in asked.items():
        for request in requests:
            check("lines", request, f"{command}_request")
        ended = subprocess.run([program, command, "--json-lines"], input="".join(json.dumps(r) + "\n" for r in requests),
                               cwd=folder, capture_output=True, text=True, check=True)
        answers = [json.loads(line) for line in ended.stdout.splitlines()]
        assert [answer["ended"] for answer in answers] == ["answered", "unusable"], answers
        for answer in answers:
            check("lines", answer, "answer")
        check({"identify": "identification", "diagnose": "diagnosis"}[command], answers[0]["answer"])


def main():
    if len(sys.argv) > 3:
        if sys.argv[3] == "studies":
            check_studies(pathlib.Path(sys.argv[4]))
            return
        check(sys.argv[3], load(pathlib.Path(sys.argv[4])))
        return
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def steerid(*words, ends=0):
            """Ends with that exit code; None for any that is no crash."""
            ended = subprocess.run([program, *words, "--quiet"], cwd=folder, stderr=None if ends == 0 else subprocess.DEVNULL)
            assert ended.returncode == ends or (ends is None and ended.returncode in (0, 1)), (words, ended.returncode)

        for kind, schema in (("sim", "simulation"), ("column", "column"), ("daemon", "daemon")):
            steerid("template", kind, "--out", f"{kind}.json")
            check(schema, load(folder / f"{kind}.json"))
        steerid("simulate", "--task", "probe", "--duration", "20", "--effect", "coulomb_friction", "--out", "drive.csv")
        steerid("identify", "drive.csv", "--batch", "--json", "answer.json")
        check("identification", load(folder / "answer.json"))
        (folder / "car/a").mkdir(parents=True)
        steerid("simulate", "--task", "drive", "--duration", "20", "--out", "car/a/log.csv")
        steerid("identify", "--folder", "car", "--out", "answers", "--no-report")
        check("identification", load(folder / "answers/a/identification.json"))
        steerid("diagnose", "--real", "drive.csv", "--sim", "sim.json", "--out", "gap", "--no-report")
        check("diagnosis", load(folder / "gap/diagnosis.json"))
        check("simulation", load(folder / "gap/sim_with_effect.json"))
        steerid("inspect", "drive.csv", "--json", "inspection.json")
        check("inspection", load(folder / "inspection.json"))
        check_lines_of_json(folder)
        steerid("study", "blind", "--cases", "3", "--seed", "7", "--out", "blind")
        steerid("study", "blind", "draw", "--cases", "3", "--seed", "7", "--out", "open")
        check_blind(folder / "blind", folder / "open/key.json")
        (folder / "car/a/log.csv").write_bytes((folder / "drive.csv").read_bytes())
        check_fleet(steerid, folder)
        steerid("simulate", "--sim", "sim.json", "--replay", "drive.csv", "--out", "pred.csv")
        steerid("diagnose", "--real", "drive.csv", "--pred", "pred.csv", "--out", "foreign", "--no-report")
        check("diagnosis", load(folder / "foreign/diagnosis.json"))
        steerid("simulate", "--task", "probe", "--duration", "20", "--effect", "coulomb_friction", "--seed", "2", "--out",
                "drive2.csv")
        steerid("diagnose", "--real", "drive.csv", "--real", "drive2.csv", "--sim", "sim.json", "--out", "both",
                "--no-report")
        check("diagnosis", load(folder / "both/diagnosis.json"))


main()
print("held against their schemas:", ", ".join(" ".join(filter(None, one)) for one in sorted(seen, key=str)))
sys.exit(1 if found else 0)
