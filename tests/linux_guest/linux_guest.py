# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Runs the daemon in a Linux guest and checks what it did: lines, frames, messages, ends.

    linux_guest.py --source DIR --build DIR --steerid PROGRAM --expected-drive PROGRAM

The guest's input line 4 (sample_ready) is pulled from outside at 100 Hz; a peer inside feeds a drive over CAN and holds
every answer against the in-process run; the output lines are read back outside. Exit code 77: something that the test
needs is not installed here, named aloud.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time

import initramfs
from guest_packages import GuestPackages, Unavailable
from qemu_guest import QemuGuest

SAMPLE_READY, PROBE_ENABLE, VALID, FAULT, HEARTBEAT, ON_THE_BUS = 4, 5, 6, 7, 0, 2
PERIOD_S = 0.01
SAFE = {VALID: 0, FAULT: 1, HEARTBEAT: 0}
DRIVE_S = 20
BURST = 40  # edges, of which the kernel's queue keeps 16
LONGEST_S = 240  # the guest ends by itself long before, unless the machine is busy
HERE = pathlib.Path(__file__).parent


def configs():
    chip = "gpiochip0"
    lines = {name: {"chip": chip, "line": line} for name, line in (
        ("sample_ready", SAMPLE_READY), ("probe_enable", PROBE_ENABLE), ("valid", VALID), ("fault", FAULT),
        ("heartbeat", HEARTBEAT))}
    good = {"can": "vcan0", "lines": lines, "state_file": "/tmp/state", "priority": 50}

    def with_line(entry):
        return {**good, "lines": {**lines, "valid": entry}}

    return {
        "good": good,
        "other_state": {**good, "state_file": "/tmp/nobody"},
        "timer": {**good, "lines": {k: v for k, v in lines.items() if k != "sample_ready"}},
        "no_chip": with_line({"chip": "gpiochip7", "line": 1}),
        "no_line": with_line({"chip": chip, "line": 99}),
        "no_name": with_line({"line": "VALID_TO_EPS"}),
        "no_can": {**good, "can": "can9"},
        "bad_key": {**good, "colour": "red"},
        "bad_bias": with_line({"chip": chip, "line": 1, "bias": "sideways"}),
    }


