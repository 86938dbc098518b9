#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Answers one shard; ends with 0 when its table is there, else as steerid did. Records that are not usable are in the
# table and no failure of the shard.
#
#   shard.sh K N OUT THREADS COMMAND...    a command of steerid, without --shard and --threads
#
# Only one process at a time works at a shard, wherever it runs: a scheduler that has lost sight of a machine starts
# the shard again while that machine may still be at it. The second waits for the lock and keeps what the first has
# answered. OUT has to be on a file system whose locks hold on all machines (NFS 4, Lustre with -o flock, GPFS).
set -uo pipefail
number=$1 of=$2 out=$3 threads=$4
shift 4
shard=$out/fleet/shard_${number}_of_${of}

exec 9>"$shard.lock" || exit 1
flock 9 || exit 1
rm -f -- "$shard.jsonl" "$shard.csv"  # of an earlier run: it would pass for this one's
"$STEERID" "$@" --shard "$number/$of" --threads "$threads" 9>&-
code=$?
[ -f "$shard.jsonl" ] && [ $code -le 3 ] && exit 0
printf 'shard %s of %s ended without a table, by exit code %s\n' "$number" "$of" "$code" >&2
[ $code != 0 ] || code=1
exit $code
