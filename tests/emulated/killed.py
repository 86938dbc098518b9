# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""An emulator ends with the `steerid hil` that started it, also where that is killed and can end nothing itself.

usage: killed.py BUILD an386|an385
"""

import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time


def within_s(seconds, holds):
    """What `holds` gives once that is true; what it gives at the end otherwise."""
    until = time.monotonic() + seconds
    while not (found := holds()) and time.monotonic() < until:
        time.sleep(0.02)
    return found


def emulator_of(parent):
    for child in pathlib.Path(f"/proc/{parent}/task/{parent}/children").read_text(encoding="ascii").split():
        if pathlib.Path(f"/proc/{child}/comm").read_text(encoding="ascii").startswith("qemu"):
            return int(child)
    return None


def runs(process):
    try:
        state = pathlib.Path(f"/proc/{process}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"  # ended; nobody has asked yet how


def main():
    build, board = pathlib.Path(sys.argv[1]), sys.argv[2]
    if shutil.which("qemu-system-arm") is None or not (build / "firmware" / f"steerid-{board}.elf").exists():
        print("skipped: no qemu-system-arm, or no image: the Arm compiler was not there")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        drive = pathlib.Path(folder, "drive.csv")
        subprocess.run([build / "steerid", "simulate", "--task", "probe", "--duration", "60", "--out", drive],
                       check=True, stdout=subprocess.DEVNULL)
        hil = subprocess.Popen([build / "steerid", "hil", "--emulate", board, drive],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        emulator = within_s(30, lambda: emulator_of(hil.pid))
        assert emulator is not None, "no emulator was started"
        hil.send_signal(signal.SIGKILL)
        hil.wait()
        assert within_s(30, lambda: not runs(emulator)), f"the emulator {emulator} outlives the program"
    return 0


if __name__ == "__main__":
    sys.exit(main())
