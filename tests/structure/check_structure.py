#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Fails when a source file or a CMake link list breaks an arrow of arrows.py.

    check_structure.py ROOT     prints each breach as FILE:LINE: sentence; exit code 1 when there is one
"""

import pathlib
import re
import sys

from arrows import ARROWS, FORBIDDEN_IN_FIRMWARE, ROOMS

SOURCE_SUFFIXES = {".hpp", ".cpp", ".h", ".c"}
ROOTS = ("firmware", "hal", "host_sim")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
LIBRARY = re.compile(r"steerid_library\(\s*(\w+)\s+ROOT\s+(\w+)([^)]*)\)")

# Folders of the operating system's headers: neither ours nor a library's.
SYSTEM_FOLDERS = {"sys", "linux", "net"}

# What #include "NAME/..." stands for: the folder of that name, which is unique across the roots.
FOLDER_OF = {folder.split("/")[1]: folder for folder in ARROWS}


def breaches(root):
    """Every breach below `root`, as sorted sentences."""
    root = pathlib.Path(root)
    found = []
    for path in sorted(p for top in ROOTS for p in (root / top).rglob("*") if p.suffix in SOURCE_SUFFIXES):
        found += source_breaches(path, path.relative_to(root))
    return found + link_breaches(root)


def source_breaches(path, relative):
    folder = "/".join(relative.parts[:2])
    if folder not in ARROWS:
        return [f"{relative}:1: {folder} is not in the table of arrows.py"]
    if folder in ROOMS and relative.parts[2] not in ROOMS[folder]:
        return [f"{relative}:1: {relative.parts[2]} is no room of {folder} in the table of arrows.py"]
    text = path.read_text(encoding="utf-8")
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        match = INCLUDE.match(line)
        if match:
            sentence = include_breach(folder, match.group(2)) or room_breach(folder, relative.parts[2], match.group(2))
            if sentence:
                found.append(f"{relative}:{number}: {sentence}")
    if relative.parts[0] == "firmware":
        found += word_breaches(text, relative)
    return found


def include_breach(folder, included):
    """Why `folder` may not include `included`, or None."""
    rule = ARROWS[folder]
    first = included.split("/")[0]
    if first in FOLDER_OF and "/" in included:
        target = FOLDER_OF[first]
        return None if target == folder or first in rule.uses else f"{folder} must not see {target}"
    if "/" in included and first not in SYSTEM_FOLDERS:
        return None if first in rule.libraries else f"{folder} must not use <{included}>"
    if rule.standard is not None and included not in rule.standard:
        return f"{folder} is flashed and must not use <{included}>"
    return None


def room_breach(folder, room, included):
    """Why a room of a divided folder may not include `included`, or None."""
    parts = included.split("/")
    if folder not in ROOMS or FOLDER_OF.get(parts[0]) != folder or parts[1] == room:
        return None
    return None if parts[1] in ROOMS[folder][room] else f"{folder}/{room} must not see {folder}/{parts[1]}"


def word_breaches(text, relative):
    code = COMMENT_OR_STRING.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    found = []
    for number, line in enumerate(code.splitlines(), start=1):
        if INCLUDE.match(line):
            continue
        for word in FORBIDDEN_IN_FIRMWARE:
            match = re.search(word, line)
            if match:
                found.append(f"{relative}:{number}: '{match.group().strip()}' has no place in what is flashed")
    return found


def link_breaches(root):
    """CMake's USES lists against the table, and against what the sources include."""
    uses = {}
    found = []
    for path in sorted(p for top in ROOTS for p in (root / top).rglob("CMakeLists.txt")):
        text = re.sub(r"#[^\n]*", "", path.read_text(encoding="utf-8"))
        for name, top, rest in LIBRARY.findall(text):
            folder = f"{top}/{name}"
            linked = re.findall(r"steerid(?:_|::)(\w+)", rest.partition("USES")[2])
            uses[folder] = linked
            if folder not in ARROWS:
                found.append(f"{path.relative_to(root)}:1: {folder} is not in the table of arrows.py")
                continue
            for target in linked:
                if target not in ARROWS[folder].uses:
                    found.append(f"{path.relative_to(root)}:1: {folder} must not link steerid_{target}")
    return found + unlinked_includes(root, uses)


def unlinked_includes(root, uses):
    """Includes that compile only because someone else happens to link the folder that they come from."""
    found = []
    for folder in uses:
        reachable, pending = set(), list(uses[folder])
        while pending:
            target = pending.pop()
            if target not in reachable:
                reachable.add(target)
                pending += uses.get(FOLDER_OF.get(target), [])
        for path in sorted(p for p in (root / folder).rglob("*") if p.suffix in SOURCE_SUFFIXES - {".c"}):
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
                match = INCLUDE.match(line)
                first = match.group(2).split("/")[0] if match else ""
                if first in FOLDER_OF and "/" in match.group(2) and FOLDER_OF[first] != folder:
                    if first not in reachable:
                        found.append(f"{path.relative_to(root)}:{number}: {folder} does not link steerid_{first}")
    return found


def main():
    found = breaches(sys.argv[1])
    print("\n".join(found) or "every arrow points its way")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
