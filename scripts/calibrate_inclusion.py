#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Fits how probable a change of a simulation is, and writes host_sim/gap/sets/inclusion_calibration.hpp.

Usage: calibrate_inclusion.py [--header FILE] [--table FILE] GENERATOR=KEY.json:ANSWERS ...
       calibrate_inclusion.py --stated GENERATOR=KEY.json:ANSWERS ...

Every GENERATOR is a set of records with known answers: KEY.json as `steerid study blind draw` writes it, with or without
--several, and the folder of `steerid diagnose --batch` over its records. A key may be one of ../shared/gap as well. A
generator whose name begins with + is fitted and judged, any other is only judged: it is held out.

One row is one question: does the wheel have this effect otherwise than simulated? To resize and to remove an effect,
and the kinds of one family, are alternatives of one question (gap/sets/inclusion.hpp): they have the same features, by
which they are joined here. The answer is P = A x R: A is what the sets say if one of them is true ("among_sets"), R a
logistic function of the features, that what is seen is the change. Whether it was is known where the change was drawn;
where it was not, the change may be none by A or by R. So the weights are fitted by expectation and maximisation
(Dempster, Laird and Rubin 1977), each step a logistic regression by Newton's method, with a normal prior about zero on
every weight but the constants. The prior's deviation is the one of DEVIATIONS whose probabilities are best (log score)
on tasks held out: each of the fitted generators' tasks (passive, active, probe, loop: other drives, other arms) in turn.

A record gives one more row: is nothing changed but J, B and C? It counts where the sets say so, and where what was drawn
is nothing that the library holds: there no change is what a library without anything near would be left with.

