# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Every command that writes, with all that it writes, as short as it can be run."""

import contextlib
import dataclasses
import json
import pathlib
import shutil
import subprocess
import tempfile


@dataclasses.dataclass(frozen=True)
class Command:
    words: str                 # {OPTION} stands for the file or folder of an output
    outputs: dict              # of each option its file, or its folder with a / behind it
    inputs: tuple = ()         # of its words those that are files which are read
    slow: bool = False         # seconds a run: fewer of its calls are made to fail

    @property
    def name(self):
        return self.words.split(" --")[0] + "".join(f" {option}" for option in self.outputs)

    def arguments(self, places=None):
        """Its words, with other places for some outputs."""
        return [word.format(**{key.strip("-"): place for key, place in {**self.outputs, **(places or {})}.items()})
                for word in self.words.split()]


def command(words, slow=False, inputs="", **outputs):
    return Command(words, {"--" + key: place for key, place in outputs.items()}, tuple(inputs.split()), slow)


COMMANDS = [
    command("simulate --task probe --sim sim.json --duration 3 --out {out}", out="out.csv", inputs="sim.json"),
    command("simulate --task probe --sim sim.json --duration 3 --out {out}", out="out.mcap", inputs="sim.json"),
    command("simulate --task drive --column column.json --duration 3 --out {out} --truth {truth}", out="out.csv",
            truth="truth.csv", inputs="column.json"),
    command("simulate --sim sim.json --replay drive.csv --out {out}", out="pred.csv", inputs="sim.json drive.csv"),
    command("simulate --sim sim.json --replay drive.csv --out {out}", out="pred.mcap", inputs="sim.json drive.csv"),
    command("inspect drive.csv --json {json}", json="seen.json", inputs="drive.csv"),
    command("identify drive.csv --json {json} --trace {trace} --layout {layout} --report {report}", json="answer.json",
            trace="trace.csv", layout="layout.xml", report="page.html", inputs="drive.csv"),
    command("identify drive.csv --trace {trace}", trace="trace.mcap", inputs="drive.csv"),
    command("identify drive.csv --figures {figures}", slow=True, figures="figures/", inputs="drive.csv"),
    command("identify --folder records --out {out}", out="answers/"),
    command("diagnose --real drive.csv --sim sim.json --out {out}", slow=True, out="gap/", inputs="drive.csv sim.json"),
    command("diagnose --batch records --no-report --out {out}", slow=True, out="gaps/"),
    command("merge part1 part2 --out {out}", out="merged/"),
    command("study soak --updates 10000 --out {out}", out="study/"),
    command("study efficiency --drives 10 --out {out}", slow=True, out="study/"),
    command("study closed_loop --drives 10 --out {out}", slow=True, out="study/"),
    command("study blind draw --cases 1 --out {out}", slow=True, out="drawn/"),
    command("study blind seal --cases 1 --out {out}", slow=True, out="sealed/"),
    command("study blind score --out scored", slow=True),
    command("template sim --out {out}", out="new.json"),
    command("template column --out {out}", out="new.json"),
    command("template daemon --out {out}", out="new.json"),
    command("manual --out {out}", out="steerid.1"),
    command("completion --out {out}", out="steerid.bash"),
]
HIL = command("hil --emulate an386 drive.csv --json {json}", slow=True, json="hil.json", inputs="drive.csv")


def commands_of(steerid):
    """All that this program can run here."""
    return COMMANDS + ([HIL] if emulates(steerid) else [])


def emulates(steerid):
    """Whether there is an emulator, and beside the program an image for it."""
    return bool(shutil.which("qemu-system-arm")) and (steerid.parent / "firmware/steerid-an386.elf").exists()


def make_inputs(steerid, folder):
    """What the commands read."""
    def run(*words):
        subprocess.run([steerid, *words, "--quiet"], cwd=folder, check=True)

    run("template", "sim", "--out", "sim.json")
    run("template", "column", "--out", "column.json")
    run("simulate", "--task", "probe", "--duration", "10", "--out", "drive.csv")
    (folder / "records/a").mkdir(parents=True)
    shutil.copy(folder / "drive.csv", folder / "records/a/log.csv")
    shutil.copy(folder / "sim.json", folder / "records/a/sim.json")
    for part in ("1", "2"):
        run("identify", "--folder", "records", "--no-report", "--shard", f"{part}/2", "--out", f"part{part}")
    run("study", "blind", "seal", "--cases", "1", "--out", "scored")


@contextlib.contextmanager
def prepared(steerid, only):
    """A folder that goes again, the folder in it of all that is read, and the commands with `only` in their names."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        inputs = folder / "inputs"
        inputs.mkdir()
        make_inputs(steerid, inputs)
        yield folder, inputs, [command for command in commands_of(steerid) if only in command.name]


def settled(path):
    """What is in a file; of a run on an ECU without how long its steps took, which differs."""
    held = path.read_bytes()
    if path.name != "hil.json":
        return held
    try:
        return json.dumps({key: value for key, value in json.loads(held).items() if key != "deadlines"}).encode()
    except ValueError:
        return held


def state_of(folder):
    """Every file below the folder with what is in it."""
    return {str(path.relative_to(folder)): settled(path) for path in pathlib.Path(folder).rglob("*") if path.is_file()}
