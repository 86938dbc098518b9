# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Decodes the project's CAN frames with an independent decoder and the DBC file alone.

    decode_with_canmatrix.py DBC PRINT_CAN_FRAMES

Every signal of every frame must come back as it went in, within half a step; every message of the DBC file must occur;
the checksum is computed here once more, from its published description. Exit code 77: canmatrix is not installed.
"""

import json
import os
import random
import subprocess
import sys

try:
    import canmatrix.formats
except ImportError:
    print("SKIPPED: canmatrix is not installed (Debian: python3-canmatrix)")
    sys.exit(77)


def crc8_autosar(data):
    """Bit by bit as polynomial division: x^8 + x^5 + x^3 + x^2 + x + 1, start and final xor 0xFF."""
    remainder = 0xFF
    for byte in data:
        for bit in range(7, -1, -1):
            carry = (remainder >> 7) ^ ((byte >> bit) & 1)
            remainder = (remainder << 1) & 0xFF
            if carry:
                remainder ^= 0x2F
    return remainder ^ 0xFF


def faults(dbc, lines):
    matrix = canmatrix.formats.loadp_flat(dbc)
    messages = {frame.arbitration_id.id: frame for frame in matrix.frames}
    seen = set()
    for line in lines:
        sent = json.loads(line)
        message = messages[sent["id"]]
        seen.add(sent["id"])
        data = bytearray.fromhex(sent["bytes"])
        decoded = message.decode(data)
        identifier = bytes([sent["id"] & 0xFF, sent["id"] >> 8])
        if decoded["Checksum"].raw_value != crc8_autosar(identifier + bytes(data[1:])):
            yield f"{message.name}: checksum {decoded['Checksum'].raw_value}"
        missing = {signal.name for signal in message.signals} - {"Checksum"} - set(sent["signals"])
        if missing:
            yield f"{message.name}: the DBC file has {missing}, the program does not"
        for name, value in sent["signals"].items():
            signal = decoded[name]
            if isinstance(value, str):
                if signal.named_value != value:
                    yield f"{message.name}.{name}: {signal.named_value}, sent {value}"
            elif abs(float(signal.phys_value) - value) > 0.5 * float(signal.signal.factor):
                yield f"{message.name}.{name}: {signal.phys_value}, sent {value}"
            elif not float(signal.signal.min) - 1e-9 <= value <= float(signal.signal.max) + 1e-9:
                yield f"{message.name}.{name}: {value} is outside the range that the DBC file gives"
    for identifier in set(messages) - seen:
        yield f"{messages[identifier].name} was never sent"


def main(dbc, program):
    seed = int(os.environ.get("STEERID_SEED", random.randrange(2**32)))
    print(f"seed {seed} (repeat with STEERID_SEED={seed})")
    printed = subprocess.run([program, str(seed)], capture_output=True, text=True, check=True).stdout.splitlines()
    found = list(faults(dbc, printed))
    print("\n".join(found[:20]))
    print(f"{len(printed)} frames decoded, {len(found)} faults")
    return 1 if found or len(printed) < 1000 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
