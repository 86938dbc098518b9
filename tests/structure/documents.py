#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Fails when a document links to a file or a heading that is not there, or a comment cites a decision that is not.

    documents.py ROOT     prints each breach as FILE:LINE: sentence; exit code 1 when there is one
"""

import pathlib
import re
import subprocess
import sys

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
CODE_SPAN = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)
CITED = re.compile(r"docs/adr/(\d{4})([\w.-]*)")
CODE = {".hpp", ".cpp", ".h", ".c", ".py", ".txt", ".cmake", ".sh", ".js"}


def anchors(text):
    """The names by which headings can be linked to, as GitHub makes them."""
    found, fenced = set(), False
    for line in text.splitlines():
        fenced ^= line.startswith("```")
        if line.startswith("#") and not fenced:
            heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line.lstrip("#").strip()).lower()
            name = re.sub(r"[^\w\- ]", "", heading).replace(" ", "-")
            found.add(name if name not in found else f"{name}-1")
    return found


def document_breaches(path, root):
    found = []
    # A link may be broken over two lines; its line is where it begins. In code nothing is a link.
    text = path.read_text(encoding="utf-8")
    text = CODE_SPAN.sub(lambda code: re.sub(r"[^\n]", " ", code.group()), text)
    for match in LINK.finditer(text):
        target, _, anchor = match.group(1).partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        line = text.count("\n", 0, match.start()) + 1
        there = (path.parent / target) if target else path
        if not there.exists():
            found.append(f"{path.relative_to(root)}:{line}: there is no {target}")
        elif anchor and there.suffix == ".md" and anchor not in anchors(there.read_text(encoding="utf-8")):
            found.append(f"{path.relative_to(root)}:{line}: {there.name} has no heading #{anchor}")
    return found


def citation_breaches(path, root):
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), start=1):
        for decision, rest in CITED.findall(line):
            if not any((root / "docs/adr").glob(f"{decision}-*.md")):
                found.append(f"{path.relative_to(root)}:{number}: there is no decision {decision}{rest}")
    return found


def files(root):
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, text=True, check=False)
    if listed.returncode == 0:
        return sorted(p for p in (root / name for name in listed.stdout.splitlines()) if p.is_file())
    return sorted(p for p in root.rglob("*") if p.is_file() and "build" not in p.relative_to(root).parts[0])


def breaches(root):
    root = pathlib.Path(root)
    found = []
    for path in files(root):
        if path.suffix == ".md":
            found += document_breaches(path, root)
        if path.suffix in CODE | {".md"} and path.name != "test_documents.py":
            found += citation_breaches(path, root)
    return found


def main():
    found = breaches(sys.argv[1])
    print("\n".join(found) or "every link and every cited decision is there")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
