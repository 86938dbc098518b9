# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The link protocol (docs/link_protocol.md) from its document: what the emulated boards are spoken to with in tests."""

import socket
import struct
import zlib

HELLO, START, SAMPLE, TICK, RESET, ESTIMATE, HEALTH = 0x01, 0x02, 0x03, 0x04, 0x05, 0x11, 0x12
TIMER_PACE, LINK_PACE = 0, 1


def stuffed(packet):
    """COBS; packets here are shorter than 254 bytes."""
    return b"".join(bytes([len(block) + 1]) + block for block in packet.split(b"\0"))


def unstuffed(frame):
    blocks, at = [], 0
    while at < len(frame):
        blocks.append(frame[at + 1 : at + frame[at]])
        at += frame[at]
    return b"\0".join(blocks)


class Line:
    """One end of a serial line that is a Unix socket."""

    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(str(path))
        self._rest = b""
        self._sequence = 0

    def send(self, kind, payload=b""):
        packet = struct.pack("<BBH", 1, kind, self._sequence & 0xFFFF) + payload
        self._sequence += 1
        self._socket.sendall(stuffed(packet + struct.pack("<I", zlib.crc32(packet))) + b"\0")

    def sample(self, stamp_us, angle_urad, torque_driver_mnm):
        self.send(SAMPLE, struct.pack("<qiiiHB", stamp_us, angle_urad, torque_driver_mnm, 0, 0, 7))

    def receive(self, timeout_s=30):
        """(type, payload) of the next frame that is whole; None when none comes."""
        self._socket.settimeout(timeout_s)
        while True:
            frame, zero, rest = self._rest.partition(b"\0")
            if zero:
                self._rest = rest
                packet = unstuffed(frame)
                # Half a frame is left of what a reset cut off.
                if len(packet) >= 8 and struct.pack("<I", zlib.crc32(packet[:-4])) == packet[-4:]:
                    return packet[1], packet[4:-4]
                continue
            try:
                more = self._socket.recv(4096)
            except TimeoutError:
                return None
            assert more, "the emulator ended"
            self._rest += more

    def expect(self, kind, frames=100_000):
        for _ in range(frames):
            frame = self.receive()
            assert frame is not None, f"no frame of type {kind:#x}"
            if frame[0] == kind:
                return frame[1]
        raise AssertionError(f"no frame of type {kind:#x} among {frames}")


class Debugger:
    """The emulator's debugging port: enough of GDB's remote protocol to stop, patch, wait and go on."""

    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(str(path))
        self._socket.settimeout(30)
        self._rest = b""
        self._running = False
        self.ask("?")

    def _answer(self):
        while b"#" not in self._rest or len(self._rest.partition(b"#")[2]) < 2:
            more = self._socket.recv(4096)
            assert more, "the emulator ended"
            self._rest += more
        body, _, self._rest = self._rest.partition(b"#")
        self._rest = self._rest[2:]
        self._socket.sendall(b"+")
        return body.partition(b"$")[2].decode()

    def _say(self, command):
        body = command.encode()
        self._socket.sendall(b"$" + body + b"#" + f"{sum(body) & 0xFF:02x}".encode())

    def ask(self, command):
        self._say(command)
        return self._answer()

    def go(self):
        self._say("c")

    def stop(self):
        self._socket.sendall(b"\x03")
        return self._answer()

    def patch(self, address, halfword):
        answer = self.ask(f"M{address:x},2:{struct.pack('<H', halfword).hex()}")
        assert answer == "OK", answer

    def run_to(self, *addresses):
        """On to the next time that an instruction at one of the addresses is due; returns which."""
        self.ask("s")  # off the address at which it stands
        for address in addresses:
            assert self.ask(f"Z0,{address:x},2") == "OK"
        self.go()
        self._answer()
        for address in addresses:
            assert self.ask(f"z0,{address:x},2") == "OK"
        return struct.unpack_from("<I", bytes.fromhex(self.ask("g")), 15 * 4)[0]
