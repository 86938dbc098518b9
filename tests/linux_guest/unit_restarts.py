# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""The systemd unit starts a daemon that ends at once again and again, for ever, but not one whose command line is wrong.

    unit_restarts.py UNIT

By systemd.unit(5): after StartLimitBurst starts within StartLimitIntervalSec (5 within 10 s when neither is given) a unit
stays down for good; an interval of 0 switches that off.
"""

import configparser
import sys


def seconds(text):
    """"10", "10s" or "500ms"."""
    for ending, factor in (("ms", 1e-3), ("min", 60), ("s", 1), ("", 1)):
        if text.endswith(ending) and text.removesuffix(ending).strip().isdigit():
            return float(text.removesuffix(ending)) * factor
    raise ValueError(f"not understood: {text}")


def main(path):
    parser = configparser.ConfigParser(strict=False, interpolation=None)
    parser.optionxform = str
    parser.read(path, encoding="utf-8")
    unit, service = parser["Unit"], parser["Service"]
    interval_s = seconds(unit.get("StartLimitIntervalSec", "10"))
    burst = int(unit.get("StartLimitBurst", "5"))
    pause_s = seconds(service.get("RestartSec", "100ms"))
    print(f"restarts: {service.get('Restart')}, {pause_s} s apart; limit {burst} within {interval_s} s")
    assert service.get("Restart") in ("on-failure", "always")
    assert pause_s >= 0.5, "a daemon that ends at once would take the processor"
    assert interval_s == 0 or burst * pause_s > interval_s, "systemd gives up for good"
    assert "2" in service.get("RestartPreventExitStatus", "").split(), "bad usage would be tried for ever"


main(sys.argv[1])
