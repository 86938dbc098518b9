# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""A running guest: its console as lines, the input lines of its GPIO chip to set, the output lines to watch.

QEMU's test socket (qtest) sets the chip's input pins and reports its output pins; the chip is found by its type through
the monitor socket (QMP).
"""

import json
import pathlib
import queue
import socket
import subprocess
import threading
import time

GPIO_CHIP = "pl061"


class QemuGuest:
    def __init__(self, kernel, initramfs, folder):
        folder = pathlib.Path(folder)
        self._qtest_path, self._qmp_path = folder / "qtest.sock", folder / "qmp.sock"
        for stale in (self._qtest_path, self._qmp_path):
            stale.unlink(missing_ok=True)
        self.console = []
        self.outputs = {}  # line: level
        self.counts = {}  # line: how often it changed
        self._arrived = queue.Queue()
        self._answers = queue.Queue()
        self._process = subprocess.Popen(
            ["qemu-system-aarch64", "-M", "virt", "-cpu", "cortex-a53", "-m", "256", "-nic", "none", "-display", "none",
             "-monitor", "none", "-serial", "stdio", "-accel", "tcg", "-no-reboot", "-kernel", kernel, "-initrd",
             initramfs, "-append", "console=ttyAMA0 quiet panic=-1 rdinit=/init",
             "-qtest", f"unix:{self._qtest_path},server=on,wait=off", "-qtest-log", "none",
             "-qmp", f"unix:{self._qmp_path},server=on,wait=off"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        threading.Thread(target=self._read_console, daemon=True).start()
        self._chip = self._find_chip()
        self._qtest = self._connect(self._qtest_path)
        threading.Thread(target=self._read_qtest, daemon=True).start()
        self._command(f"irq_intercept_out {self._chip}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()

    def set_line(self, line, level):
        self._command(f"set_irq_in {self._chip} unnamed-gpio-in {line} {int(level)}")

    def pulse(self, line):
        self.set_line(line, 1)
        self.set_line(line, 0)

    def next_line(self, timeout_s):
        """The next line of the console, or None."""
        try:
            return self._arrived.get(timeout=timeout_s)
        except queue.Empty:
            return None

    def ended(self):
        return self._process.poll() is not None

    def _read_console(self):
        for raw in self._process.stdout:
            line = raw.decode(errors="replace").rstrip()
            self.console.append(line)
            self._arrived.put(line)

    def _read_qtest(self):
        for line in self._qtest.makefile("r"):
            words = line.split()
            if words[0] == "IRQ":
                line = int(words[2])
                self.outputs[line] = int(words[1] == "raise")
                self.counts[line] = self.counts.get(line, 0) + 1
            else:
                self._answers.put(line.strip())

    def _command(self, text):
        self._qtest.sendall(text.encode() + b"\n")
        answer = self._answers.get(timeout=10)
        if not answer.startswith("OK"):
            raise RuntimeError(f"qtest: {text}: {answer}")

    def _connect(self, path):
        for _ in range(200):
            try:
                connection = socket.socket(socket.AF_UNIX)
                connection.connect(str(path))
                return connection
            except OSError:
                time.sleep(0.02)
        raise RuntimeError(f"QEMU did not open {path}: {self.console}")

    def _find_chip(self):
        monitor = self._connect(self._qmp_path)
        lines = monitor.makefile("rw")

        def ask(command, **arguments):
            lines.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
            lines.flush()
            while True:
                answer = json.loads(lines.readline())
                if "return" in answer:
                    return answer["return"]

        lines.readline()  # the greeting
        ask("qmp_capabilities")
        parent = "/machine/unattached"
        for entry in ask("qom-list", path=parent):
            if entry["type"] == f"child<{GPIO_CHIP}>":
                return f"{parent}/{entry['name']}"
        raise RuntimeError(f"the guest has no {GPIO_CHIP}")
