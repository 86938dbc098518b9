# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""An initramfs as the kernel takes it: a cpio archive of format newc (Documentation/driver-api/early-userspace)."""

import os
import pathlib


def write(path, files):
    """`files` maps names in the guest to a file here or to bytes; everything is executable and root's."""
    folders = {parent for name in files for parent in map(str, pathlib.PurePath(name).parents) if parent != "."}
    with open(path, "wb") as out:
        number = 1
        for folder in sorted(folders):
            _entry(out, number, folder, 0o040755, b"")
            number += 1
        for name, contents in files.items():
            data = contents if isinstance(contents, bytes) else pathlib.Path(contents).read_bytes()
            _entry(out, number, name, 0o100755, data)
            number += 1
        _entry(out, number, "TRAILER!!!", 0, b"")


def _entry(out, number, name, mode, data):
    encoded = os.fsencode(name) + b"\0"
    fields = (number, mode, 0, 0, 1, 0, len(data), 0, 0, 0, 0, len(encoded), 0)
    header = b"070701" + b"".join(b"%08X" % field for field in fields) + encoded
    out.write(header + bytes(-len(header) % 4) + data + bytes(-len(data) % 4))
