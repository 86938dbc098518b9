#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Merges the shards in OUT/fleet into OUT. Their tables and locks go once all is merged.
#
#   merge.sh N OUT
set -euo pipefail
of=$1 out=$2
tables=()
for ((k = 1; k <= of; ++k)); do
  table=$out/fleet/shard_${k}_of_$of.jsonl
  if [ -f "$table" ]; then tables+=("$table"); fi
done
if [ ${#tables[@]} = 0 ]; then
  printf 'no shard of %s has ended; %s says why\n' "$of" "$out/fleet/log" >&2
  exit 1
fi
"$STEERID" merge "${tables[@]}" --out "$out"
for ((k = 1; k <= of; ++k)); do rm -f -- "$out/fleet/shard_${k}_of_$of".{jsonl,csv,lock}; done
