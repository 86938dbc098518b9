# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Every install component as its user has it: what is in it, that it runs, and that ./run.sh has built all that it takes.

    install_components.py SOURCE_DIR BUILD_DIR
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

DOC = "share/doc/steerid"
# What must be in a component, beside licence and documents.
HOLDS = {
    "firmware": ["include/steerid/app/run_loop.hpp", "include/steerid/ecu/linked_ecu.hpp",
                 "include/steerid/can/sample_messages.hpp", "share/steerid/template_board/main.cpp",
                 "lib*/**/cmake/steerid/steerid-config.cmake"],
    "host": ["bin/steerid", "share/steerid/fleet/fleet.sh", "share/man/man1/steerid.1",
             "share/bash-completion/completions/steerid"],
    "linux_ecu": ["bin/steerid-ecu", "lib/systemd/system/steerid-ecu.service", "lib/udev/rules.d/60-steerid-gpio.rules",
                  f"{DOC}/steerid-ecu.json"],
}
DOCUMENTS = ["LICENSE", "NOTICE", "README.md", "CHANGELOG.md", "docs/porting.md", "docs/linux_ecu.md", "hal/can/steerid.dbc"]


def run(*command, **options):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True, **options).stdout


def install(build, prefix, *options, **environment):
    run("cmake", "--install", build, "--prefix", prefix, *options, env={**os.environ, **environment})


def rules(build):
    """The text of every install rule of this build."""
    return "\n".join(path.read_text(encoding="utf-8") for path in build.rglob("cmake_install.cmake")
                     if "images" not in path.relative_to(build).parts)


def not_built_by_run_sh(source, build):
    """Files that are installed from the build folder and that no target of ./run.sh's build preset makes."""
    presets = json.loads((source / "CMakePresets.json").read_text(encoding="utf-8"))["buildPresets"]
    (command,) = [preset for preset in presets if preset["name"] == "command"]
    made = set(re.findall(r" -o (\S+)", run("ninja", "-C", build, "-t", "commands", *command["targets"])))
    wanted = re.findall(r'TYPE (?:EXECUTABLE|STATIC_LIBRARY|SHARED_LIBRARY) FILES "([^"]+)"', rules(build))
    assert wanted, "no rule for a program was found"
    return [path for path in wanted if str(pathlib.Path(path).relative_to(build)) not in made]


def missing(prefix, component):
    wanted = HOLDS[component] + [f"{DOC}/{name}" for name in DOCUMENTS]
    return [f"{component}: {name} is not installed" for name in wanted if not list(prefix.glob(name))]


def broken_links(prefix):
    """Relative links of the installed documents that lead nowhere."""
    for path in sorted((prefix / DOC).rglob("*.md")):
        for target in re.findall(r"\]\((?!https?:|#|mailto:)([^)#\s]+)", path.read_text(encoding="utf-8")):
            if not (path.parent / target).exists():
                yield f"{path.relative_to(prefix)}: {target} is not installed"


def main():
    source, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    wrong = [f"{path} is installed, but ./run.sh does not build it" for path in not_built_by_run_sh(source, build)]
    components = set(re.findall(r'CMAKE_INSTALL_COMPONENT STREQUAL "(\w+)"', rules(build))) - {"Unspecified"}
    wrong += [f"this test knows nothing of the component {name}" for name in components - set(HOLDS)]
    wrong += [f"there is no component {name}" for name in set(HOLDS) - components]
    with tempfile.TemporaryDirectory() as folder:
        for component in sorted(components & set(HOLDS)):
            prefix = pathlib.Path(folder, component)
            install(build, prefix, "--component", component)
            wrong += missing(prefix, component) + [f"{component}: {link}" for link in broken_links(prefix)]
            others = [name for other, names in HOLDS.items() if other != component for name in names
                      if list(prefix.glob(name))]
            wrong += [f"{component}: holds {name}" for name in others]
        whole = pathlib.Path(folder, "whole")
        install(build, whole)
        for component in components & set(HOLDS):
            wrong += missing(whole, component)
        for program in ("steerid", "steerid-ecu"):
            print(program, run(whole / "bin" / program, "--version").strip())
        unit = (whole / "lib/systemd/system/steerid-ecu.service").read_text(encoding="utf-8")
        wrong += [f"the unit starts {program}, which is not there"
                  for program in re.findall(r"^Exec\w+=(\S+)", unit, re.M) if not os.access(program, os.X_OK)]
        staged = pathlib.Path(folder, "staged")
        install(build, "/usr", DESTDIR=str(staged))
        unit = (staged / "usr/lib/systemd/system/steerid-ecu.service").read_text(encoding="utf-8")
        if "ExecStart=/usr/bin/steerid-ecu " not in unit:
            wrong.append("a staged unit does not start the daemon of its prefix")
        # An installed command has no image beside it: it must name a script that is there and builds it.
        log = pathlib.Path(folder, "drive.csv")
        run(whole / "bin/steerid", "simulate", "--task", "probe", "--duration", "10", "--out", log)
        refused = subprocess.run([whole / "bin/steerid", "hil", "--emulate", "an386", log], check=False,
                                 capture_output=True, text=True)
        script = re.search(r"\bscripts/\S+\.sh", refused.stderr)
        if refused.returncode != 1 or not script or not os.access(source / script.group(), os.X_OK):
            wrong.append(f"hil without an image: exit {refused.returncode}, {refused.stderr}")
    print("\n".join(wrong) or f"components {', '.join(sorted(components))} are whole")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
