#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Shards as a job array on Slurm, and after it a job that merges them or begins the failed ones again.
#
#   slurm.sh submit|task|merge SCRIPTS SHARDS ATTEMPT ATTEMPTS N OUT COUNT OPTION... COMMAND...
#
# `submit` submits both; the others are what the jobs run, from a copy in Slurm's spool folder, so that SCRIPTS names the
# folder of the scripts. SHARDS is the array, such as 1-200 or 3,17; COUNT OPTIONs go to sbatch; COMMAND is steerid's.
#
# A task that is lost with its machine is put back into the queue by Slurm. One that fails or is killed is begun again
# by the job that would merge, as only that job sees every way to fail: a killed task cannot ask for another attempt.
set -euo pipefail
role=$1 scripts=$2 shards=$3 attempt=$4 attempts=$5 of=$6 out=$7
shift 7
count=$1
with=("${@:2:count}")

submit() { # SHARDS ATTEMPT COUNT OPTION... COMMAND...
  local job=("$scripts" "$1" "$2" "$attempts" "$of" "$out" "${@:3}") log=${out//%/%%}/fleet/log array merge
  array=$(sbatch --parsable --job-name=steerid-shards --array="$1" --requeue --open-mode=append \
    --output="$log/shard_%a.log" "${with[@]}" "$scripts/slurm.sh" task "${job[@]}")
  array=${array%%;*} # of "number;cluster"
  merge=$(sbatch --parsable --job-name=steerid-merge --dependency="afterany:$array" --open-mode=append \
    --output="$log/merge.log" "${with[@]}" "$scripts/slurm.sh" merge "${job[@]}")
  printf 'attempt %s at shards %s: job %s, merge: job %s\n' "$2" "$1" "$array" "${merge%%;*}"
}

case $role in
  submit) submit "$shards" "$attempt" "$@" ;;
  task)
    printf 'shard %s of %s on %s, attempt %s, restart %s\n' \
      "$SLURM_ARRAY_TASK_ID" "$of" "${SLURMD_NODENAME-}" "$attempt" "${SLURM_RESTART_COUNT:-0}"
    exec "$scripts/shard.sh" "$SLURM_ARRAY_TASK_ID" "$of" "$out" "${SLURM_CPUS_PER_TASK:-1}" "${@:2+count}"
    ;;
  merge)
    missing=
    for ((k = 1; k <= of; ++k)); do
      [ -f "$out/fleet/shard_${k}_of_$of.jsonl" ] || missing+=,$k
    done
    if [ -n "$missing" ] && [ "$attempt" -lt "$attempts" ]; then
      submit "${missing#,}" $((attempt + 1)) "$@"
    else
      exec "$scripts/merge.sh" "$of" "$out"
    fi
    ;;
esac
