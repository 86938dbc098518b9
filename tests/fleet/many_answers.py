# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""A hundred thousand drawn answers are merged and reported in memory that does not grow with their number, and what was
drawn comes out again.

    many_answers.py BUILD_DIR
    many_answers.py draw FOLDER RECORDS SEED    the answers alone
"""

import csv
import hashlib
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

SHARDS, RECORDS_A_VEHICLE = 20, 5
EFFECTS = ["coulomb_friction", "stribeck_friction", "asymmetric_friction", "presliding_hysteresis", "backlash",
           "quadratic_damping", "cubic_stiffness", "gravity_imbalance", "torque_ripple", "compliance", "reflex", "delay",
           "lag", "hands_off", "time_varying_stiffness", "torque_bias", "torque_drift", "periodic_disturbance",
           "unmeasured_torque", "sample_loss", "coarse_quantization", "torque_saturation"]
# Share of the vehicles that have it; such a vehicle has it in every record.
DRAWN = {"coulomb_friction": 0.4, "delay": 0.1, "torque_bias": 0.02}
MEGABYTE = 1 << 20
# A child's peak counts what its parent held when it was forked: the parent is an interpreter that holds nothing. It
# prints the exit status, the peak in KiB and the seconds of processor time.
MEASURE = """
import os, sys
nothing = [(os.POSIX_SPAWN_OPEN, to, os.devnull, os.O_WRONLY, 0) for to in (1, 2)]
_, status, used = os.wait4(os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ, file_actions=nothing), 0)
print(status, used.ru_maxrss, used.ru_utime + used.ru_stime)
"""


def answer(draw, has, mileage):
    ranking = [{"effect": effect, "probability": 1e-4} for effect in [*EFFECTS, "none", "parameters", "unknown"]]
    named = [effect for effect in EFFECTS if effect in has]
    unknown = draw.random() < 0.03
    inclusion = [{"effect": effect, "change": "add", "probability": 0.97 if effect in has else 0.003}
                 for effect in EFFECTS]
    ranking[-1 if unknown else EFFECTS.index(named[0]) if named else -3]["probability"] = 0.9
    causes = [{"effect": effect, "change": "add", "probability": 0.97, "closes": 0.5,
               "parameters": {"size": draw.gauss(0.5 + 1e-6 * mileage, 0.05)}, "ci95": {"size": [0.4, 0.6]}}
              for effect in named]
    return {"verdict": "unknown" if unknown else named[0] if named else "none", "ranking": ranking,
            "inclusion": inclusion, "causes": causes, "surrogate": False, "equivalent": [],
            "where": {"axis": "frequency", "range": [1.5, 3.0], "unit": "Hz", "share_of_gap": 0.7},
            "gap": {"sim_nrmse": 0.3, "refit_nrmse": 0.2, "with_effect_nrmse": 0.05, "floor_nrmse": 0.04,
                    "closed_fraction": draw.betavariate(18, 2)},
            "base": {name: {"value": draw.gauss(mean, 0.1 * mean), "ci95": [mean, mean]} for name, mean in
                     (("inertia_kgm2", 0.1), ("damping_nms_per_rad", 1.5), ("stiffness_nm_per_rad", 20))}}


def draw_shards(folder, records, seed):
    """Tables of shards as the program writes them, and nothing else: no record has a page."""
    draw = random.Random(seed)
    lines = [[] for _ in range(SHARDS)]
    for vehicle in range(records // RECORDS_A_VEHICLE):
        has = {effect for effect, share in DRAWN.items() if draw.random() < share}
        for i in range(RECORDS_A_VEHICLE):
            name = f"v{vehicle:06}_{i}"
            log = f"{name}/log.csv"
            mileage = draw.uniform(0, 2e5)
            line = {"record": name, "log": log, "vehicle": f"V{vehicle:06}", "date": f"2026-{1 + i:02}-01",
                    "mileage_km": mileage}
            if draw.random() < 0.01:
                line |= {"ended": "unusable", "error": f"{log}: lasts {i} s", "made_from": None, "answer": None}
            else:
                line |= {"ended": "answered", "made_from": None, "answer": answer(draw, has, mileage)}
            number = int(hashlib.sha256(log.encode()).hexdigest()[:16], 16) % SHARDS
            lines[number].append(json.dumps(line))
    # A line that is JSON and no answer: it stops no other.
    lines[0][0] = json.dumps({**json.loads(lines[0][0]), "ended": "answered", "answer": {"verdict": 7}})
    for number, own in enumerate(lines, start=1):
        header = {"schema": "steerid.shard/1", "command": "diagnose", "program": "drawn", "options": {}, "shard": number,
                  "of": SHARDS, "records": len(own), "records_in_all": records, "list_sha256": "drawn"}
        shard = folder / "fleet" / f"shard_{number}_of_{SHARDS}.jsonl"
        shard.parent.mkdir(parents=True, exist_ok=True)
        shard.write_text("\n".join([json.dumps(header), *own]) + "\n", encoding="utf-8")


def measured(*command):
    """The most memory that a program had, and its seconds of processor time."""
    said = subprocess.run([sys.executable, "-I", "-S", "-c", MEASURE, *command], check=True, capture_output=True,
                          text=True).stdout.split()
    assert os.waitstatus_to_exitcode(int(said[0])) == 0, command
    return int(said[1]) * 1024, float(said[2])


def merged(steerid, scratch, records, seed):
    """The folder of the merged answers, and the most memory that the program had."""
    drawn, out = scratch / f"drawn{records}", scratch / f"merged{records}"
    subprocess.run([sys.executable, "-B", __file__, "draw", drawn, str(records), str(seed)], check=True)
    memory, seconds = measured(steerid, "merge", drawn, "--out", out)
    print(f"{records} answers: {memory / MEGABYTE:.1f} MiB, {seconds:.1f} s of processor time")
    return out, memory


def rows(file):
    with open(file, encoding="utf-8", newline="") as text:
        return list(csv.DictReader(text))


def check(out, records):
    with open(out / "fleet" / "records.jsonl", encoding="utf-8") as lines:
        assert sum(1 for _ in lines) == records
    changes = {row["effect"]: row for row in rows(out / "fleet" / "changes.csv") if row["change"] == "add"}
    vehicles = records / RECORDS_A_VEHICLE
    for effect, share in DRAWN.items():
        # Drawn as coins, one a vehicle, then seen with a certainty of 0.97: within four standard deviations.
        sd = (share * (1 - share) / vehicles) ** 0.5
        found = float(changes[effect]["share"])
        assert abs(found - share) < 4 * sd + 0.01, changes[effect]
        assert float(changes[effect]["share_low"]) < found < float(changes[effect]["share_high"])
    for effect in set(EFFECTS) - set(DRAWN):
        assert float(changes[effect]["share_high"]) < 0.01, changes[effect]
    slopes = {(row["of"], row["over"]): row for row in rows(out / "fleet" / "drift.csv")}
    friction = slopes["coulomb_friction size", "mileage"]
    reach = float(friction["slope_high"]) - float(friction["slope_low"])
    assert abs(float(friction["slope"]) - 0.01) < reach, friction  # a kilometre 1e-6; four standard deviations
    (refused,) = [row for row in rows(out / "fleet" / "refused.csv") if row["ended"] == "unusable"]
    assert abs(float(refused["records"]) / records - 0.01) < 4 * (0.01 / records) ** 0.5, refused
    (fault,) = [row for row in rows(out / "fleet" / "refused.csv") if row["ended"] == "fault"]
    assert float(fault["records"]) == 1, fault
    assert (out / "fleet" / "report.html").stat().st_size < 3 * MEGABYTE


def main(build):
    seed = int(os.environ.get("STEERID_SEED", 1))
    print(f"seed {seed} (repeat with STEERID_SEED={seed})")
    with tempfile.TemporaryDirectory(prefix="steerid-many-") as folder:
        few, memory_of_few = merged(build / "steerid", pathlib.Path(folder), 10_000, seed)
        check(few, 10_000)
        many, memory_of_many = merged(build / "steerid", pathlib.Path(folder), 100_000, seed)
        check(many, 100_000)
    # Else it is the measuring process that was measured.
    assert memory_of_few > measured("true")[0]
    assert memory_of_many < 1024 * MEGABYTE
    # Ten times the records; samples are full at 2,000 of them, and an allocator's slack is what is left.
    assert memory_of_many < 1.25 * memory_of_few + 4 * MEGABYTE, (memory_of_few, memory_of_many)
    return 0


if __name__ == "__main__":
    if sys.argv[1] == "draw":
        draw_shards(pathlib.Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]))
        sys.exit(0)
    sys.exit(main(pathlib.Path(sys.argv[1])))
