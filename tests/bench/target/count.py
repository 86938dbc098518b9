# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Counts instructions of the firmware on both emulated Cortex-M, prints them as a table and holds them within bounds.

usage: count.py SOURCE EIGEN_INCLUDE
Instructions are not cycles: docs/benchmarks.md has the bounds that follow from Arm's published timings.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

BOARDS = {
    "an386": ["-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard", "-O2"],
    "an385": ["-mcpu=cortex-m3", "-mfloat-abi=soft", "-O2", "-fno-schedule-insns"],
}
COMMON = (
    "-std=c++20 -mthumb -ffp-contract=off -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-use-cxa-atexit "
    "-ffunction-sections -fdata-sections -fno-reorder-blocks -DNDEBUG -nostartfiles --specs=nano.specs -Wl,--gc-sections"
).split()
PARTS = {
    "core": "covariance and parameters, one measurement",
    "update": "identifier, one sample",
    "take": "task.take: supervision and identifier",
    "by_bar": "task.take behind a torsion bar",
    "estimate": "task.estimate: deviations, states",
    "frame": "the estimate as a frame of the link",
    "quotient": "one division",
    "root": "one square root",
}
# Mean instructions, least and most that pass. Least is some 10 % below what was measured, so that nothing falls out
# unseen; so is most above it, but for the whole step, take and estimate, which has the budget: 3,000 on the an386 and
# 30,000 on the an385.
BOUNDS = {
    "an386": {
        "core": (65, 80), "update": (580, 710), "take": (2250, 2650), "by_bar": (2290, 2650), "estimate": (305, 350), "frame": (1620, 2000),
        "quotient": (4, 4), "root": (7, 9),
    },
    "an385": {
        "core": (440, 500), "update": (5600, 6900), "take": (13_200, 28_800), "by_bar": (13_000, 29_000), "estimate": (550, 670),
        "frame": (1720, 2100), "quotient": (41, 49), "root": (41, 49),
    },
}


def build_plugin(folder, source):
    subprocess.run(
        ["gcc", "-O2", "-Wall", "-shared", "-fPIC", source / "tests/bench/target/count_plugin.c",
         "-o", folder / "libcount_plugin.so"],
        check=True,
    )


def build_image(folder, source, eigen, board, flags, more=()):
    image = folder / f"bench-{board}.elf"
    files = [source / "tests/bench/target/target_bench.cpp", *(source / "hal/mps2_an386").glob("[bs]*.cpp")]
    subprocess.run(
        ["arm-none-eabi-g++", *COMMON, *flags, *more, "-I", source / "firmware", "-I", source / "hal",
         "-isystem", eigen, *files, "-T", source / "hal/mps2_an386/link.ld", "-o", image],
        check=True,
    )
    return image


def run(folder, image, board, parts, options=()):
    """What the plugin says, in words; the image ends by itself."""
    addresses = {}
    listed = subprocess.run(["arm-none-eabi-nm", image], capture_output=True, text=True, check=True)
    for line in listed.stdout.splitlines():
        words = line.split()
        if len(words) == 3:
            addresses[words[2]] = words[0]
    pairs = [f"{part}={addresses[part + '_begin']}:{addresses[part + '_end']}" for part in parts]
    ended = subprocess.run(
        ["qemu-system-arm", "-M", f"mps2-{board}", "-display", "none", "-monitor", "none", "-serial", "null",
         "-semihosting-config", "enable=on,target=native", "-kernel", image,
         "-plugin", ",".join([f"{folder}/libcount_plugin.so", *pairs, *options]), "-d", "plugin"],
        capture_output=True, text=True, timeout=120,
    )
    return [line.split() for line in ended.stderr.splitlines()]


def measure(folder, source, eigen, board, flags):
    image = build_image(folder, source, eigen, board, flags)
    counts = {}
    for words in run(folder, image, board, ["empty", *PARTS]):
        if len(words) == 5 and words[0] in ["empty", *PARTS]:
            counts[words[0]] = (int(words[1]), int(words[2]), float(words[3]), int(words[4]))
    assert set(counts) == {"empty", *PARTS}, counts
    # The markers' own return and call stand between every pair.
    overhead = counts.pop("empty")
    assert overhead[1] == overhead[3], overhead
    return {part: (n, least - overhead[1], mean - overhead[1], most - overhead[1])
            for part, (n, least, mean, most) in counts.items()}


def main():
    source, eigen = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    missing = [t for t in ("qemu-system-arm", "arm-none-eabi-g++", "gcc") if shutil.which(t) is None]
    if missing:
        print(f"skipped: no {', '.join(missing)}")
        return 77
    beyond = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        build_plugin(folder, source)
        for board, flags in BOARDS.items():
            print(f"mps2-{board}, {' '.join(flags)}: instructions of 3000 passes")
            print(f"  {'least':>7} {'mean':>8} {'most':>7}")
            for part, (passes, least, mean, most) in measure(folder, source, eigen, board, flags).items():
                print(f"  {least:7d} {mean:8.1f} {most:7d}  {PARTS[part]}")
                low, high = BOUNDS[board][part]
                if passes != 3000 or not low <= mean <= high:
                    beyond.append(f"{board} {part}: {mean:.1f} of {passes} passes, outside {low} to {high}")
    assert not beyond, "\n".join(beyond)
    return 0


if __name__ == "__main__":
    sys.exit(main())
