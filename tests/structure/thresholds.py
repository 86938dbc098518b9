#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Fails when a constant of the diagnosis is not in the table of docs/thresholds.md as it stands in the code.

    thresholds.py ROOT     prints each breach as FILE:LINE: sentence; exit code 1 when there is one

A constant is what is declared const or constexpr by a name like kName. Its row states file, value, unit, what it
decides and where its value comes from. A value that a script writes stands in its file alone; its row links to the
document that the script writes beside it.
"""

import dataclasses
import pathlib
import re
import sys

CODE = "host_sim/gap"
TABLE = "docs/thresholds.md"
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|("(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\')', re.DOTALL)
CONSTANT = re.compile(
    r"\bconst(?:expr)?\b[^;(){}=]*?\b(k[A-Z]\w*)(?:\[\w*\])?\s*(?==(?!=)|\{)=?\s*((?:\"(?:\\.|[^\"\\\n])*\"|[^;\"])*);"
)
ROW = re.compile(r"^\| `(k[A-Z]\w*)` \(`([^`]+)`\) \|(.*)\|$")
WRITTEN_BY_SCRIPT = re.compile(r"Written by scripts/\w+")


@dataclasses.dataclass(frozen=True)
class Stated:
    """A constant with its value as the code or the table states it; `place` is FILE:LINE."""

    file: str
    name: str
    value: str
    place: str


def constants(root):
    """Every constant of the diagnosis, in order of files and lines."""
    found = []
    for path in sorted(p for p in (root / CODE).rglob("*") if p.suffix in {".hpp", ".cpp"}):
        text = path.read_text(encoding="utf-8")
        by_script = WRITTEN_BY_SCRIPT.search(text)
        code = COMMENT_OR_STRING.sub(lambda match: match.group(1) or "\n" * match.group().count("\n"), text)
        for match in CONSTANT.finditer(code):
            value = "" if by_script else " ".join(match.group(2).split())
            line = code.count("\n", 0, match.start()) + 1
            file = str(path.relative_to(root / CODE))
            found.append(Stated(file, match.group(1), value, f"{CODE}/{file}:{line}"))
    return found


def rows(root):
    """Every row of the table that names a constant, and the breaches of its form."""
    found, broken = [], []
    for number, line in enumerate((root / TABLE).read_text(encoding="utf-8").splitlines(), start=1):
        if not line.startswith("| `"):
            continue
        place = f"{TABLE}:{number}"
        match = ROW.match(line)
        cells = [cell.strip() for cell in match.group(3).split("|")] if match else []
        if len(cells) != 4 or not all(cells):
            broken.append(f"{place}: a row is | `kName` (`file`) | value | unit | what it decides | source |")
            continue
        linked = re.fullmatch(r"\[[^\]]+\]\([^)]+\)", cells[0])
        value = "" if linked else cells[0].strip("`")
        found.append(Stated(match.group(2), match.group(1), value, place))
    return found, broken


def breaches(root):
    root = pathlib.Path(root)
    in_code = constants(root)
    in_table, found = rows(root)
    # What stands in both with one value is settled. A name may stand in one file more than once.
    left = list(in_table)
    unsettled = []
    for constant in in_code:
        same = [row for row in left if (row.file, row.name, row.value) == (constant.file, constant.name, constant.value)]
        if same:
            left.remove(same[0])
        else:
            unsettled.append(constant)
    for constant in unsettled:
        named = [row for row in left if (row.file, row.name) == (constant.file, constant.name)]
        if named:
            left.remove(named[0])
            stands = constant.value or "what a script writes, and its row a link"
            found.append(f"{named[0].place}: {constant.name} is {named[0].value or 'a link'}; in the code it is {stands}")
        else:
            found.append(f"{constant.place}: {constant.name} is missing in {TABLE}")
    found += [f"{row.place}: there is no {row.name} in {CODE}/{row.file}" for row in left]
    return found


def main():
    root = pathlib.Path(sys.argv[1])
    found = breaches(root)
    print("\n".join(found) or f"{TABLE} states all {len(constants(root))} constants of {CODE}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
