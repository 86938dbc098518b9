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
which they are joined here. The answer is P = A R: A is what the sets say if one of them is true ("among_sets"), R a
logistic function of the features, that what is seen is the change. The weights of R have the highest likelihood of what
was drawn, with a normal prior of deviation 1 about zero on every weight but the constants. The shares of nats that stand
in R are the largest of SHARES whose log score on tasks held out is within a nat of the best: each of the fitted
generators' tasks (passive, active, probe, loop: other drives, other arms) in turn.

A record gives one more row: is nothing changed but J, B and C? It counts where the sets say so, and where what was drawn
is nothing that the library holds: there no change is what a library without anything near would be left with.

What no set made has no row; how often that was a change that was drawn is printed.
"""
import argparse
import json
import math
import pathlib
import sys

import numpy as np

NAMES = ["changed", "ratio", "shift", "unchanged"]
PRECISION = np.array([1e-6, 1, 1, 1e-6])  # of the weights' prior
SHARES = [(of_left, of_gap) for of_left in (0.1, 0.3, 1) for of_gap in (0, 1e-4, 3e-4, 1e-3)]
EDGES = [0.0, 0.05, 0.3, 0.5, 0.7, 0.85, 0.95, 0.99, 1.0]
DEFECTS = {"sample_loss", "coarse_quantization", "torque_saturation"}  # of the record: repaired before anything is fitted


def drawn_changes(truth):
    if truth["label"] == "unknown":
        return set()
    if "changes" in truth:
        return {(one["effect"], one["change"]) for one in truth["changes"]}
    known = truth.get("known") if truth["label"] not in ("pair", "triple") else None  # of ../shared/gap
    if truth["label"] in ("resized", "superfluous"):
        return {(known, "resize" if truth["label"] == "resized" else "remove")}
    return {(one, "add") for one in truth.get("effects") or [] if one != known}


class Rows:
    """One question an entry. `made`: a change was asked for, rather than none."""

    def __init__(self):
        self.task, self.made, self.drawn, self.among = [], [], [], []
        self.gain, self.left, self.gap, self.discrepancy, self.shift = [], [], [], [], []

    def add(self, task, made, drawn, among, gain, left, gap, discrepancy, shift):
        for name, value in list(locals().items()):
            if name != "self":
                getattr(self, name).append(value)

    def joined(self, others):
        out = Rows()
        for name in vars(out):
            setattr(out, name, np.concatenate([np.array(getattr(one, name)) for one in [self, *others]]))
        return out

    def where(self, those):
        out = Rows()
        for name in vars(out):
            setattr(out, name, getattr(self, name)[those])
        return out

    def inputs(self, shares):
        """As real() and nothing_else() in host_sim/gap/sets/inclusion.cpp."""
        ratio = np.log(self.gain / (shares[0] * self.left + self.discrepancy + shares[1] * self.gap))
        return np.column_stack([self.made, ratio, self.made * self.shift, 1 - self.made])


def add_row_of_none(rows, truth, answer, drawn):
    plain = [one for one in answer["evidence"] if not one["changes"]]
    best = max(plain, key=lambda one: one["log_odds"])
    discrepancy = answer["inclusion"][0]["from"]["discrepancy_nats"]
    total = sum(math.exp(one["log_odds"]) for one in answer["evidence"])
    unknown = truth["label"] == "unknown"
    among = 1 if unknown else sum(math.exp(one["log_odds"]) for one in plain) / total
    rows.add(truth["plant"]["task"], 0, not unknown and not drawn, among, 1, best["left_nats"], 0, discrepancy, 0)


def rows_of(key_file, answers):
    rows, missed = Rows(), 0
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
        for f, is_drawn in questions.values():
            rows.add(truth["plant"]["task"], 1, is_drawn, f["among_sets"], f["gain_nats"], f["left_nats"], f["gap_nats"],
                     f["discrepancy_nats"], f["shift"])
        add_row_of_none(rows, truth, answer, drawn)
    return rows.joined([]), missed


def probability(weights, shares, rows):
    return rows.among / (1 + np.exp(-np.clip(rows.inputs(shares) @ weights, -500, 500)))


def stated(key_file, answers):
    """Bands of the probability that the answers state: (low, high, changes, mean, share that was drawn)."""
    said = []
    for name, truth in json.loads(key_file.read_text()).items():
        file = answers / name / "diagnosis.json"
        if not file.exists():
            continue
        drawn = drawn_changes(truth)
        for change in json.loads(file.read_text())["inclusion"]:
            said.append((change["probability"], (change["effect"], change["change"]) in drawn))
    lines = []
    for low, high in zip(EDGES, EDGES[1:]):
        band = [one for one in said if low <= one[0] < high or one[0] == high == 1]
        if band:
            lines.append((low, high, len(band), sum(p for p, _ in band) / len(band), sum(d for _, d in band) / len(band)))
    return lines


def log_scores(weights, shares, rows):
    p = np.clip(probability(weights, shares, rows), 1e-6, 1 - 1e-6)
    return np.where(rows.drawn, np.log(p), np.log(1 - p))


def fit(rows, shares):
    """By expectation (is a change that was not drawn none by A or by R?) and maximisation (Dempster, Laird and Rubin
    1977), each a logistic regression by Newton's method."""
    x = rows.inputs(shares)
    weights = np.zeros(len(NAMES))
    for _ in range(300):
        p = 1 / (1 + np.exp(-np.clip(x @ weights, -500, 500)))
        target = np.where(rows.drawn, 1, p * (1 - rows.among) / np.maximum(1 - rows.among * p, 1e-300))
        before = weights
        for _ in range(50):
            p = 1 / (1 + np.exp(-np.clip(x @ weights, -500, 500)))
            gradient = x.T @ (target - p) - PRECISION * weights
            hessian = (x * (p * (1 - p))[:, None]).T @ x + np.diag(PRECISION)
            step = np.linalg.solve(hessian, gradient)
            weights = weights + step * min(1, 2 / max(np.abs(step).max(), 1e-12))
            if np.abs(step).max() < 1e-9:
                break
        if np.abs(weights - before).max() < 1e-6:
            break
    return weights


