# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""What an image is made of: its size, its memory, its deepest stack, and what must not be in it.

usage: image.py BUILD an386|an385
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FORBIDDEN = re.compile(
    r"^_*(malloc|calloc|realloc|free|sbrk|printf|sprintf|snprintf|vprintf|puts|abort|exit|cxa_\w+|Unwind_\w+)(_r)?$"
    r"|^_Z(nw|na|dl|da)|^__gxx_personality"
)
# Any floating-point instruction, and the run-time library's helpers that take its place.
FLOAT_INSTRUCTION = re.compile(r"^v(add|sub|mul|div|mla|mls|nml|fma|fms|neg|abs|sqrt|cmp|cvt|mov|ldr|str|ldm|stm|push|pop|mrs|msr)")
FLOAT_HELPER = re.compile(r"__aeabi_[fd]|__aeabi_\w*2[fd]$|__(add|sub|mul|div|neg|cmp|fix|float|extend|trunc|eq|ne|lt|le|gt|ge)\w*[sd]f")

# Bytes: most is the budget, 32 KiB of flash for identifier and task on the an386 and 64 KiB on the an385, 2 KiB and 4 KiB
# for one task; a stack of 2 and 4 KiB and 8 KiB of flash for the rest of the image go with them. Least is some 10 % below
# what was measured: less means that something fell out of the image.
CORE_FLASH = {"an386": (22_500, 32 * 1024), "an385": (37_000, 64 * 1024)}
FLASH = {"an386": (28_000, 40 * 1024), "an385": (43_000, 72 * 1024)}
TASK_RAM = {"an386": (1_600, 2048), "an385": (3_000, 4096)}
STACKED = {"an386": 104 + 4, "an385": 32 + 4}  # by an exception, with and without a floating-point unit
STACK = {"an386": (930, 2048), "an385": (1_660, 4096)}


def tool(name, *arguments):
    return subprocess.run(["arm-none-eabi-" + name, *arguments], capture_output=True, text=True, check=True).stdout


def symbols(image):
    """(address, size, demangled name) of everything with a size, and the mangled names of everything."""
    sized = []
    for line in tool("nm", "--print-size", "--demangle", image).splitlines():
        parts = line.split(None, 3)
        if len(parts) == 4:
            sized.append((int(parts[0], 16), int(parts[1], 16), parts[3]))
    names = [line.split()[-1] for line in tool("nm", image).splitlines()]
    return sized, names


def flash_by_folder(image):
    """Bytes of code by the folder whose source asked for it: what is inlined counts where it was written, the insides of
    Eigen and of the standard library where they are called. What no line is known of is the library's."""
    listing = tool("objdump", "--disassemble", "--no-show-raw-insn", image)
    addresses = [int(a, 16) for a in re.findall(r"^\s+([0-9a-f]+):\t", listing, re.M)]
    ends = [*addresses[1:], addresses[-1]]
    lines = tool("addr2line", "-e", image, "-i", "-a", *map(hex, addresses))
    folders = {}
    for block, end in zip(re.split(r"^(?=0x)", lines, flags=re.M)[1:], ends):
        first, *frames = block.splitlines()
        ours = [re.search(r"/(firmware/\w+|hal/\w+)/", f) for f in frames]
        folder = next((o.group(1) for o in ours if o), "libraries")
        # Between the last instruction of a function and the next lie its constants.
        folders[folder] = folders.get(folder, 0) + min(end - int(first, 16), 64)
    return folders


def calls_of(image):
    """Function address -> name, own stack by its prologue is not needed: frames come from -fstack-usage."""
    calls, functions, here = {}, {}, None
    for line in tool("objdump", "--disassemble", "--no-show-raw-insn", image).splitlines():
        start = re.match(r"^([0-9a-f]+) <(.+)>:$", line)
        if start:
            here = start.group(2)
            functions[here] = int(start.group(1), 16)
            calls[here] = set()
            continue
        branch = re.match(r"^\s+[0-9a-f]+:\s+(b|bl|b\.w|b\.n|b[a-z]{2}|b[a-z]{2}\.[nw]|blx)\s+[0-9a-f]+ <([^>+]+)>", line)
        if branch and here and branch.group(2) != here:
            calls[here].add(branch.group(2))
        # A branch into one's own beginning by a link is recursion.
        if re.match(rf"^\s+[0-9a-f]+:\s+bl\s+[0-9a-f]+ <{re.escape(here or '')}>", line):
            calls[here].add(here)
    return calls


def frames_of(objects):
    """Mangled function -> own stack in bytes, from the compiler's call graphs (.ci)."""
    frames, dynamic = {}, []
    for path in objects.rglob("*.ci"):
        for title, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]*)"', path.read_text(encoding="utf-8")):
            size = re.search(r"\\n(\d+) bytes \((\w+[\w,]*)\)", label)
            if not size:
                continue
            name = title.split(":")[-1]
            frames[name] = max(frames.get(name, 0), int(size.group(1)))
            if "dynamic" in size.group(2) and "bounded" not in size.group(2):
                dynamic.append(name)
    return frames, dynamic