What no set made has no row; how often that was a change that was drawn is printed.
"""
import argparse
import json
import math
import pathlib
import sys

NAMES = ["changed", "ratio", "shift", "unchanged"]
CONSTANTS = (0, 3)
DEVIATIONS = [0.5, 1, 2, 4]
EDGES = [0.0, 0.05, 0.3, 0.5, 0.7, 0.85, 0.95, 0.99, 1.0]
DEFECTS = {"sample_loss", "coarse_quantization", "torque_saturation"}  # of the record: repaired before anything is fitted


def inputs_of_change(f):
    """As real() in host_sim/gap/sets/inclusion.cpp."""
    return [1, math.log(f["gain_nats"] / (f["left_nats"] + f["discrepancy_nats"])), f["shift"], 0]


def inputs_of_none(left_nats, discrepancy_nats):
    """As nothing_else() there."""
    return [0, -math.log(left_nats + discrepancy_nats), 0, 1]


def drawn_changes(truth):
    if truth["label"] == "unknown":
        return set()
    if "changes" in truth:
        return {(one["effect"], one["change"]) for one in truth["changes"]}
    known = truth.get("known") if truth["label"] not in ("pair", "triple") else None  # of ../shared/gap
    if truth["label"] in ("resized", "superfluous"):
        return {(known, "resize" if truth["label"] == "resized" else "remove")}
    return {(one, "add") for one in truth.get("effects") or [] if one != known}


class Row:
    def __init__(self, task, x, drawn, among):
        self.task, self.x, self.drawn, self.among = task, x, drawn, among


def row_of_none(truth, answer, drawn):
    plain = [one for one in answer["evidence"] if not one["changes"]]
    best = max(plain, key=lambda one: one["log_odds"])
    left = max(best["excess"] - 1, 0) * best["lines"] + math.sqrt(best["lines"]) / 2  # as FittedSet::left_nats()
    is_answer = not answer["evidence"][0]["changes"]
    discrepancy = answer["inclusion"][0]["from"]["discrepancy_nats"] if is_answer else 0
    total = sum(math.exp(one["log_odds"]) for one in answer["evidence"])
    unknown = truth["label"] == "unknown"
    among = 1 if unknown else sum(math.exp(one["log_odds"]) for one in plain) / total
    return Row(truth["plant"]["task"], inputs_of_none(left, discrepancy), not unknown and not drawn, among)


def rows_of(key_file, answers):
    rows, missed = [], 0
    for name, truth in json.loads(key_file.read_text()).items():
        file = answers / name / "diagnosis.json"
        if not file.exists():
            continue
        answer = json.loads(file.read_text())
        drawn = {one for one in drawn_changes(truth) if one[0] not in DEFECTS}
        questions = {}
        for change in answer["inclusion"]:
            is_drawn = (change["effect"], change["change"]) in drawn
            if change["from"]["gain_nats"] <= 1:
                missed += is_drawn
                continue
            question = questions.setdefault(json.dumps(change["from"]), [change["from"], False])
            question[1] = question[1] or is_drawn
        for features, is_drawn in questions.values():
            rows.append(Row(truth["plant"]["task"], inputs_of_change(features), is_drawn, features["among_sets"]))
        rows.append(row_of_none(truth, answer, drawn))
    return rows, missed


def logistic(z):
    return 1 / (1 + math.exp(-z)) if z > -700 else 0.0


def real(weights, row):
    return logistic(sum(w * x for w, x in zip(weights, row.x)))


def probability(weights, row):
    return row.among * real(weights, row)


def stated(key_file, answers):
    """Bands of the probability that the answers state: (low, high, changes, mean, share that was drawn)."""
    said = []
    for name, truth in json.loads(key_file.read_text()).items():
        file = answers / name / "diagnosis.json"
        if not file.exists():
            continue
        drawn = drawn_changes(truth)
        for change in json.loads(file.read_text())["inclusion"]:
            if "from" in change:  # by sets
                said.append((change["probability"], (change["effect"], change["change"]) in drawn))
    lines = []
    for low, high in zip(EDGES, EDGES[1:]):
        band = [one for one in said if low <= one[0] < high or one[0] == high == 1]
        if band:
            lines.append((low, high, len(band), sum(p for p, _ in band) / len(band), sum(d for _, d in band) / len(band)))
    return lines


def solve(matrix, right):
    """Gauss's elimination; the matrix is positive definite."""
    a = [list(line) + [r] for line, r in zip(matrix, right)]
    for i in range(len(a)):
        for j in range(i + 1, len(a)):
            factor = a[j][i] / a[i][i]
            for k in range(i, len(a) + 1):
                a[j][k] -= factor * a[i][k]
    x = [0.0] * len(a)
    for i in reversed(range(len(a))):
        x[i] = (a[i][-1] - sum(a[i][k] * x[k] for k in range(i + 1, len(a)))) / a[i][i]
    return x


def regression(rows, targets, deviation, weights):
    """Logistic, of targets from 0 to 1, from `weights` on."""
    size = len(NAMES)
    for _ in range(50):
        gradient = [0.0] * size
        hessian = [[0.0] * size for _ in range(size)]
        for i in range(size):
            precision = 1e-6 if i in CONSTANTS else 1 / deviation**2
            gradient[i] -= weights[i] * precision
            hessian[i][i] += precision
        for row, target in zip(rows, targets):
            p = real(weights, row)
            for i in range(size):
                gradient[i] += (target - p) * row.x[i]
                for j in range(size):
                    hessian[i][j] += p * (1 - p) * row.x[i] * row.x[j]
        step = solve(hessian, gradient)
        longest = max(abs(s) for s in step)
        weights = [w + s * min(1, 2 / longest) for w, s in zip(weights, step)]
        if longest < 1e-9:
            break
    return weights


def fit(rows, deviation):
    weights = [0.0] * len(NAMES)
    for _ in range(300):
        targets = []
        for row in rows:
            p = real(weights, row)
            targets.append(1.0 if row.drawn else p * (1 - row.among) / max(1 - row.among * p, 1e-300))
        before, weights = weights, regression(rows, targets, deviation, weights)
        if max(abs(a - b) for a, b in zip(before, weights)) < 1e-6:
            break
    return weights


