# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""`steerid hil --port` beside an ECU made of docs/link_protocol.md alone, whose frames do not all arrive.

usage: lost_frame.py BUILD
"""

import os
import pathlib
import pty
import struct
import subprocess
import sys
import tempfile
import threading
import tty
import zlib

from link import ESTIMATE, HELLO, RESET, SAMPLE, START, TICK, stuffed, unstuffed

IDENTITY = bytes([1, 0, 0, 0])
NO_ESTIMATE = bytes(53)


class Ecu(threading.Thread):
    """Answers on a pseudo terminal. `lose`: this estimate is made and never sent."""

    def __init__(self, lose=None, first_sequence=0, late_frame=False):
        super().__init__(daemon=True)
        self._line, self._far_end = pty.openpty()
        tty.setraw(self._far_end)
        self.port = os.ttyname(self._far_end)
        self._lose, self._late_frame = lose, late_frame
        self._sequence = first_sequence
        self._estimates = 0

    def _send(self, kind, payload, lost=False):
        packet = struct.pack("<BBH", 1, kind, self._sequence & 0xFFFF) + payload
        self._sequence += 1
        if not lost:
            os.write(self._line, stuffed(packet + struct.pack("<I", zlib.crc32(packet))) + b"\0")

    def _answer(self, kind, payload):
        if kind == RESET:
            if self._late_frame:  # it was on its way when the reset came
                self._send(ESTIMATE, NO_ESTIMATE)
            self._sequence = 0
        if kind in (HELLO, RESET):
            self._send(HELLO, IDENTITY)
        elif kind == START:
            self._send(START, payload)
        elif kind in (SAMPLE, TICK):
            self._estimates += 1
            self._send(ESTIMATE, NO_ESTIMATE, lost=self._estimates == self._lose)

    def run(self):
        rest = b""
        while True:
            try:
                rest += os.read(self._line, 4096)
            except OSError:
                return
            *frames, rest = rest.split(b"\0")
            for packet in map(unstuffed, frames):
                if len(packet) >= 8:
                    self._answer(packet[1], packet[4:-4])


def drive(steerid, log, ecu):
    ecu.start()
    return subprocess.run([steerid, "hil", "--port", ecu.port, log], capture_output=True, text=True, timeout=60)


def main():
    steerid = pathlib.Path(sys.argv[1], "steerid")
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder, "drive.csv")
        subprocess.run([steerid, "simulate", "--task", "probe", "--duration", "3", "--out", log], check=True,
                       stdout=subprocess.DEVNULL)

        whole = drive(steerid, log, Ecu())
        assert whole.returncode == 0 and "300 estimates" in whole.stdout, whole.stderr + whole.stdout

        lost = drive(steerid, log, Ecu(lose=100))
        assert lost.returncode == 1 and "1 of the ECU's frames were lost on the way" in lost.stderr, lost.stderr

        # A board that starts again counts from zero: what its last frame before that had is no loss.
        again = drive(steerid, log, Ecu(first_sequence=40_000, late_frame=True))
        assert again.returncode == 0 and "300 estimates" in again.stdout, again.stderr + again.stdout
    return 0


if __name__ == "__main__":
    sys.exit(main())
