# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""Works experiment.json's tables and figures out again from its single records, and holds them against the aims.

    check_experiment.py experiment.json
"""

import json
import math
import statistics
import sys
import unittest

KEYS = ("inertia_kgm2", "damping_nms_per_rad", "stiffness_nm_per_rad")
data = {}


def frequency_hz(arm):
    """Equation 5 of the paper, or None where the damping ratio is 1 or more."""
    j, b, c = (arm[key] for key in KEYS)
    square = c / j - (b / (2 * j)) ** 2
    return math.sqrt(square) / (2 * math.pi) if square > 0 else None


def records(probed, **wanted):
    return [
        record
        for record in data["figure_8_and_9"]
        if (record["probe_rms_nm"] > 0) == probed and all(record[key] == value for key, value in wanted.items())
    ]


def valid_values(found, method, key):
    return [record[method][key]["value"] for record in found if record[method][key]["state"] == "valid"]


class Tables(unittest.TestCase):
    def test_every_record_is_there(self):
        self.assertEqual(data["schema"], "steerid.experiment/1")
        for probed in (False, True):
            found = records(probed)
            self.assertEqual(len(found), 120)
            self.assertEqual(len({(r["subject"], r["task"], r["hands"]) for r in found}), 120)

    def test_rows_are_medians_and_ends_of_the_records(self):
        self.assertEqual(len(data["tables"]), 12)
        for row in data["tables"]:
            for probed, method, column in (
                (False, "batch", "batch_as_in_the_paper"),
                (True, "batch", "batch_with_probe"),
                (True, "recursive", "recursive_with_probe"),
            ):
                found = records(probed, task=row["task"], hands=row["hands"])
                for key in KEYS:
                    values = valid_values(found, method, key)
                    self.assertEqual(row[column][key]["count"], len(values))
                    if values:
                        self.assertAlmostEqual(row[column][key]["nominal"], statistics.median(values), 12)
                        self.assertEqual(row[column][key]["range"], [min(values), max(values)])

    def test_true_frequencies_follow_from_equation_5_or_are_named(self):
        named = {(one["subject"], one["task"], one["hands"]) for one in data["overdamped"]}
        for row in data["tables"]:
            found = records(True, task=row["task"], hands=row["hands"])
            values = [frequency_hz(record["true"]) for record in found]
            for record, value in zip(found, values):
                self.assertEqual(value is None, (record["subject"], record["task"], record["hands"]) in named)
            there = [value for value in values if value is not None]
            self.assertEqual(row["true"]["natural_frequency_hz"]["count"], len(there))
            if there:
                self.assertAlmostEqual(row["true"]["natural_frequency_hz"]["nominal"], statistics.median(there), 9)

    def test_stated_frequencies_belong_to_valid_parameters_that_swing(self):
        for record in data["figure_8_and_9"]:
            for method in ("batch", "recursive"):
                answer = record[method]
                stated = answer["natural_frequency_hz"]
                arm = {key: answer[key]["value"] for key in KEYS}
                valid = all(answer[key]["state"] == "valid" for key in KEYS)
                expected = frequency_hz(arm) if valid else None
                if expected is None:
                    self.assertIsNone(stated["value"])
                    self.assertTrue(stated["reason"])
                else:
                    self.assertAlmostEqual(stated["value"], expected, 9)


class Findings(unittest.TestCase):
    """What the issue asks for and the paper found, with the limits' origins."""

    def test_accuracy_is_above_the_papers(self):
        # "Over 97 %" in the paper; 99 % under 5 Hz is the aim.
        self.assertGreater(data["amplitude_fit_percent"], 98.9)
        self.assertLessEqual(data["amplitude_fit_percent"], 100)
        for one in data["amplitude_fit"].values():
            # No fit can be much better than the true arm; a worse one would be the identification's fault.
            self.assertAlmostEqual(one["median_percent"], one["true_arm_median_percent"], delta=0.1)

    def test_with_the_probe_the_answers_are_the_true_ones(self):
        # Ten times the Cramer-Rao bound of 0.5 Nm rms, some 0.1 %, leaves room for the drift of C.
        for record in records(True):
            for key in KEYS:
                self.assertEqual(record["batch"][key]["state"], "valid")
                self.assertLess(abs(record["batch"][key]["value"] / record["true"][key] - 1), 0.02)

    def test_the_probe_is_what_shows_the_inertia(self):
        rms = {}
        for one in data["errors"]:
            if one["method"] == "batch_gauss_newton":
                rms[one["task"], one["probe_rms_nm"] > 0] = one["relative_rms_error"]["inertia_kgm2"]
        for task in ("passive", "active"):
            self.assertGreater(rms[task, False], 5 * rms[task, True])

    def test_correlations_are_pearsons(self):
        labels = (
            lambda r: 1.0 if r["task"] == "passive" else 0.0,
            lambda r: 2.0 if r["hands"].startswith("both") else 1.0,
            lambda r: {"3": 1.0, "12": 2.0, "130": 3.0, "3_9": 1.0, "12_6": 2.0, "10_10": 3.0}[r["hands"].split("_", 1)[1]],
        )
        for i, label in enumerate(labels):
            for k, key in enumerate(KEYS + ("natural_frequency_hz",)):
                found = [r for r in records(True) if r["batch"][key]["value"] is not None]
                if key in KEYS:
                    found = [r for r in found if r["batch"][key]["state"] == "valid"]
                x = [label(r) for r in found]
                y = [r["batch"][key]["value"] for r in found]
                one = data["figure_10"][4 * i + k]
                self.assertEqual(one["records"], len(y))
                self.assertAlmostEqual(one["pearson"]["r"], statistics.correlation(x, y), 9)

    def test_labels_are_tested_within_the_subjects(self):
        """The analysis of variance worked out again from the single records: by the paired t test for two levels, by
        Box's formula of the covariances for the three positions."""
        tested = 0
        for i, level_of in enumerate((
            lambda r: r["task"] == "passive",
            lambda r: r["hands"].startswith("both"),
            lambda r: {"3": 0, "12": 1, "130": 2, "3_9": 0, "12_6": 1, "10_10": 2}[r["hands"].split("_", 1)[1]],
        )):
            for k, key in enumerate(KEYS):
                table = []
                for subject in range(1, 11):
                    own = records(True, subject=subject)
                    if any(r["batch"][key]["state"] != "valid" for r in own):
                        continue
                    levels = sorted({int(level_of(r)) for r in own})
                    table.append([statistics.mean(r["batch"][key]["value"] for r in own if level_of(r) == level)
                                  for level in levels])
                one = data["figure_10"][4 * i + k]["repeated_measures"]
                self.assertEqual(one["subjects"], len(table))
                tested += 1
                if len(table[0]) == 2:
                    difference = [row[1] - row[0] for row in table]
                    t = statistics.mean(difference) / statistics.stdev(difference) * math.sqrt(len(table))
                    self.assertAlmostEqual(one["f"] / t**2, 1, 9)
                    self.assertAlmostEqual(one["epsilon"], 1, 9)
                    continue
                columns = list(zip(*table))
                covariance = [[statistics.covariance(a, b) for b in columns] for a in columns]
                whole = statistics.mean(map(statistics.mean, covariance))
                diagonal = statistics.mean(covariance[j][j] for j in range(3))
                squares = sum(value**2 for row in covariance for value in row)
                rows = sum(statistics.mean(row) ** 2 for row in covariance)
                epsilon = 9 * (diagonal - whole) ** 2 / (2 * (squares - 6 * rows + 9 * whole**2))
                self.assertAlmostEqual(one["epsilon"], epsilon, 9)
                means = [statistics.mean(column) for column in columns]
                between = len(table) * statistics.variance(means)
                self.assertAlmostEqual(one["f"] * (diagonal - (3 * whole - diagonal) / 2) / between, 1, 9)
        self.assertEqual(tested, 9)

    def test_labels_work_as_they_were_put_in(self):
        # C differs between the tasks by a factor of two or more in every row of the tables, a second arm is a factor of
        # 1.3, and the positions of table I have 22.7, 45.9 and 17.0 Nm/rad.
        of = {(one["label"], one["quantity"]): one["repeated_measures"] for one in data["figure_10"]}
        for label in ("task", "number of hands", "hand position"):
            self.assertTrue(of[label, "C"]["significant"], label)

    def test_what_was_put_in_stands_beside_what_was_found(self):
        rows = {one["what"]: one for one in data["put_in"]}
        self.assertEqual(rows["J, passive over active"]["put_in"]["nominal"], 1)
        ratios = [
            p["true"]["stiffness_nm_per_rad"] / a["true"]["stiffness_nm_per_rad"]
            for p in records(True, task="passive")
            for a in records(True, task="active", subject=p["subject"], hands=p["hands"])
        ]
        self.assertAlmostEqual(rows["C, passive over active"]["put_in"]["nominal"], statistics.median(ratios), 9)
        for one in rows.values():  # with a probe an answer is within 2 % (below), a ratio of two within 4
            self.assertAlmostEqual(one["batch_with_probe"]["nominal"] / one["put_in"]["nominal"], 1, delta=0.04)

    def test_the_fit_falls_with_what_no_model_explains(self):
        for over, points in data["amplitude_fit_over"].items():
            self.assertEqual(points, sorted(points, key=lambda point: point[over]))
            self.assertLess(points[-1]["pooled_percent"], points[0]["pooled_percent"] - 1)
            for point in points:
                self.assertLess(point["true_arm_median_percent"], 100)

    def test_the_conclusions_say_what_the_numbers_say(self):
        said = " ".join(data["conclusions"])
        self.assertIn(f"{data['amplitude_fit_percent']:.1f} %", said)
        plain = [one for one in data["errors"] if one["method"] == "batch_gauss_newton" and one["probe_rms_nm"] == 0]
        worst = max(one["relative_rms_error"]["inertia_kgm2"] for one in plain)
        self.assertEqual(worst > 0.1, "J is off by" in data["conclusions"][1])

    def test_convergence_factors_are_those_of_equation_27(self):
        compared = 0
        for one in data["convergence"]["cases"]:
            if one["predicted_factor"] < 1e-4:
                continue  # quadratic
            self.assertAlmostEqual(one["measured_factor"] / one["predicted_factor"], 1, delta=0.05)
            compared += 1
        self.assertGreaterEqual(compared, 4)
        self.assertEqual({rank["rank"] for rank in data["convergence"]["rank"]} & {0, 2, 3}, {0, 2, 3})

    def test_the_drivers_state_is_told_right(self):
        probed = data["driver_state"][0]
        # 0.751 measured: after every change of the arm the search and two seconds more pass before C is called valid.
        self.assertGreater(probed["told_share"], 0.75)
        self.assertLess(probed["told_share"], 0.9)
        # 0.010 measured; the arms that lie in the other state's range (overlapping_arms_seconds) are 0.012 of the time,
        # and the rest is delay in noticing a change.
        self.assertLess(probed["wrong_share_of_told_settled"], 0.08)
        self.assertAlmostEqual(sum(map(sum, probed["seconds"])), 5100, 6)
        changes = [one["after_s"] for one in probed["detections"] if one["from"] != "unknown"]
        self.assertGreater(sum(after is not None for after in changes), 0.85 * len(changes))


if __name__ == "__main__":
    with open(sys.argv.pop(1), encoding="utf-8") as file:
        data.update(json.load(file))
    unittest.main(verbosity=2)
