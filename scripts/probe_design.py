#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Which probe shows an arm behind a torsion bar: the Cramer-Rao bound in closed form, for docs/column.md.

Column of two masses and a torsion bar, linear; the driver's torque is white noise behind a second-order low pass, the
sensors' noise white. The probe has equal power between two frequencies, or in two bands, or where it makes C's deviation
least. Printed for each: the standard deviation of J, B and C in percent after 30 s at 1 Nm rms, what the hand feels of
it (rms at the rim, Nm), and the rms that brings C to 10 % in 30 s with what the hand feels then. The deviation goes with
1 / (probe sqrt(time)).
"""
import argparse
import math

BANDS_HZ = [(0.2, 6), (0.2, 4), (0.2, 3), (0.2, 2), (0.5, 2), (0.5, 3), (0.7, 2.5), (1, 2), (1, 3), (1, 4), (1, 6)]
BAR, BAR_DAMPING = 150.0, 0.05  # Nm/rad, Nms/rad
COLUMN_INERTIA, COLUMN_DAMPING, RACK = 0.1, 0.9, 15.0  # kg m2, Nms/rad, Nm/rad
ASSIST = 1.0  # motor's torque over the bar's
BAR_NOISE, ANGLE_NOISE, RATE_HZ = 0.02, 5e-4, 100.0  # Nm, rad
DRIVER_HZ, DRIVER_RATIO = 0.4, 0.7  # corner and damping ratio of the driver's torque


def driver_density(rms, f):
    """Two-sided, Nm^2/Hz."""
    x = f / DRIVER_HZ
    shape = 1 / ((1 - x * x) ** 2 + (2 * DRIVER_RATIO * x) ** 2)
    return rms * rms * shape * 2 * DRIVER_RATIO / (math.pi * DRIVER_HZ)


def inverse(m):
    """Of a symmetric 3 x 3 matrix."""
    (a, b, c), (_, e, f), (_, _, i) = m
    cofactors = [[e * i - f * f, c * f - b * i, b * f - c * e],
                 [c * f - b * i, a * i - c * c, b * c - a * f],
                 [b * f - c * e, b * c - a * f, a * e - b * b]]
    determinant = a * cofactors[0][0] + b * cofactors[0][1] + c * cofactors[0][2]
    return [[x / determinant for x in row] for row in cofactors]


def lines(arm, wheel, driver_rms, frequencies):
    """What a line of 1 Nm rms tells of J, B, C within a second, and the mean square of what the hand feels of it."""
    told = []
    for f in frequencies:
        s = 2j * math.pi * f
        above = (arm[0] * s + arm[1]) * s + arm[2]
        below = (COLUMN_INERTIA * s + COLUMN_DAMPING) * s + RACK
        bar = BAR + BAR_DAMPING * s
        torque = -bar / below / (1 + bar / above + (1 + ASSIST) * bar / below)
        angle = abs(torque / above) ** 2
        hand = (arm[0] - wheel[0]) * s * s + (arm[1] - wheel[1]) * s + arm[2]
        noise = (driver_density(driver_rms, f) + BAR_NOISE ** 2 / RATE_HZ
                 + abs(above) ** 2 * ANGLE_NOISE ** 2 / RATE_HZ)
        by = [s * s, s, 1]
        told.append(([[angle * (by[i] * complex(by[j]).conjugate()).real / noise for j in range(3)] for i in range(3)],
                     abs(hand) ** 2 * angle))
    return told


def bound(told, weights, duration_s):
    """Covariance of J, B, C by lines whose mean squares are `weights`, and the rms that the hand feels."""
    information = [[duration_s * sum(w * m[i][j] for w, (m, _) in zip(weights, told)) for j in range(3)]
                   for i in range(3)]
    return inverse(information), math.sqrt(sum(w * felt for w, (_, felt) in zip(weights, told)))


def best_for_stiffness(told):
    """Weights of sum 1 that make C's deviation least: the multiplicative algorithm (Silvey, Titterington and Torsney
    1978, Communications in Statistics A7)."""
    weights = [1 / len(told)] * len(told)
    for _ in range(3000):
        covariance, _ = bound(told, weights, 1)
        c = [row[2] for row in covariance]
        gains = [math.sqrt(sum(c[i] * m[i][j] * c[j] for i in range(3) for j in range(3))) for m, _ in told]
        whole = sum(w * g for w, g in zip(weights, gains))
        weights = [w * g / whole for w, g in zip(weights, gains)]
    return weights


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--arm", type=float, nargs=3, default=[0.10, 1.45, 20], metavar=("J", "B", "C"))
    options.add_argument("--wheel", type=float, nargs=2, default=[0.034, 0.06], metavar=("JW", "BW"))
    options.add_argument("--driver", type=float, nargs="*", default=[0.6, 2.0], help="rms of the driver's torque, Nm")
    chosen = options.parse_args()
    print("| driver, Nm rms | band, Hz | J, B, C in % at 1 Nm rms | felt at the rim, Nm rms | for C to 10 %: Nm rms | felt |")
    print("| --- | --- | --- | --- | --- | --- |")
    for driver in chosen.driver:
        for low, high in BANDS_HZ:
            told = lines(chosen.arm, chosen.wheel, driver, [low + (k + 0.5) * (high - low) / 200 for k in range(200)])
            row(driver, f"{low:g} to {high:g}", bound(told, [1 / 200] * 200, 30), chosen.arm)
        frequencies = [1.5 + 0.02 * k for k in range(100)] + [5 + 0.02 * k for k in range(50)]
        two = bound(lines(chosen.arm, chosen.wheel, driver, frequencies), [0.8 / 100] * 100 + [0.2 / 50] * 50, 30)
        row(driver, "80 % in 1.5 to 3.5, 20 % in 5 to 6", two, chosen.arm)
        frequencies = [0.2 + 0.1 * k for k in range(59)]
        told = lines(chosen.arm, chosen.wheel, driver, frequencies)
        weights = best_for_stiffness(told)
        peaks = ", ".join(f"{100 * w:.0f} % at {f:.1f}" for f, w in zip(frequencies, weights) if w > 0.02)
        row(driver, f"best for C: {peaks}", bound(told, weights, 30), chosen.arm)


def row(driver, band, found, arm):
    covariance, felt = found
    percent = [100 * math.sqrt(covariance[i][i]) / arm[i] for i in range(3)]
    needed = percent[2] / 10
    print(f"| {driver:g} | {band} | {percent[0]:.1f}, {percent[1]:.1f}, {percent[2]:.1f} | {felt:.2f} | {needed:.2f} | "
          f"{needed * felt:.2f} |")


if __name__ == "__main__":
    main()
