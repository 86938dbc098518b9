# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Lists where the instructions of a part go, by source file and by kind: the answer to "what would have to go".

usage: listing.py SOURCE EIGEN_INCLUDE an386|an385 [take|estimate|update|core|frame]
"""

import collections
import pathlib
import re
import subprocess
import sys
import tempfile

import count

KINDS = (
    ("division, square root", r"v?(s|u)?div|vsqrt"),
    ("product", r"vmul|vnmul|s?mul|umull|smull|mla|mls|smlal|umlal"),
    ("sum, comparison, conversion", r"vadd|vsub|vneg|vabs|vcmp|vcvt|vmrs|add|sub|rsb|adc|sbc|cmp|cmn|neg|"
                                   r"and|orr|eor|bic|lsl|lsr|asr|ror|ubfx|sbfx|[us]xt|clz|tst|teq|mvn|rsc|sat|ssat|bfi"),
    ("load, store", r"vldr|vstr|vldm|vstm|vpush|vpop|ldr|str|ldm|stm|push|pop"),
    ("move", r"vmov|mov|adr|it"),
    ("branch, call", r"b|bl|bx|blx|cb|tb"),
)


def kind_of(mnemonic):
    plain = mnemonic.split(".")[0]
    for title, pattern in KINDS:
        if re.match(rf"({pattern})", plain) and not (title.startswith("branch") and plain.startswith("bic")):
            return title
    return "other"


def registers(operands):
    """How many registers {r4-r7, lr} names."""
    count = 0
    for part in re.search(r"\{([^}]*)\}", operands).group(1).split(","):
        ends = [int(n) for n in re.findall(r"\d+", part)]
        count += ends[1] - ends[0] + 1 if "-" in part else 1
    return count


def cycles(mnemonic, operands):
    """(least, most) on a Cortex-M4F, memory without wait states: Arm's Cortex-M4 Technical Reference Manual, tables 3-1
    and 7-1. A load may hide behind another, a branch refills the pipeline in one to three cycles."""
    plain = mnemonic.split(".")[0]
    if re.match(r"vdiv|vsqrt", plain):
        return 14, 14
    if re.match(r"[su]div", plain):
        return 2, 12
    if "{" in operands:
        return 1 + registers(operands), 1 + registers(operands) + (3 if "pc" in operands else 0)
    if re.match(r"(ldr|str)d", plain):
        return 2, 3
    if re.match(r"v?(ldr|str)", plain):
        return 1, 2 + (3 if operands.startswith("pc") else 0)
    if re.match(r"it[te]*$", plain):
        return 0, 1
    if re.match(r"(b|bl|bx|blx|cbn?z|tb[bh])$|b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le|al)$", plain):
        return 1, 4
    return 1, 1


def profile(folder, source, eigen, board, part):
    """(passes, {address: executions}, image)."""
    count.build_plugin(folder, source)
    image = count.build_image(folder, source, eigen, board, count.BOARDS[board], ["-g"])
    lines = count.run(folder, image, board, [part, "empty"], [f"profile={part}"])
    passes = next(int(words[1]) for words in lines if words[0] == part)
    return passes, {int(words[1], 16): int(words[2]) for words in lines if words[0] == "at"}, image


def main():
    source, eigen, board = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    part = sys.argv[4] if len(sys.argv) > 4 else "take"
    with tempfile.TemporaryDirectory() as name:
        passes, executed, image = profile(pathlib.Path(name), source, eigen, board, part)
        where = subprocess.run(
            ["arm-none-eabi-addr2line", "-e", image, "-i", "-a", *(hex(a) for a in executed)],
            check=True, capture_output=True, text=True,
        ).stdout
        listed = subprocess.run(
            ["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", image], check=True, capture_output=True, text=True
        ).stdout
    lines = re.findall(r"^\s*([0-9a-f]+):\t(\S+)[ \t]*(.*)$", listed, re.M)
    mnemonics = {int(address, 16): mnemonic for address, mnemonic, _ in lines}
    clock = {int(address, 16): cycles(mnemonic, operands) for address, mnemonic, operands in lines}
    # The innermost frame of inlining in a header of ours: what Eigen does is done for the line that asked for it.
    table = collections.defaultdict(collections.Counter)
    for block in re.split(r"^(?=0x)", where, flags=re.M)[1:]:
        first, *frames = block.splitlines()
        address = int(first, 16)
        ours = [f for f in frames if "/firmware/" in f or "/hal/" in f]
        file = re.sub(r"^.*/(firmware|hal)/|:\d+.*$", "", ours[0]) if ours else "compiler's run-time library"
        table[file][kind_of(mnemonics[address])] += executed[address]
    titles = [title for title, _ in KINDS]
    print(f"{part} on the {board}, instructions a pass (mean of {passes})")
    print(f"{'':42}{'all':>8}" + "".join(f"{title:>30}" for title in titles))
    rows = sorted(table.items(), key=lambda row: -sum(row[1].values()))
    total = sum((counts for _, counts in rows), collections.Counter())
    for file, counts in [*rows, ("all", total)]:
        print(f"{file:42}{sum(counts.values()) / passes:8.1f}" + "".join(f"{counts[t] / passes:30.1f}" for t in titles))
    if board == "an386":
        least, most = (sum(n * clock[a][side] for a, n in executed.items()) / passes for side in (0, 1))
        print(f"cycles on a Cortex-M4F, without wait states: {least:.0f} to {most:.0f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
