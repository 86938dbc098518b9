# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Debian's arm64 packages for the guest: kernel, busybox and libgpiod, unpacked below a folder.

apt keeps its state for them in that folder, so that the machine's own list of architectures and packages stays as it
is. The kernel's exact name is what linux-image-arm64 depends on at the time.
"""

import pathlib
import re
import shutil
import subprocess

WANTED = ["busybox-static", "libgpiod-dev"]


class Unavailable(Exception):
    """The packages cannot be had here; says why."""


class GuestPackages:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.root = self.folder / "root"
        self._options = ["-o", "APT::Architecture=arm64", "-o", "APT::Architectures=arm64",
                         "-o", "Acquire::Languages=none"]
        for name, place in (("State", "state"), ("State::lists", "lists"), ("State::status", "state/status"),
                            ("Cache", "cache")):
            self._options += ["-o", f"Dir::{name}={self.folder / place}"]

    def unpack(self):
        """Downloads and unpacks what is not there yet."""
        done = self.folder / "complete"
        if done.exists():
            return
        if not shutil.which("apt-get") or not shutil.which("dpkg"):
            raise Unavailable("this is not a Debian: no apt-get")
        for place in ("state", "lists/partial", "cache/archives/partial", "packages", "root"):
            (self.folder / place).mkdir(parents=True, exist_ok=True)
        (self.folder / "state/status").touch()
        self._run("apt-get", "update", "-q")
        self._run("apt-get", "download", "-q", self._kernel(), *WANTED)
        for package in sorted((self.folder / "packages").glob("*.deb")):
            subprocess.run(["dpkg", "-x", package, self.root], check=True)
        done.touch()

    def _kernel(self):
        depends = self._run("apt-cache", "depends", "linux-image-arm64")
        found = re.search(r"Depends: (linux-image-\S+)", depends)
        if not found:
            raise Unavailable("linux-image-arm64 depends on no kernel")
        return found.group(1)

    def _run(self, program, *arguments):
        result = subprocess.run([program, *self._options, *arguments], cwd=self.folder / "packages",
                                capture_output=True, text=True)
        if result.returncode != 0:
            raise Unavailable(f"{program} {arguments[0]}: {result.stderr.strip()[-300:]}")
        return result.stdout

    def kernel_image(self):
        return next((self.root / "boot").glob("vmlinuz-*"))

    def module(self, name):
        return next((self.root / "lib/modules").rglob(f"{name}.ko"))

    def busybox(self):
        return self.root / "bin/busybox"

    def pkg_config(self):
        """Environment under which pkg-config finds the guest's libgpiod."""
        return {"PKG_CONFIG_LIBDIR": str(self.root / "usr/lib/aarch64-linux-gnu/pkgconfig"),
                "PKG_CONFIG_SYSROOT_DIR": str(self.root)}
