"""Fits the attribution's coefficients (host_sim/gap/attribution/attribution_coefficients.hpp) on drawn records.

usage: calibrate.py [--evaluate] KEY.json ANSWERS [KEY.json ANSWERS ..]

KEY.json is that of `steerid study blind draw`, ANSWERS the folder of `steerid diagnose --batch`. The evidence in every
diagnosis.json is attributed anew, as host_sim/gap/attribution/attribution.cpp does it; coordinate search on the logarithms of the
coefficients lowers the mean log loss plus a pull towards where they are now. Two folds that swap roles say how much of
the gain is left on records that the fit has not seen. Each record is also attributed with its own effect taken away,
where the right answer is `unknown`, at a third of the weight.
"""

import json
import math
import pathlib
import sys

NOW = {"fit": 0.5, "choose": 0.5, "complexity": 1.0, "shift": 1.0, "dispersion_power": 1.0, "none": 2.0,
       "unknown_sharpness": 4.0, "unknown_excess": 0.55, "unknown_unclosed": 0.13, "rival_nats": 12.0,
       "rival_share": 0.5}
DRY = {"coulomb_friction", "stribeck_friction", "asymmetric_friction"}
DEFECTS = {"sample_loss", "coarse_quantization", "torque_saturation"}


def lack_of_fit(best, refit_excess, by):
    excess = max(best["excess"] - 1, 0.02)
    unclosed = min(max(excess / max(refit_excess - 1, 0.05), 1e-4), 1.0)
    by_excess, by_unclosed = (1.0, 1.0) if best["switches"] else (0.3, 0.15) if best["effect"] in DRY else (0.5, 0.3)
    by_shift = math.exp(-0.12 * max(0.0, best["shift"] - 3.5))
    return min(math.log(excess / (by["unknown_excess"] * by_excess * by_shift)),
               math.log(unclosed / (by["unknown_unclosed"] * by_unclosed * by_shift)))


def made_up_by_slow_torque(best):
    return 2.5 * math.log(best["slow_share"] / 0.033) if best["slow_share"] > 0 and not best["switches"] else -99.0


def claimed_by_rivals(best, by):
    loudest = -99.0
    left = max(0.0, best["excess"] - 1) * best["lines"] + math.sqrt(best["lines"])
    for rival in best["rivals"]:
        gained = 1.5 * min(rival["fit_nats"], 2 * rival["choose_nats"])
        nats = (gained - rival["free"] * math.log(max(best["lines"], 2.0)) / 2) / max(1.0, best["excess"])
        if nats > 0:
            loudest = max(loudest, min(math.log(nats / by["rival_nats"]), math.log(gained / left / by["rival_share"])))
    return loudest


def contradicted_by_run(best):
    return 2.5 * math.log(best["run_error"] / 0.4) if best.get("run_error") else -99.0


def ask_for_proof(evidence, score):
    """Stribeck's friction counts when it explains a tenth of what Coulomb's leaves, and not at the end of its range."""
    by_id = {e["effect"]: e for e in evidence}
    coulomb, stribeck = by_id.get("coulomb_friction"), by_id.get("stribeck_friction")
    if not coulomb or not stribeck or coulomb["excess"] <= 1.15:
        return
    if stribeck["at_bound"] or stribeck["excess"] - 1 >= 0.9 * (coulomb["excess"] - 1):
        score["stribeck_friction"] = min(score["stribeck_friction"], score["coulomb_friction"] - 2)


def attribute(evidence, by):
    """Probabilities by id, `unknown` among them."""
    refit_excess = next(e["excess"] for e in evidence if e["effect"] == "parameters")
    open_to_it = [e for e in evidence if e["eligible"]]
    dispersion = max(1.0, min(e["excess"] for e in open_to_it)) ** by["dispersion_power"]
    score = {}
    for e in open_to_it:
        nats = by["fit"] * e["fit_nats"] + by["choose"] * e["choose_nats"] + by["complexity"] * e["complexity"]
        score[e["effect"]] = (by["none"] if e["effect"] == "none" else 0) - nats / dispersion - by["shift"] * e["shift"]
    ask_for_proof(open_to_it, score)
    best = max(score, key=score.get)
    most = next(e for e in open_to_it if e["effect"] == best)
    logit = by["unknown_sharpness"] * max(lack_of_fit(most, refit_excess, by), claimed_by_rivals(most, by),
                                            contradicted_by_run(most), made_up_by_slow_torque(most))
    unknown = 1 / (1 + math.exp(-min(max(logit, -30), 30)))
    weight = {effect: math.exp(s - score[best]) for effect, s in score.items()}
    total = sum(weight.values())
    probability = {effect: (1 - unknown) * w / total for effect, w in weight.items()}
    probability["unknown"] = unknown
    return probability


