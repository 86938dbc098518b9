#!/bin/busybox sh
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# What the guest does, step by step. "STEP name" tells the test outside to act; "CHECK name: ..." are results.
for folder in proc sys dev run tmp; do /bin/busybox mkdir -p /$folder; done
/bin/busybox --install -s /bin
export PATH=/bin
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t devtmpfs dev /dev; mount -t tmpfs tmp /tmp
echo 0 > /proc/sys/kernel/printk
for module in can can-raw can-dev vcan; do insmod /modules/$module.ko || echo "CHECK module $module: missing"; done
ip link add dev vcan0 type vcan && ip link set vcan0 up

# result NAME COMMAND...: runs it, prints its output and exit code.
result() {
  name=$1; shift
  "$@" > /tmp/output 2>&1
  code=$?
  while read -r line; do echo "CHECK $name: $line"; done < /tmp/output
  echo "CHECK $name: exit $code"
}
# await NAME PATTERN FILE: until the pattern stands in the file, 10 s at most.
await() {
  tries=0
  until grep -q "$2" "$3"; do
    tries=$((tries + 1)); [ $tries -gt 100 ] && { echo "CHECK $1: no '$2'"; return; }
    usleep 100000
  done
  echo "CHECK $1: seen '$2'"
}
start() { steerid-ecu --config "$1" 2> "$2" & daemon=$!; await "$3" "running on" "$2"; }
guard() { grep -l steerid-guard /proc/[0-9]*/comm | cut -d/ -f3; }
finish() { kill -TERM $daemon; wait $daemon; echo "CHECK $1: exit $?"; }

cd /configs
for bad in no_chip no_line no_name no_can bad_key bad_bias; do result $bad steerid-ecu --config $bad.json --dry-run; done
peer hold gpiochip0 4 1500 > /tmp/hold & usleep 300000
result busy steerid-ecu --config good.json --dry-run
wait
result denied peer as 65534 steerid-ecu --config other_state.json --dry-run
result good steerid-ecu --config good.json --dry-run
result usage steerid-ecu --no-such-option

# The drive: every estimate is compared; the allocator's calls before and after.
rm -f /tmp/state
start good.json /tmp/drive.log drive
kill -USR1 $daemon
kill -HUP $daemon
echo "STEP edges follow"
peer drive vcan0 /drive.txt gpiochip0 2
kill -USR1 $daemon; usleep 200000
finish drive
while read -r line; do echo "LOG drive: $line"; done < /tmp/drive.log

# Told to stop, the estimate was kept: the next start has it.
start good.json /tmp/restart.log restart
echo "STEP edges on"
peer samples vcan0 1000
# Down and up again.
ip link set vcan0 down; await can_down "takes no frames" /tmp/restart.log
echo "STEP levels can_down"; usleep 400000
ip link set vcan0 up; peer samples vcan0 1000; await can_up "takes frames again" /tmp/restart.log
# More edges than the kernel's queue holds while the daemon stands still; its guard, which would kill it, stands still too.
watching=$(guard); kill -STOP $watching; kill -STOP $daemon
echo "STEP burst"; usleep 400000
kill -CONT $daemon; usleep 300000; kill -CONT $watching
finish restart
while read -r line; do echo "LOG restart: $line"; done < /tmp/restart.log

# Killed: the guard makes the outputs safe.
start good.json /tmp/killed.log killed
echo "STEP edges follow"
peer drive vcan0 /drive.txt gpiochip0 2 > /tmp/peer & peer=$!
await killed "all parameters valid" /tmp/killed.log
echo "STEP levels before_kill"; usleep 400000
kill -KILL $daemon; wait $daemon
await killed "safe levels" /tmp/killed.log
echo "STEP levels after_kill"; usleep 400000
wait $peer
# Hung: the guard kills it first.
echo "STEP edges on"
start good.json /tmp/hung.log hung
usleep 500000; kill -STOP $daemon
await hung "safe levels" /tmp/hung.log
echo "STEP levels after_hang"; usleep 400000
# Without its guard it stops by itself.
start good.json /tmp/alone.log alone
usleep 500000; kill -KILL $(guard)
wait $daemon; echo "CHECK alone: exit $?"
while read -r line; do echo "LOG alone: $line"; done < /tmp/alone.log
echo "STEP levels after_guard_died"; usleep 1000000
# With a guard that stands still it stops as well, and ends the guard.
start good.json /tmp/unguarded.log unguarded
usleep 500000; kill -STOP $(guard)
wait $daemon; echo "CHECK unguarded: exit $?"
echo "CHECK unguarded: guards left: $(guard)"
while read -r line; do echo "LOG unguarded: $line"; done < /tmp/unguarded.log
echo "STEP levels after_guard_stopped"; usleep 1000000
result make_safe steerid-ecu --config good.json --make-safe
peer hold gpiochip0 6 1500 > /tmp/hold & usleep 300000
result make_safe_busy steerid-ecu --config good.json --make-safe
wait

# Not wired: the timer ticks.
echo "STEP edges off"
start timer.json /tmp/timer.log timer
peer samples vcan0 1000
finish timer
while read -r line; do echo "LOG timer: $line"; done < /tmp/timer.log

# The chip goes while the daemon runs.
echo "STEP edges on"
start good.json /tmp/unplugged.log unplugged
usleep 500000
echo "STEP edges off"; usleep 300000
# Taking it away holds the daemon up in the kernel, on a slow host for longer than its guard waits.
watching=$(guard); kill -STOP $watching
echo 9030000.pl061 > /sys/bus/amba/drivers/pl061_gpio/unbind
await unplugged "no longer answers" /tmp/unplugged.log
kill -CONT $watching; usleep 100000
finish unplugged
while read -r line; do echo "LOG unplugged: $line"; done < /tmp/unplugged.log
echo "STEP end"
poweroff -f
