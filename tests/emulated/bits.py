# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The same bits by every compiler: g++ and clang++ from -O0 to -O3 over one simulated drive.

usage: bits.py BUILD SOURCE EIGEN_INCLUDE
The emulated boards are compared with one of these by the tests hil_an386 and hil_an385.
"""

import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile


def integers(drive):
    """What the port carries, as a back end rounds it."""
    rows = csv.DictReader(line for line in drive.read_text(encoding="utf-8").splitlines() if not line.startswith("#"))
    for row in rows:
        scaled = [("time_s", 1e6), ("angle_rad", 1e6), ("torque_driver_nm", 1e3), ("torque_motor_nm", 1e3)]
        yield ",".join(str(round(float(row[name]) * factor)) for name, factor in scaled)


def main():
    build, source, eigen = (pathlib.Path(p) for p in sys.argv[1:4])
    launcher = ["ccache"] if shutil.which("ccache") else []
    compilers = [c for c in ("g++", "clang++") if shutil.which(c)]
    if compilers != ["g++", "clang++"]:
        print(f"skipped: needs g++ and clang++, found {compilers}")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        drive = pathlib.Path(folder, "drive.csv")
        subprocess.run(
            [build / "steerid", "simulate", "--task", "probe", "--duration", "30", "--seed", "6", "--out", drive],
            check=True, stdout=subprocess.DEVNULL,
        )
        samples = "\n".join(integers(drive)) + "\n"
        digests = {}
        for compiler in compilers:
            for level in ("-O0", "-O1", "-O2", "-O3"):
                program = pathlib.Path(folder, "digest")
                objects = pathlib.Path(folder, "digest.o")
                subprocess.run(
                    [*launcher, compiler, "-std=c++20", level, "-ffp-contract=off", "-DNDEBUG", "-c",
                     source / "tests/emulated/print_digest.cpp", "-o", objects,
                     "-I", source / "firmware", "-I", source / "hal", "-isystem", eigen],
                    check=True,
                )
                subprocess.run([compiler, objects, "-o", program], check=True)
                digests[f"{compiler} {level}"] = subprocess.run(
                    [program], input=samples, capture_output=True, text=True, check=True
                ).stdout
    for title, digest in digests.items():
        print(f"{title}: {digest!r}")
    assert len(digests) == 8 and len(set(digests.values())) == 1
    (digest,) = set(digests.values())
    float_line, fixed_line = digest.splitlines()
    assert float_line.split()[1] == "3000" and float_line.split()[-1] != fixed_line.split()[-1]
    return 0


if __name__ == "__main__":
    sys.exit(main())
