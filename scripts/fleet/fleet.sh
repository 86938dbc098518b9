#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Many records on many processors: answers a folder of records in shards and merges them, on a Slurm cluster or by GNU
# parallel. docs/fleet.md tells how to use it.
#
#   fleet.sh slurm    --shards N [--attempts A] [--with OPTION]... -- diagnose --batch DIR --out OUT [options]
#   fleet.sh parallel --shards N [--attempts A] [--with OPTION]... -- identify --folder DIR --out OUT [options]
#
#   --shards N     parts that the records are divided into; each is one task
#   --attempts A   times that a shard which fails is begun in all; 3 without it
#   --with OPTION  passed on to sbatch or to parallel, such as --with=--time=2:00:00 or --with=--jobs=8
#
# After -- stands a command of steerid without --shard and --threads. OUT must lie where every machine sees it.
# `slurm` prints the numbers of two jobs, the array of shards and the merge after it, and returns. `parallel` returns
# when all is merged. What each shard said is in OUT/fleet/log. A run that failed is run again by the same command:
# answers that are there are kept.
#
# STEERID names the program; without it: the one of this project's build/, else the one in PATH.
# Exit codes: those of `steerid merge`, and 2 for bad usage.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

refuse() {
  printf 'fleet.sh: %s\n' "$1" >&2
  exit 2
}

whole() { [[ $2 =~ ^[1-9][0-9]{0,5}$ ]] || refuse "$1: expected a whole number from 1, found \"$2\""; }

engine=${1-}
[[ $engine = slurm || $engine = parallel ]] || refuse "expected slurm or parallel, found \"$engine\""
shift
shards="" attempts=3 with=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  option=$1
  if [[ $option = --*=* ]]; then
    value=${option#*=} option=${option%%=*}
    shift
  else
    [ $# -gt 1 ] || refuse "$option: expected a value"
    value=$2
    shift 2
  fi
  case $option in
    --shards) whole --shards "$value" && shards=$value ;;
    --attempts) whole --attempts "$value" && attempts=$value ;;
    --with) with+=("$value") ;;
    *) refuse "$option: expected --shards, --attempts, --with or --" ;;
  esac
done
[ -n "$shards" ] || refuse "expected --shards N"
[ $# -gt 1 ] || refuse "expected a command of steerid after --"
shift
command=("$@")

out=
for ((i = 0; i < ${#command[@]}; ++i)); do
  case ${command[i]} in
    --out) out=${command[i + 1]-} ;;
    --out=*) out=${command[i]#--out=} ;;
    --shard | --shard=* | --threads | --threads=*) refuse "${command[i]}: it is set for each shard; leave it away" ;;
  esac
done
[ -n "$out" ] || refuse "expected --out OUT in the command of steerid"

if [ -z "${STEERID-}" ]; then
  STEERID=$here/../../build/steerid
  [ -x "$STEERID" ] || STEERID=$(type -P steerid) || refuse "found no steerid; name it by STEERID=PATH"
fi
STEERID=$(realpath -- "$STEERID")
export STEERID
mkdir -p -- "$out/fleet/log"
out=$(realpath -- "$out")

if [ "$engine" = slurm ]; then
  "$here/slurm.sh" submit "$here" "1-$shards" 1 "$attempts" "$shards" "$out" ${#with[@]} "${with[@]}" "${command[@]}"
  printf 'logs in %s\n' "$out/fleet/log"
else
  type -P parallel >/dev/null || refuse "found no GNU parallel; install it (Debian: apt-get install parallel)"
  seq "$shards" | parallel --will-cite --quote --retries "$attempts" "${with[@]}" \
    "$here/shard.sh" {} "$shards" "$out" 1 "${command[@]}" >>"$out/fleet/log/parallel.log" 2>&1 ||
    true # the merge names what is missing
  exec "$here/merge.sh" "$shards" "$out"
fi
