# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The watchdog of an emulated board bites: the very image that is flashed is made to hang by its debugging port, and the
watchdog resets the board, and the board says so and goes on from its saved estimate.

usage: watchdog.py BUILD an386|an385 [hil]
With hil it is `steerid hil` in real time that sees the reset, from the other end of a pseudo terminal.
"""

import contextlib
import json
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time

import link

BRANCH_TO_ITSELF, RETURN = 0xE7FE, 0x4770  # Thumb: b . and bx lr
WAIT_FOR_INTERRUPT, NO_OPERATION = 0xBF30, 0xBF00
PT_LOAD = 1  # an ELF file's segment that is loaded
WATCHDOG, RESTORED = 1, 1
HOLDING, VALID = 3, 2


def address_of(image, name):
    for line in subprocess.run(
        ["arm-none-eabi-nm", "--demangle", image], capture_output=True, text=True, check=True
    ).stdout.splitlines():
        address, _, title = line.split(None, 2)
        if title == name:
            return int(address, 16)
    raise AssertionError(f"{image} has no {name}")


def sleepless(image, folder):
    """A copy of the image whose processor waits awake. The emulator's clock counts instructions, but while the
    processor sleeps it jumps by as long as the host was busy otherwise: past the tick and the watchdog at once."""
    sleep, code = address_of(image, "steerid::mps2::Board::sleep()"), bytearray(image.read_bytes())
    (headers,), (size, count) = struct.unpack_from("<I", code, 28), struct.unpack_from("<HH", code, 42)
    segments = [struct.unpack_from("<IIIII", code, headers + size * n) for n in range(count)]
    (begin,) = (
        at + sleep - load for kind, at, _, load, stored in segments if kind == PT_LOAD and load <= sleep < load + stored
    )
    wait = code.index(struct.pack("<H", WAIT_FOR_INTERRUPT), begin)
    assert wait - begin < 64, "Board::sleep() no longer begins with its wait"
    struct.pack_into("<H", code, wait, NO_OPERATION)
    awake = folder / "awake.elf"
    awake.write_bytes(code)
    return awake


@contextlib.contextmanager
def board(image, machine, folder, line):
    """A board that is not started yet; yields its debugging port. Instructions alone are its clock, so that a busy
    host cannot make the watchdog bite."""
    debug = folder / "debug"
    emulator = subprocess.Popen(
        ["qemu-system-arm", "-M", machine, "-display", "none", "-monitor", "none", "-icount", "shift=5,sleep=on",
         "-echr", "256", "-chardev", f"{line},id=line,mux=on", "-serial", "chardev:line",
         "-gdb", f"unix:{debug},server=on,wait=off", "-S", "-kernel", str(sleepless(image, folder))],
        stdout=(folder / "said").open("w"), stderr=subprocess.STDOUT,
    )
    try:
        while not debug.exists():
            assert emulator.poll() is None, (folder / "said").read_text()
            time.sleep(0.01)
        yield link.Debugger(debug)
    finally:
        emulator.terminate()
        emulator.wait()


def learn(line):
    """11 s of a drive that the link paces; the estimate is saved at 10 s. The wheel: C 20, B 1.5, J 0.1 in steps of
    a millisecond, under three tones. Returns the last estimate."""
    line.send(link.START, bytes([link.LINK_PACE]))
    line.expect(link.START)
    angle = rate = 0.0
    for k in range(1, 1101):
        for step in range(10):
            t = (k - 1) * 0.01 + step * 0.001
            torque = sum(math.sin(2 * math.pi * f * t) for f in (0.4, 1.3, 3.1))
            rate += 0.001 * (torque - 1.5 * rate - 20 * angle) / 0.1
            angle += 0.001 * rate
        torque = sum(math.sin(2 * math.pi * f * k * 0.01) for f in (0.4, 1.3, 3.1))
        line.sample(k * 10_000, round(angle * 1e6), round(torque * 1e3))
        estimate = line.expect(link.ESTIMATE)
    return estimate


def stiffness(estimate):
    value, deviation, state = struct.unpack_from("<iiB", estimate, 26)
    return value * 1e-6, deviation * 1e-6, state


def hang(debugger, image, how):
    at = {name: address_of(image, f"steerid::mps2::Board::{name}{arguments}")
          for name, arguments in (("ticked", "()"), ("set_lines", "(bool, bool)"))}
    if how == "loop":
        debugger.patch(at["set_lines"], BRANCH_TO_ITSELF)
        # The loop hangs and the timer's interrupt goes on: until the watchdog's first time-out, 100 ms after the last
        # kick, which holds everything up, and resets with its second.
        reset, ticks = address_of(image, "reset_handler"), 0
        while debugger.run_to(at["ticked"], reset) != reset:
            ticks += 1
        assert 9 <= ticks <= 11, ticks
    elif how == "interrupt":
        debugger.patch(at["ticked"], BRANCH_TO_ITSELF)
    elif how == "timer":
        debugger.patch(at["ticked"], RETURN)


def bites(image, machine, folder, how):
    path = folder / "line"
    with board(image, machine, folder, f"socket,path={path},server=on,wait=off") as debugger:
        line = link.Line(path)
        debugger.go()
        _, _, cause, restored = line.expect(link.HELLO)
        assert (cause, restored) == (0, 0)
        value, _, state = stiffness(learn(line))
        assert state == VALID and abs(value - 20) < 1, (value, state)

        line.send(link.START, bytes([link.TIMER_PACE]))
        line.expect(link.START)
        # A healthy loop is left alone for two seconds, ten times what the watchdog needs.
        for _ in range(2):
            health = line.expect(link.HEALTH)
        ticks, late, missed = struct.unpack_from("<III", health)
        assert ticks == 200, ticks
        debugger.stop()
        hang(debugger, image, how)
        debugger.go()

        _, _, cause, restored = line.expect(link.HELLO)
        assert (cause, restored) == (WATCHDOG, RESTORED), (how, cause, restored)
        # The code is loaded again at a reset, as from flash: the board works, from its saved estimate.
        line.send(link.START, bytes([link.LINK_PACE]))
        line.expect(link.START)
        line.sample(10_000, 0, 0)
        again, _, state = stiffness(line.expect(link.ESTIMATE))
        assert state == HOLDING and abs(again - value) < 0.5, (again, value, state)
        print(f"{machine}, hanging in the {how}: reset by the watchdog, C {again:.3f} kept (was {value:.3f})")


def seen_by_hil(build, image, machine, folder):
    drive, answer = folder / "drive.csv", folder / "hil.json"
    steerid = build / "steerid"
    simulate = [steerid, "simulate", "--task", "probe", "--duration", "8", "--seed", "5", "--out", drive]
    subprocess.run(simulate, check=True, stdout=subprocess.DEVNULL)
    with board(image, machine, folder, "pty") as debugger:
        port = re.search(r"/dev/pts/\d+", (folder / "said").read_text()).group(0)
        command = subprocess.Popen([steerid, "hil", "--port", port, "--real-time", drive, "--json", answer])
        debugger.run_to(address_of(image, "steerid::mps2::Board::start_watchdog()"))
        for _ in range(5):
            debugger.run_to(address_of(image, "steerid::mps2::Board::ticked()"))
        hang(debugger, image, "interrupt")
        debugger.go()
        assert command.wait(timeout=60) == 0
    hil = json.loads(answer.read_text(encoding="utf-8"))
    (reset,) = hil["resets"]
    # Too early for a saved estimate; that one is kept is what the other tests show.
    assert reset["cause"] == "watchdog" and reset["restored"] is False and 0 < reset["at_s"] < 8, reset


def main():
    build, name = pathlib.Path(sys.argv[1]), sys.argv[2]
    image = build / "firmware" / f"steerid-{name}.elf"
    if shutil.which("qemu-system-arm") is None or shutil.which("arm-none-eabi-nm") is None or not image.exists():
        print("skipped: no qemu-system-arm, no Arm tools, or no image")
        return 77
    with tempfile.TemporaryDirectory() as temporary:
        folder, machine = pathlib.Path(temporary), f"mps2-{name}"
        if sys.argv[3:] == ["hil"]:
            seen_by_hil(build, image, machine, folder)
            return 0
        for how in ("loop", "interrupt", "timer"):
            (folder / how).mkdir()
            bites(image, machine, folder / how, how)
    return 0


if __name__ == "__main__":
    sys.exit(main())