class Build:
    """What goes into the guest."""

    def __init__(self, arguments):
        self.folder = pathlib.Path(arguments.build)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.source = pathlib.Path(arguments.source)
        self.packages = GuestPackages(self.folder / "packages_arm64")
        self.packages.unpack()
        self._cross_compile()
        drive, expected = self.folder / "drive.csv", self.folder / "drive.txt"
        subprocess.run([arguments.steerid, "simulate", "--task", "probe", "--hands", "both_3_9", "--duration",
                        str(DRIVE_S), "--seed", "5", "--out", drive], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([arguments.expected_drive, drive, expected], check=True)
        self.image = self.folder / "initramfs.cpio"
        files = {"init": HERE / "guest/init.sh", "drive.txt": expected, "bin/busybox": self.packages.busybox(),
                 "bin/steerid-ecu": self.guest_build / "steerid/steerid-ecu", "bin/peer": self.guest_build / "peer",
                 "etc/passwd": b"root:x:0:0::/:/bin/sh\nnobody:x:65534:65534::/:/bin/sh\n",
                 "etc/group": b"root:x:0:\nnogroup:x:65534:\n"}
        for module in ("can", "can-raw", "can-dev", "vcan"):
            files[f"modules/{module}.ko"] = self.packages.module(module)
        for name, config in configs().items():
            files[f"configs/{name}.json"] = json.dumps(config, indent=2).encode()
        initramfs.write(self.image, files)

    def _cross_compile(self):
        self.guest_build = self.folder / "build"
        environment = {**os.environ, **self.packages.pkg_config()}
        steps = (["cmake", "-S", HERE / "guest", "-B", self.guest_build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                  f"-DCMAKE_TOOLCHAIN_FILE={self.source / 'cmake/aarch64-linux-gnu.cmake'}"],
                 ["cmake", "--build", self.guest_build, "--target", "steerid-ecu", "peer"])
        for step in steps:
            done = subprocess.run(step, env=environment, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"building for the guest failed:\n{done.stdout}\n{done.stderr}")


class Edges:
    """Pulls sample_ready: not at all, at 100 Hz, or at 100 Hz at most whenever the peer has put a sample on the bus."""

    def __init__(self, guest):
        self._guest = guest
        self._mode = "off"
        self._followed = 0
        self._lock = threading.Lock()
        threading.Thread(target=self._pull, daemon=True).start()

    def switch(self, mode):
        self._followed = self._samples_on_the_bus()
        self._mode = mode

    def pulse(self):
        with self._lock:
            self._guest.pulse(SAMPLE_READY)

    def _samples_on_the_bus(self):
        return self._guest.counts.get(ON_THE_BUS, 0)

    def _wanted(self):
        if self._mode != "follow":
            return self._mode == "on"
        on_the_bus = self._samples_on_the_bus()
        new = on_the_bus != self._followed
        self._followed = on_the_bus
        return new

    def _pull(self):
        due = time.monotonic()
        while not self._guest.ended():
            now = time.monotonic()
            if now < due or not self._wanted():
                time.sleep(max(0.0005, min(due - now, PERIOD_S)))
                continue
            self.pulse()
            due = max(due + PERIOD_S, now - PERIOD_S)


def run(build):
    """The guest from start to end: its levels at each step, its console, how often each output changed."""
    levels, seen = {}, []
    begin = time.monotonic()
    with QemuGuest(build.packages.kernel_image(), build.image, build.folder) as guest:
        edges = Edges(guest)
        while time.monotonic() - begin < LONGEST_S:
            line = guest.next_line(0.5)
            if line is None:
                if guest.ended():
                    break
                continue
            seen.append(line)
            words = line.split()
            if words[:2] == ["STEP", "edges"]:
                edges.switch(words[2])
            elif words[:2] == ["STEP", "levels"]:
                time.sleep(0.1)
                levels[words[2]] = dict(guest.outputs)
            elif words[:2] == ["STEP", "burst"]:
                for _ in range(BURST):
                    edges.pulse()
            elif words[:2] == ["STEP", "end"]:
                break
        return levels, seen, dict(guest.counts), time.monotonic() - begin


class Findings:
    def __init__(self, levels, seen, counts):
        self.levels, self.seen, self.counts = levels, seen, counts
        self.failures = 0

    def expect(self, truth, what):
        print(("ok      " if truth else "FAILED  ") + what)
        self.failures += 0 if truth else 1

    def says(self, name, *texts):
        said = "\n".join(line for line in self.seen if line.startswith((f"CHECK {name}:", f"LOG {name}:")))
        for text in texts:
            self.expect(text in said, f"{name}: says '{text}'")

    def is_safe(self, step):
        got = self.levels.get(step, {})
        self.expect(all(got.get(line, 0) == level for line, level in SAFE.items()), f"{step}: outputs are safe: {got}")

    def number(self, prefix, word):
        """The number after `word` in the first line that holds `prefix`, or None."""
        for line in self.seen:
            words = line.replace(",", " ").replace(";", " ").split()
            if prefix in line and word in words[:-1]:
                return int(words[words.index(word) + 1])
        return None


def check(found):
    found.says("no_chip", "cannot open GPIO chip gpiochip7", "exit 1")
    found.says("no_line", "no line 99 of gpiochip0", "exit 1")
    found.says("no_name", "has a line named VALID_TO_EPS", "exit 1")
    found.says("no_can", "cannot use CAN interface can9", "exit 1")
    found.says("bad_key", "colour is not known here", "exit 1")
    found.says("bad_bias", "lines.valid.bias must be", "exit 1")
    found.says("busy", "line 4 of gpiochip0 is in use by steerid-ecu", "exit 1")
    found.says("denied", "Permission denied", "udev rule", "exit 1")
    found.says("good", "the config is good", "exit 0")
    found.says("usage", "exit 2")

    samples = found.number("PEER samples", "samples")
    found.expect(samples is not None and samples >= DRIVE_S * 100 - 1, f"drive: {samples} samples fed over CAN")
    found.expect(found.number("PEER samples", "differ") == 0, "drive: every frame has the bits of the in-process run")
    found.expect(found.number("PEER samples", "unanswered") == 0, "drive: every sample was answered")
    beats = found.counts.get(HEARTBEAT, 0)
    found.expect(beats >= DRIVE_S * 100, f"heartbeat: changed {beats} times, read outside the guest")
    found.says("drive", "SIGHUP refused", "stopped as asked", "exit 0")
    counts = [line.split()[-1] for line in found.seen if line.startswith("LOG drive: allocations")]
    found.expect(len(counts) == 2 and counts[0] == counts[1], f"drive: no allocation while it ran: {counts}")
    latency = [line for line in found.seen if "edge to heartbeat" in line]
    found.expect(bool(latency), "drive: latency recorded (an emulator's): " + (latency[0] if latency else "none"))

    found.says("restart", "restored the last estimate", "vcan0 takes no frames", "vcan0 takes frames again", "exit 0")
    found.expect(found.levels.get("can_down", {}).get(FAULT) == 1, "can_down: fault is high")
    missed = found.number("LOG restart: ticks", "missed")
    found.expect(missed is not None and missed >= 15, f"restart: edges of a standstill are counted: {missed}")

    before = found.levels.get("before_kill", {})
    found.expect(before.get(VALID) == 1 and before.get(FAULT) == 0, f"before_kill: valid high, fault low: {before}")
    for step in ("after_kill", "after_hang", "after_guard_died", "after_guard_stopped"):
        found.is_safe(step)
    found.says("killed", "seen 'safe levels'")
    found.says("hung", "seen 'safe levels'")
    found.says("alone", "guard process is gone", "exit 3")
    found.says("unguarded", "guard process is gone or stands still", "exit 3")
    found.expect("CHECK unguarded: guards left:" in [line.strip() for line in found.seen], "unguarded: no guard is left")
    found.says("make_safe", "the outputs are at their safe levels", "exit 0")
    found.says("make_safe_busy", "not every output could be driven", "line 6 of gpiochip0 is in use", "exit 1")
    found.says("timer", "ticks by timer", "exit 0")
    ticks, taken = found.number("LOG timer: ticks", "ticks"), found.number("LOG timer: ticks", "samples")
    found.expect(ticks is not None and ticks >= 90 and taken >= 80, f"timer: {ticks} ticks, {taken} samples")
    found.says("unplugged", "no longer answers", "exit 0")
    found.expect("STEP end" in found.seen, "the guest came to its end by itself")


def main():
    parser = argparse.ArgumentParser()
    for name in ("--source", "--build", "--steerid", "--expected-drive"):
        parser.add_argument(name, required=True)
    arguments = parser.parse_args()
    for program in ("qemu-system-aarch64", "aarch64-linux-gnu-g++"):
        if not shutil.which(program):
            print(f"SKIPPED: {program} is not installed")
            return 77
    try:
        build = Build(arguments)
    except Unavailable as why:
        print(f"SKIPPED: the guest's packages cannot be had: {why}")
        return 77
    levels, seen, counts, seconds = run(build)
    found = Findings(levels, seen, counts)
    check(found)
    print(f"the guest ran {seconds:.0f} s; {found.failures} failures")
    if found.failures:
        print("\nconsole:\n" + "\n".join(seen))
    return 1 if found.failures else 0


if __name__ == "__main__":
    sys.exit(main())