def log_score(weights, rows):
    total = 0.0
    for row in rows:
        p = min(max(probability(weights, row), 1e-6), 1 - 1e-6)
        total += math.log(p if row.drawn else 1 - p)
    return total


def chosen_deviation(rows):
    tasks = sorted({row.task for row in rows})

    def held_out(deviation):
        return sum(
            log_score(fit([r for r in rows if r.task != task], deviation), [r for r in rows if r.task == task])
            for task in tasks
        )

    return max(DEVIATIONS, key=held_out)


def reliability(weights, rows):
    lines = []
    for low, high in zip(EDGES, EDGES[1:]):
        band = [r for r in rows if low <= probability(weights, r) < high or (high == 1 and probability(weights, r) == 1)]
        if band:
            expected = sum(probability(weights, r) for r in band) / len(band)
            lines.append((low, high, len(band), expected, sum(r.drawn for r in band) / len(band)))
    return lines


def header(weights, deviation, fitted):
    return f"""// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

namespace steerid {{

/// Weights of the logistic functions of gap/sets/inclusion.cpp.
struct InclusionCalibration {{
  double changed;    ///< constant of a change
  double ratio;      ///< of the log of nats gained over nats left
  double shift;      ///< of how far J, B and C moved
  double unchanged;  ///< constant of no change
}};

/// {len(fitted)} questions; prior deviation {deviation:g}.
inline constexpr InclusionCalibration kInclusionCalibration = {{{", ".join(f"{w:.4g}" for w in weights)}}};

}}  // namespace steerid
"""


def table(generators, weights, deviation):
    text = [f"Prior deviation {deviation:g}; weights: "]
    text.append(", ".join(f"{name} {w:.3g}" for name, w in zip(NAMES, weights)) + ".\n")
    for name, (rows, missed) in generators.items():
        drawn = sum(r.drawn for r in rows)
        text.append(
            f"\n{name.lstrip('+')} ({'fitted' if name.startswith('+') else 'held out'}): {len(rows)} questions, "
            f"{drawn} with a drawn change; {missed} drawn changes were in no set. "
            f"Mean log score {log_score(weights, rows) / max(len(rows), 1):.3f} nats.\n"
        )
        text.append("\n| probability | questions | expected | observed |\n| --- | --- | --- | --- |\n")
        for low, high, count, expected, observed in reliability(weights, rows):
            text.append(f"| {low:g} to {high:g} | {count} | {expected:.3f} | {observed:.3f} |\n")
    return "".join(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--header", type=pathlib.Path)
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--stated", action="store_true", help="fit nothing: judge the probabilities in the answers")
    parser.add_argument("generators", nargs="+", metavar="GENERATOR=KEY.json:ANSWERS")
    arguments = parser.parse_args()
    generators = {}
    for word in arguments.generators:
        name, _, files = word.partition("=")
        key, _, answers = files.partition(":")
        if arguments.stated:
            print(f"{name}\n\n| stated | changes | mean | observed |\n| --- | --- | --- | --- |")
            for low, high, count, mean, observed in stated(pathlib.Path(key), pathlib.Path(answers)):
                print(f"| {low:g} to {high:g} | {count} | {mean:.3f} | {observed:.3f} |")
            continue
        generators[name] = rows_of(pathlib.Path(key), pathlib.Path(answers))
    if arguments.stated:
        return
    fitted = [row for name, (rows, _) in generators.items() if name.startswith("+") for row in rows]
    if not fitted:
        sys.exit("no generator to fit: begin the name of one with +")
    deviation = chosen_deviation(fitted)
    weights = fit(fitted, deviation)
    says = table(generators, weights, deviation)
    print(says)
    if arguments.table:
        arguments.table.write_text(says)
    if arguments.header:
        arguments.header.write_text(header(weights, deviation, fitted))


if __name__ == "__main__":
    main()
