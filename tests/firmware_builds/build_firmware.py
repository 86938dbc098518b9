# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Builds firmware as its author would, outside the tree, in every way that CMake offers, by two compilers: everything must
link without an operating system, without a heap and without a flag that only this project knows of.

    build_firmware.py SOURCE_DIR BUILD_DIR

With the repository as a folder of the firmware's tree and with an installed copy; without a build type, in Debug, Release
and MinSizeRel. Exit code 77: the Arm compiler is not installed.
"""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
IMAGES = ("on_the_link", "on_a_bus")
FORBIDDEN = re.compile(r" (_*(malloc|calloc|realloc|free|sbrk|abort|exit|printf|cxa_\w+|Unwind_\w+|dso_handle|assert_func))$")
# name: (toolchain, installed copy?, build types; "" is none)
WAYS = {
    "gcc, a folder of the tree": ("gcc", False, ["", "Debug;Release;MinSizeRel"]),
    "clang, a folder of the tree": ("clang", False, ["", "Debug;Release;MinSizeRel"]),
    "gcc, installed": ("gcc", True, [""]),
}


def run(*command):
    """Runs it; its output is what the test says when it fails."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stdout}\n{done.stderr}")


def project(source, folder):
    """The firmware: the test's files, and a copy of the template board with a name and a namespace of its own."""
    shutil.copytree(HERE / "project", folder)
    board = folder / "my_board"
    shutil.copytree(source / "hal/template_board", board)
    for path in board.iterdir():
        path.write_text(path.read_text(encoding="utf-8").replace("template_board", "my_board"), encoding="utf-8")
    return folder


def build(folder, toolchain, where, types):
    """Configures once for all of `types`, builds each; the images."""
    target = folder / "-".join(["build", toolchain, types.replace(";", "_") or "none", where[0][2:9]])
    generator = ["-G", "Ninja Multi-Config", f"-DCMAKE_CONFIGURATION_TYPES={types}"] if types else ["-G", "Ninja"]
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run("cmake", "-S", folder, "-B", target, *generator, f"-DCMAKE_TOOLCHAIN_FILE={HERE / toolchain}.cmake", *launcher, *where)
    images = []
    for one in types.split(";"):
        run("cmake", "--build", target, *(["--config", one] if one else []))
        images += [target / one / image for image in IMAGES]
    return images


def fault(image):
    """What is in the image that has no place there; empty when nothing is."""
    names = subprocess.run(["arm-none-eabi-nm", image], capture_output=True, text=True, check=True).stdout
    if not re.search(r" T run_ecu$", names, re.M):
        return "run_ecu is not in it"
    return ", ".join(sorted({m.group(1) for line in names.splitlines() if (m := FORBIDDEN.search(line))}))


def main():
    source, build_dir = (pathlib.Path(p).resolve() for p in sys.argv[1:])
    missing = [tool for tool in ("arm-none-eabi-g++", "clang++") if not shutil.which(tool)]
    if missing:
        print(f"skipped: {' and '.join(missing)} not installed")
        return 77
    os.environ.pop("CXXFLAGS", None)
    failures = 0
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = project(source, pathlib.Path(temporary, "firmware"))
        prefix = pathlib.Path(temporary, "prefix")
        run("cmake", "--install", build_dir, "--prefix", prefix, "--component", "firmware")
        jobs = {}
        for name, (toolchain, installed, all_types) in WAYS.items():
            where = [f"-DCMAKE_PREFIX_PATH={prefix}" if installed else f"-DSTEERID_SOURCE_DIR={source}"]
            for types in all_types:
                jobs[pool.submit(build, folder, toolchain, where, types)] = f"{name}, {types or 'no build type'}"
        for job, name in jobs.items():
            try:
                for image in job.result():
                    wrong = fault(image)
                    size = subprocess.run(["arm-none-eabi-size", image], capture_output=True, text=True, check=True).stdout
                    text = size.splitlines()[1].split()[0]
                    print(f"{'FAILED' if wrong else 'ok':6}  {name}: {image.parent.name}/{image.name}, {text} bytes {wrong}")
                    failures += bool(wrong)
            except RuntimeError as error:
                failures += 1
                print(f"FAILED  {name}:\n{error}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