def chosen_shares(rows):
    def held_out(shares):
        score = 0
        for task in sorted(set(rows.task)):
            out = rows.task == task
            score += log_scores(fit(rows.where(~out), shares), shares, rows.where(out)).sum()
        return score

    scores = {shares: held_out(shares) for shares in SHARES}
    return max(shares for shares in SHARES if scores[shares] >= max(scores.values()) - 1)


def reliability(weights, shares, rows):
    lines = []
    p = probability(weights, shares, rows)
    for low, high in zip(EDGES, EDGES[1:]):
        band = (low <= p) & ((p < high) | (high == 1))
        if band.any():
            lines.append((low, high, band.sum(), p[band].mean(), rows.drawn[band].mean()))
    return lines


def header(weights, shares, fitted):
    numbers = ", ".join(f"{w:.4g}" for w in [*weights, *shares])
    return f"""// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

#include "gap/sets/inclusion.hpp"

namespace steerid::gap {{

/// {len(fitted.drawn)} questions.
inline constexpr InclusionCalibration kInclusionCalibration = {{{numbers}}};

}}  // namespace steerid::gap
"""


def table(generators, weights, shares):
    text = ["Weights: ", ", ".join(f"{name} {w:.3g}" for name, w in zip(NAMES, weights))]
    text.append(f"; shares of nats: left {shares[0]:g}, gap {shares[1]:g}.\n")
    for name, (rows, missed) in generators.items():
        text.append(
            f"\n{name.lstrip('+')} ({'fitted' if name.startswith('+') else 'held out'}): {len(rows.drawn)} questions, "
            f"{int((rows.drawn & (rows.made == 1)).sum())} with a drawn change; {missed} drawn changes were in no set. "
            f"Mean log score {log_scores(weights, shares, rows).mean():.3f} nats.\n"
        )
        text.append("\n| probability | questions | expected | observed |\n| --- | --- | --- | --- |\n")
        for low, high, count, expected, observed in reliability(weights, shares, rows):
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
    fitted = [rows for name, (rows, _) in generators.items() if name.startswith("+")]
    if not fitted:
        sys.exit("no generator to fit: begin the name of one with +")
    rows = fitted[0].joined(fitted[1:])
    shares = chosen_shares(rows)
    weights = fit(rows, shares)
    says = table(generators, weights, shares)
    print(says)
    if arguments.table:
        arguments.table.write_text(says)
    if arguments.header:
        arguments.header.write_text(header(weights, shares, rows))


if __name__ == "__main__":
    main()