def read(key_file, answers):
    key = json.loads(pathlib.Path(key_file).read_text())
    records = []
    for name, truth in key.items():
        answer = pathlib.Path(answers) / name / "diagnosis.json"
        if not answer.exists() or truth["label"] in DEFECTS:
            continue
        evidence = json.loads(answer.read_text())["evidence"]
        if any("slow_share" not in e for e in evidence):
            continue
        records.append((name, truth["label"], evidence, 1.0))
        rest = [e for e in evidence if e["effect"] != truth["label"]]
        if truth["label"] not in ("none", "parameters", "unknown") and len(rest) < len(evidence):
            records.append((name + " without", "unknown", rest, 0.33))
    return records


def loss(records, by):
    total = sum(-w * math.log(0.98 * attribute(e, by).get(label, 0) + 0.0008) for _, label, e, w in records)
    pull = sum(math.log(by[k] / NOW[k]) ** 2 for k in NOW)
    return (total + 0.5 * pull) / sum(w for _, _, _, w in records)


def fit(records):
    by = dict(NOW)
    best = loss(records, by)
    for step in (0.5, 0.25, 0.12):
        for _ in range(4):
            before = best
            for name in by:
                for factor in (math.exp(step), math.exp(-step)):
                    trial = dict(by, **{name: by[name] * factor})
                    value = loss(records, trial)
                    if value < best:
                        by, best = trial, value
            if best > before - 1e-4:
                break
    return by


def report(title, records, by):
    rows = [(label, attribute(e, by)) for name, label, e, _ in records if not name.endswith("without")]
    out = [attribute(e, by) for name, _, e, _ in records if name.endswith("without")]
    right = sum(max(p, key=p.get) == label for label, p in rows)
    mean = sum(p.get(label, 0) for label, p in rows) / len(rows)
    brier = sum(sum((q - (k == label)) ** 2 for k, q in p.items()) for label, p in rows) / len(rows)
    alarms = sum(max(p, key=p.get) not in ("none", "parameters") for label, p in rows if label in ("none", "parameters"))
    unknown = [max(p, key=p.get) == "unknown" for label, p in rows if label == "unknown"]
    needless = sum(max(p, key=p.get) == "unknown" for label, p in rows if label != "unknown")
    left_out = sum(max(p, key=p.get) == "unknown" for p in out)
    print(f"{title}: right {right}/{len(rows)}, mean p {mean:.3f}, Brier {brier:.3f}, loss {loss(records, by):.3f}, "
          f"false alarms {alarms}, unknown {sum(unknown)}/{len(unknown)}, needless {needless}, "
          f"left out unknown {left_out}/{len(out)}")


def main(arguments):
    evaluate = arguments[:1] == ["--evaluate"]
    if evaluate:
        arguments = arguments[1:]
    records = [one for i in range(0, len(arguments), 2) for one in read(arguments[i], arguments[i + 1])]
    report("as it is", records, NOW)
    if evaluate:
        for name, label, evidence, _ in records:
            p = attribute(evidence, NOW)
            said = max(p, key=p.get)
            if said != label:
                print(f"  {name}: {label} called {said} {p[said]:.2f}, {p.get(label, 0):.2f} on the truth")
        return
    folds = [[r for i, r in enumerate(records) if hash_of(r[0]) % 2 == fold] for fold in (0, 1)]
    for fold in (0, 1):
        report(f"fold {fold}, fitted on the other", folds[fold], fit(folds[1 - fold]))
    by = fit(records)
    report("fitted on all", records, by)
    for name, value in by.items():
        print(f"    .{name} = {value:.3g},")


def hash_of(name):
    return sum(ord(c) for c in name.split()[0])


if __name__ == "__main__":
    main(sys.argv[1:])
