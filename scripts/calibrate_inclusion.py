#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Fits how probable a change of a simulation is, and writes host_sim/gap/sets/inclusion_calibration.hpp.

Usage: calibrate_inclusion.py [--header FILE] [--table FILE] GENERATOR=KEY.json:ANSWERS ...
       calibrate_inclusion.py --stated GENERATOR=KEY.json:ANSWERS ...

Every GENERATOR is a set of records with known answers: KEY.json as `steerid study blind draw --several` writes it, and
the folder of `steerid diagnose --batch` over its records. A key may be that of ../shared/gap/dev_several as well. A
generator whose name begins with + is fitted and judged, any other is only judged: it is held out.

The model is a logistic regression, by Newton's method, over the inputs of `calibration_inputs`
(host_sim/gap/sets/inclusion.cpp), with a normal prior about zero on every weight but the constant. The prior's
deviation is the one of DEVIATIONS whose probabilities are best (log score) on tasks held out: each of the fitted
generators' tasks (passive, active, probe, loop: other drives, other arms) in turn.

One row is one question: does the wheel have this effect otherwise than simulated? To resize and to remove an effect,
and the kinds of one family, are alternatives of one question (gap/sets/inclusion.hpp): they have the same features,
by which they are joined here. What no set made has no odds and no row; how often that was a change that was drawn is
printed.
"""
import argparse
import json
import math
import pathlib
import sys

NAMES = ["constant", "odds", "left", "share", "shift", "revision", "discrepancy"]
DEVIATIONS = [0.5, 1, 2, 4]
EDGES = [0.0, 0.05, 0.3, 0.5, 0.7, 0.85, 0.95, 0.99, 1.0]
UNTRIED = -999  # log odds of what no set made


def inputs(change):
    """As calibration_inputs() in host_sim/gap/sets/inclusion.cpp."""
    f = change["from"]
    odds = f["log_odds"]
    left = min(f["excess"] - 1, 4 * f["unexplained"])
    return [
        1,
        math.copysign(math.log1p(abs(odds)), odds),
        math.log(max(left, 0.03)),
        math.log(min(max(f["share"], 1e-4), 1)),
        f["shift"],
        0 if change["change"] == "add" else 1,
        math.log1p(f["discrepancy"]),
    ]


def drawn_changes(truth):
    if "changes" in truth:
        return {(one["effect"], one["change"]) for one in truth["changes"]}
    known = truth.get("known") if truth["label"] not in ("pair", "triple") else None  # of ../shared/gap
    if truth["label"] in ("resized", "superfluous"):
        return {(known, "resize" if truth["label"] == "resized" else "remove")}
    return {(one, "add") for one in truth["effects"] if one != known}


class Row:
    def __init__(self, task, x, drawn, log_odds):
        self.task, self.x, self.drawn, self.log_odds = task, x, drawn, log_odds


def rows_of(key_file, answers):
    rows, missed = [], 0
    for name, truth in json.loads(key_file.read_text()).items():
        file = answers / name / "diagnosis.json"
        if not file.exists():
            continue
        drawn = drawn_changes(truth)
        questions = {}
        for change in json.loads(file.read_text())["inclusion"]:
            is_drawn = (change["effect"], change["change"]) in drawn
            if change["from"]["log_odds"] < UNTRIED:
                missed += is_drawn
                continue
            question = questions.setdefault(json.dumps(change["from"]), [change, False])
            question[1] = question[1] or is_drawn
        for change, is_drawn in questions.values():
            rows.append(Row(truth["plant"]["task"], inputs(change), is_drawn, change["from"]["log_odds"]))
    return rows, missed


def logistic(z):
    return 1 / (1 + math.exp(-z)) if z > -700 else 0.0


def probability(weights, row):
    # No calibration turns odds round.
    return min(logistic(sum(w * x for w, x in zip(weights, row.x))), logistic(row.log_odds))


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


def fit(rows, deviation):
    size = len(NAMES)
    weights = [0.0] * size
    for _ in range(50):
        gradient = [0.0] * size
        hessian = [[0.0] * size for _ in range(size)]
        for i in range(1, size):
            gradient[i] -= weights[i] / deviation**2
            hessian[i][i] += 1 / deviation**2
        hessian[0][0] += 1e-6
        for row in rows:
            p = logistic(sum(w * x for w, x in zip(weights, row.x)))
            for i in range(size):
                gradient[i] += (row.drawn - p) * row.x[i]
                for j in range(size):
                    hessian[i][j] += p * (1 - p) * row.x[i] * row.x[j]
        step = solve(hessian, gradient)
        longest = max(abs(s) for s in step)
        weights = [w + s * min(1, 2 / longest) for w, s in zip(weights, step)]
        if longest < 1e-9:
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
    numbers = ", ".join(f"{w:.4g}" for w in weights)
    return f"""// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

#include <array>

namespace steerid {{

/// The weights of a logistic function of `calibration_inputs` (gap/sets/inclusion.cpp):
/// {", ".join(NAMES)}. {len(fitted)} questions; prior deviation {deviation:g}.
inline constexpr std::array<double, {len(weights)}> kInclusionCalibration = {{{numbers}}};

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
