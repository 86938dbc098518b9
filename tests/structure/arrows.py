# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The one table of the architecture: what each folder may include.

An arrow that is not here is forbidden. `uses` names folders of this project, `libraries` the others' headers by the
first part of their #include path. `standard` is None where the whole standard library may be used, else the headers
that may be: what is flashed has no heap, no stream, no clock, no thread and no libm.
"""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Rule:
    uses: frozenset = frozenset()
    libraries: frozenset = frozenset()
    standard: frozenset | None = None


def rule(uses="", libraries="", standard=None):
    return Rule(frozenset(uses.split()), frozenset(libraries.split()), standard)


# Headers that need no operating system, no heap and no libm; of <memory> what C++23 has without either, construct_at.
FREESTANDING = frozenset(
    "algorithm array bit climits compare concepts cstddef cstdint limits memory numbers optional span tuple type_traits "
    "utility".split()
)

# Words that have no place in what is flashed, comments and strings aside. `= delete` is another word than `delete`.
FORBIDDEN_IN_FIRMWARE = (
    r"\bnew\b",
    r"(?<!=)(?<!= )\bdelete\b",
    r"\b(?:malloc|calloc|realloc|free)\s*\(",
    r"\bthrow\b",
    r"\btry\b",
    r"\bdynamic_cast\b",
    r"\btypeid\b",
    r"\bvirtual\b",
    r"\bstd::(?:sqrt|sin|cos|tan|exp|log|pow|fma|function|vector|string|chrono)\b",
    r"\bstd::(?:unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared|allocator)\b",
)

ARROWS = {
    "firmware/base": rule(standard=FREESTANDING),
    "firmware/identifier": rule("base", "Eigen", FREESTANDING),
    "firmware/port": rule("base", standard=FREESTANDING),
    "firmware/app": rule("base identifier port", standard=FREESTANDING),
    "hal/link": rule("base port", standard=FREESTANDING),
    "hal/ecu": rule("base port link", standard=FREESTANDING),
    "hal/template_board": rule("base identifier app port link ecu", standard=FREESTANDING),
    "hal/mps2_an386": rule("base identifier app port link ecu", standard=FREESTANDING | {"atomic"}),
    "hal/can": rule("base port", standard=FREESTANDING),
    "hal/linux_gpiod": rule("base port can"),
    "hal/linux_ecu": rule("base port can identifier app linux_gpiod", "nlohmann"),
    "host_sim/log": rule("port", "fmt nlohmann"),
    "host_sim/parallel": rule(),
    "host_sim/plant": rule("log", "Eigen fmt nlohmann"),
    "host_sim/sensors": rule("log plant port", "fmt nlohmann"),
    "host_sim/experiment": rule("base port log plant sensors", "fmt nlohmann"),
    # A wheel's friction is one law in the fit and on the target.
    "host_sim/fit": rule("base identifier port log plant", "Eigen unsupported fmt"),
    "host_sim/gap": rule("base port log parallel plant sensors experiment fit", "Eigen unsupported fmt nlohmann"),
    "host_sim/backend": rule("base port log plant sensors experiment"),
    # Stands for a wheel the project has never seen: nothing of plant, sensors, fit or gap.
    "host_sim/blind": rule("log parallel", "Eigen fmt nlohmann"),
    "host_sim/hil": rule("base identifier app port link log plant backend", "fmt sys"),
    "host_sim/report": rule("log plant", "fmt nlohmann"),
    "host_sim/study": rule(
        "base identifier app port log parallel plant sensors experiment backend blind fit report", "Eigen fmt nlohmann"
    ),
    "host_sim/reproduction": rule(
        "base app port log parallel plant sensors experiment fit backend report study", "Eigen unsupported fmt nlohmann"
    ),
    # Reads the answers of the other commands as files: it shares no type with what makes them.
    "host_sim/fleet": rule("log", "fmt nlohmann openssl"),
    "host_sim/apps": rule(
        "base identifier app port link log parallel plant sensors experiment fit fleet gap backend blind hil report "
        "study reproduction",
        "CLI fmt nlohmann",
    ),
}

# Folders that are divided: what each of their rooms may include of the others. What it may include beyond its folder is
# the folder's.
ROOMS = {
    "host_sim/gap": {
        "hypotheses": frozenset(),
        "likelihood": frozenset("hypotheses".split()),
        "model": frozenset("hypotheses likelihood".split()),
        "preparation": frozenset("hypotheses likelihood model".split()),
        "sets": frozenset("hypotheses likelihood model".split()),
        "diagnosis": frozenset("hypotheses likelihood model preparation sets".split()),
    },
}