def registers(listed):
    """How many registers "r4, r6-r8, lr" names."""
    count = 0
    for part in listed.split(","):
        ends = [int(n) for n in re.findall(r"\d+", part)]
        count += ends[1] - ends[0] + 1 if "-" in part and len(ends) == 2 else 1
    return count


def library_frames(image):
    """Function -> stack in bytes for what has no call graph, the C library's few leaves: all that it pushes, added up."""
    frames, here = {}, None
    for line in tool("objdump", "--disassemble", "--no-show-raw-insn", image).splitlines():
        start = re.match(r"^[0-9a-f]+ <(.+)>:$", line)
        if start:
            here = start.group(1)
            frames[here] = 0
        pushed = re.search(r"\t(push|stmdb\s+sp!,|vpush)\s*\{([^}]+)\}", line)
        if pushed:
            frames[here] += registers(pushed.group(2)) * (8 if "d" in pushed.group(2) else 4)
        moved = re.search(r"\t(?:sub\w*(?:\.w)?\tsp, (?:sp, )?|str\w*(?:\.w)?\t\w+, \[sp, )#-?(\d+)", line)
        if moved and ("!" in line or "sub" in line):
            frames[here] += int(moved.group(1))
    return frames


def without_numbers(image, folder):
    """The image without the linker script's symbols that are numbers: one that happens to be the address of an instruction
    would pass for a function there."""
    numbers = [line.split()[-1] for line in tool("nm", image).splitlines() if line.split()[-2] in "Aa"]
    copy = pathlib.Path(folder, image.name)
    tool("objcopy", *(f"--strip-symbol={name}" for name in numbers), image, copy)
    return copy


def deepest(calls, frames, start):
    """(bytes, path) of the deepest chain of calls."""
    done = {}

    def visit(name, above):
        assert name not in above, f"recursion: {' -> '.join([*above, name])}"
        if name not in done:
            own = frames[name]
            below = max((visit(c, [*above, name]) for c in calls.get(name, ())), default=(0, []))
            done[name] = (own + below[0], [name, *below[1]])
        return done[name]

    return visit(start, [])


def main():
    build, board = pathlib.Path(sys.argv[1]), sys.argv[2]
    image = build / "firmware" / f"steerid-{board}.elf"
    if shutil.which("arm-none-eabi-nm") is None or not image.exists():
        print("skipped: no Arm tools, or no image")
        return 77
    sized, names = symbols(image)

    forbidden = sorted({name for name in names if FORBIDDEN.search(name)})
    assert not forbidden, f"in the image: {forbidden}"
    assert "run_ecu" in names and "reset_handler" in names  # the search looks at the right thing

    text, data, bss = (int(n) for n in tool("size", image).splitlines()[1].split()[:3])
    print(f"{board}: {text} bytes of flash, {data + bss} bytes of RAM without stack")
    least, most = FLASH[board]
    assert least <= text + data <= most

    folders = flash_by_folder(image)
    for folder, size in sorted(folders.items()):
        print(f"  {folder}: {size} bytes of code")
    core = sum(size for folder, size in folders.items() if folder.startswith("firmware/"))
    print(f"  identifier, app and what they stand on: {core} bytes")
    least, most = CORE_FLASH[board]
    assert least <= core <= most

    ram = {name: size for _, size, name in sized
           if name.startswith("run_ecu::") or (name.endswith("::task") and not name.startswith("guard"))}
    for name, size in sorted(ram.items()):
        print(f"  {name}: {size} bytes")
    (task,) = [size for name, size in ram.items() if name.endswith("::task")]
    least, most = TASK_RAM[board]
    assert least <= task <= most

    listing = tool("objdump", "--disassemble", "--no-show-raw-insn", image)
    mnemonics = re.findall(r"^\s+[0-9a-f]+:\s+(\S+)", listing, re.M)
    floats = [m for m in mnemonics if FLOAT_INSTRUCTION.match(m)]
    helpers = sorted({n for n in names if FLOAT_HELPER.search(n)})
    print(f"  {len(mnemonics)} instructions, {len(floats)} of floating point, helpers {helpers}")
    if board == "an385":
        assert not floats and not helpers
    else:
        assert len(floats) > 200  # the search would find them
        assert not [m for m in mnemonics if re.match(r"^vf(n?m[as])", m)], "a fused multiply-add rounds once"
        assert not [n for n in helpers if "_d" in n or n.endswith("df")], f"double in a float image: {helpers}"

    frames, dynamic = frames_of(build / "images" / f"mps2_{board}")
    with tempfile.TemporaryDirectory() as folder:
        functions = without_numbers(image, folder)
        calls = calls_of(functions)
        frames = {**library_frames(functions), **frames}
    assert not dynamic, f"stack of a size known at run time only: {dynamic}"
    depth, path = deepest(calls, frames, "run_ecu")
    # An interrupt comes on top: what the processor stacks itself, with room to align it, and its handler.
    interrupt = max(deepest(calls, frames, name)[0] for name in calls if "_interrupt" in name) + STACKED[board]
    print(f"  deepest stack {depth} + {interrupt} in an interrupt: " + " > ".join(path))
    least, most = STACK[board]
    assert least <= depth + interrupt <= most
    return 0


if __name__ == "__main__":
    sys.exit(main())
