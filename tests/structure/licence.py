#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Fails when a source file does not begin with its copyright and its licence.

    licence.py ROOT            prints each file without them; exit code 1 when there is one
    licence.py ROOT --write    writes them into those files

They are the first two lines, after a line that has to be first (a script's interpreter, a page's document type), and
an empty line parts them from the file's manual. https://spdx.dev/learn/handling-license-info
"""

import pathlib
import sys

LINES = ("SPDX-FileCopyrightText: 2026 the steerid authors", "SPDX-License-Identifier: Apache-2.0")

FOLDERS = ("firmware", "hal", "host_sim", "tests", "cmake", "scripts", ".ci")

# How a line of comment begins and ends, by the file's suffix or name. What is not here is no source: documents,
# pictures, data, and JSON, which has no comments.
HASH, SLASHES, C, HTML = ("# ", ""), ("// ", ""), ("/* ", " */"), ("<!-- ", " -->")
COMMENT = {
    ".cpp": SLASHES, ".hpp": SLASHES, ".c": SLASHES, ".h": SLASHES, ".ts": SLASHES, ".mjs": SLASHES,
    ".css": C, ".ld": C, ".html": HTML,
    ".cmake": HASH, "CMakeLists.txt": HASH, ".py": HASH, ".sh": HASH, ".service": HASH, ".rules": HASH,
    "run": HASH,
}  # fmt: skip
NOT_OURS = {"node_modules", "__pycache__"}


def sources(root):
    """Every source file of the project in `root`, with how it comments."""
    root = pathlib.Path(root)
    paths = [p for p in root.iterdir() if p.is_file()]
    for folder in FOLDERS:
        paths += [p for p in (root / folder).rglob("*") if p.is_file() and not NOT_OURS & set(p.parts)]
    for path in sorted(paths):
        name = pathlib.Path(path.name.removesuffix(".in"))  # what CMake makes a file of comments as that file does
        comment = COMMENT.get(name.name) or COMMENT.get(name.suffix)
        if comment:
            yield path, comment


def head(comment):
    return "".join(f"{comment[0]}{line}{comment[1]}\n" for line in LINES)


def split(text):
    """The line that has to be first, if there is one, and the rest."""
    first, end, rest = text.partition("\n")
    return (first + end, rest) if first.startswith("#!") or first.lower().startswith("<!doctype") else ("", text)


def lacks(text, comment):
    return not split(text)[1].startswith(head(comment) + "\n")


def licensed(text, comment):
    """`text` with its copyright and licence."""
    first, rest = split(text)
    return first + head(comment) + "\n" + rest


def main():
    root, write = sys.argv[1], "--write" in sys.argv
    missing = [(p, c) for p, c in sources(root) if lacks(p.read_text(encoding="utf-8"), c)]
    for path, comment in missing:
        print(f"{path.relative_to(root)}:1: lacks its copyright and licence")
        if write:
            path.write_text(licensed(path.read_text(encoding="utf-8"), comment), encoding="utf-8")
    return 1 if missing and not write else 0


if __name__ == "__main__":
    sys.exit(main())
