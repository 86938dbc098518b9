#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""How many arms that brace could be told as `braced` within 15 s at all: the Cramer-Rao bound under the task's rule.

Arms, columns and steering are drawn as `steerid study hands` draws them (6 to 11 Nm/rad that become three times as
stiff, steering of 0.01 to 0.1 rad rms, self-aligning stiffness 2 to 25 Nm/rad). An estimator at the bound is given all
that the probe shows from the moment of bracing on, knows that moment, and forgets what it knew before; the column has
no friction. That is more than any identifier has. The rule is that of firmware/app/driver_state.hpp: C less two
deviations above 17 Nm/rad, or above 9 /s times B and two of its deviations, C known to a fifth.
"""
import argparse
import math
import random

import probe_design

RULE_C, RULE_RATIO, USABLE = 17.0, 9.0, 0.2  # Nm/rad, 1/s, a deviation of C
ALLOWED_S = 15.0
LINES_HZ = [0.2 + (k + 0.5) * 5.8 / 40 for k in range(40)]
ANSWERS = 40  # drawn of each arm


def told_share(draw, probe_rms, steering):
    """Of ANSWERS estimates at the bound of one arm, the share that the rule calls braced; and C."""
    wheel = (draw.uniform(0.026, 0.043), draw.uniform(0.03, 0.08))
    arm = (wheel[0] + draw.uniform(0.05, 0.1), wheel[1] + 0.7 * (2.2 / 0.7) ** draw.random(), 3 * draw.uniform(6, 11))
    probe_design.RACK = draw.uniform(2, 25)
    told = probe_design.lines(arm, wheel, arm[2] * steering(draw), LINES_HZ)
    weights = [probe_rms ** 2 / len(told)] * len(told)
    covariance, _ = probe_design.bound(told, weights, ALLOWED_S)
    sd_b, sd_c = math.sqrt(covariance[1][1]), math.sqrt(covariance[2][2])
    mixed = covariance[1][2] / sd_b
    braced = 0
    for _ in range(ANSWERS):
        x, y = draw.gauss(0, 1), draw.gauss(0, 1)
        b = arm[1] + sd_b * x
        c = arm[2] + mixed * x + math.sqrt(max(0.0, sd_c ** 2 - mixed ** 2)) * y
        low = c - 2 * sd_c
        braced += sd_c < USABLE * c and (low > RULE_C or low > RULE_RATIO * (b + 2 * sd_b))
    return braced / ANSWERS, arm[2]


def missed(probe_rms, steering, arms, seed, softest=0.0):
    """Percent, of the arms that are at least so stiff once they brace."""
    draw = random.Random(seed)
    told = [share for share, c in (told_share(draw, probe_rms, steering) for _ in range(arms)) if c >= softest]
    return 100 * (1 - sum(told) / len(told))


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--arms", type=int, default=400)
    options.add_argument("--seed", type=int, default=1)
    chosen = options.parse_args()
    steerings = [("0.01 rad", lambda draw: 0.01), ("0.03 rad", lambda draw: 0.03), ("0.1 rad", lambda draw: 0.1),
                 ("0.01 to 0.1 rad", lambda draw: draw.uniform(0.01, 0.1))]
    print("| probe, Nm rms | driver steers | missed after 15 s at the bound, % | of arms above 21 Nm/rad, % |")
    print("| --- | --- | --- | --- |")
    for probe_rms in (0.5, 1.0, 2.0):
        for name, steering in steerings:
            both = [missed(probe_rms, steering, chosen.arms, chosen.seed, softest) for softest in (0.0, 21.0)]
            print(f"| {probe_rms:g} | {name} | {both[0]:.0f} | {both[1]:.0f} |")


if __name__ == "__main__":
    main()
