#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Writes one drive on a CAN bus as candump, ASC and BLF, by python-can, and its DBC, by canmatrix.

    write_logs.py FOLDER    writes bus.dbc, drive.log, drive.asc, drive.blf and truth.csv

Three messages: the angle every 10 ms (Motorola, signed), the torsion bar every 5 ms (Intel, signed, on an extended
identifier), and a multiplexed one that has the motor's torque in every other frame. truth.csv has a row a frame: the
stamp, the signal, and the value that the integers on the bus stand for.
"""

import math
import pathlib
import sys

import can
import canmatrix
import canmatrix.formats

FIRST_S = 1795613219.0


def signal(name, start, size, little, signed, factor, offset, unit, multiplex=None):
    made = canmatrix.Signal(name, size=size, is_little_endian=little, is_signed=signed, factor=factor, offset=offset,
                            unit=unit, multiplex=multiplex)
    made.set_startbit(start, bitNumbering=1)
    return made


def bus():
    matrix = canmatrix.CanMatrix()
    angle = canmatrix.Frame("SteeringAngle", arbitration_id=canmatrix.ArbitrationId(0x2B0), size=8)
    angle.add_signal(signal("Angle", 4, 20, False, True, 0.001, -3.5, "deg"))
    angle.add_signal(signal("Counter", 59, 4, False, False, 1, 0, ""))
    bar = canmatrix.Frame("TorsionBar", arbitration_id=canmatrix.ArbitrationId(0x18FF0023, extended=True), size=8)
    bar.add_signal(signal("BarTorque", 11, 16, True, True, 0.0005, 0, "Nm"))
    bar.add_signal(signal("Counter", 0, 8, True, False, 1, 0, ""))
    motor = canmatrix.Frame("Motor", arbitration_id=canmatrix.ArbitrationId(0x2C0), size=8)
    motor.add_signal(signal("Page", 0, 8, True, False, 1, 0, "", multiplex="Multiplexor"))
    motor.add_signal(signal("MotorTorque", 8, 16, True, True, 0.01, 0, "Nm", multiplex=0))
    motor.add_signal(signal("Temperature", 8, 16, True, True, 0.1, 0, "C", multiplex=1))
    for frame in (angle, bar, motor):
        matrix.add_frame(frame)
    return matrix, angle, bar, motor


SCALES = {"BarTorque": (0.0005, 0), "Angle": (0.001, -3.5), "MotorTorque": (0.01, 0), "Temperature": (0.1, 0)}


def on_the_bus(name, value):
    """The nearest integer."""
    factor, offset = SCALES[name]
    return round((value - offset) / factor)


def stands_for(name, integer):
    factor, offset = SCALES.get(name, (1, 0))
    return integer * factor + offset


def drive():
    """Stamp, frame's name, signals as integers, which is what this canmatrix packs."""
    events = []
    for i in range(600):
        at_s = 0.005 * i
        events.append((at_s, "bar", {"BarTorque": on_the_bus("BarTorque", 3 * math.sin(5 * at_s)), "Counter": i % 256}))
        if i % 2 == 0:
            at_s = 0.005 * i + 0.0013
            events.append((at_s, "angle",
                           {"Angle": on_the_bus("Angle", 40 * math.sin(4 * at_s) - 7), "Counter": i % 16}))
            page = (i // 2) % 2
            events.append((at_s + 0.0002, "motor", {"Page": page, "MotorTorque": on_the_bus("MotorTorque", 2 * math.cos(3 * at_s))}
                           if page == 0 else {"Page": page, "Temperature": 555}))
    return sorted(events, key=lambda event: event[0])


def main():
    folder = pathlib.Path(sys.argv[1])
    matrix, angle, bar, motor = bus()
    canmatrix.formats.dumpp({"": matrix}, str(folder / "bus.dbc"))
    frames = {"angle": angle, "bar": bar, "motor": motor}
    writers = [can.CanutilsLogWriter(folder / "drive.log"), can.ASCWriter(folder / "drive.asc"),
               can.BLFWriter(folder / "drive.blf")]
    truth = ["stamp_s,signal,value"]
    for at_s, name, signals in drive():
        frame = frames[name]
        message = can.Message(timestamp=FIRST_S + at_s, arbitration_id=frame.arbitration_id.id,
                              is_extended_id=frame.arbitration_id.extended, data=frame.encode(signals), channel=0)
        stranger = can.Message(timestamp=FIRST_S + at_s, arbitration_id=0x7FF, is_extended_id=False, is_remote_frame=True,
                               dlc=0, channel=0)
        for writer in writers:
            writer.on_message_received(message)
            writer.on_message_received(stranger)
        for key, value in signals.items():
            truth.append(f"{at_s!r},{key},{stands_for(key, value)!r}")
    for writer in writers:
        writer.stop()
    (folder / "truth.csv").write_text("\n".join(truth) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
