#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Holds the JSON that the command writes, and the templates that it reads, against docs/schemas.

    check_schemas.py STEERID SCHEMAS                     runs the commands
    check_schemas.py STEERID SCHEMAS experiment.json     an experiment that was run already
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


def check(name, document):
    """Fails when the document does not match; and when a schema of its own keys would not notice a missing one."""
    global found
    schema = json.loads((schemas / f"{name}.schema.json").read_text(encoding="utf-8"))
    validator = jsonschema.Draft202012Validator if hasattr(jsonschema, "Draft202012Validator") else jsonschema.Draft7Validator
    validator.check_schema(schema)
    for error in validator(schema).iter_errors(document):
        print(f"{name}: {list(error.absolute_path)}: {error.message[:300]}")
        found += 1
    for key in schema["required"]:
        if validator(schema).is_valid({k: v for k, v in document.items() if k != key}):
            print(f"{name}: nobody would miss {key}")
            found += 1
    print(f"{name}: {len(document)} keys")


def load(path):
    """JSON with lines of comment, as the templates have them."""
    text = re.sub(r"(^|[\s,{])//[^\n]*", r"\1", path.read_text(encoding="utf-8"))
    return json.loads(text)


def main():
    if len(sys.argv) > 3:
        check("experiment", load(pathlib.Path(sys.argv[3])))
        return
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def steerid(*words):
            subprocess.run([program, *words, "--quiet"], cwd=folder, check=True)

        for kind, schema in (("sim", "simulation"), ("column", "column")):
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
        steerid("simulate", "--sim", "sim.json", "--replay", "drive.csv", "--out", "pred.csv")
        steerid("diagnose", "--real", "drive.csv", "--pred", "pred.csv", "--out", "foreign", "--no-report")
        check("diagnosis", load(folder / "foreign/diagnosis.json"))


main()
sys.exit(1 if found else 0)
