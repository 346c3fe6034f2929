#!/usr/bin/env bash
# Runs a sweep as a job array on a Slurm of one node, set up in a temporary folder, and compares it with the same sweep
# run at once. Exit status 77, which ctest takes as skipped, where Slurm or the rights to start it are missing.
#
#   tests/slurm/job_array_test.sh PROGRAM
set -euo pipefail

program=$(realpath "$1")
root=$(realpath "${BASH_SOURCE[0]%/*}/../..")

skip() { printf 'skipped: %s\n' "$*"; exit 77; }
PATH=$PATH:/usr/sbin
for tool in munged mungekey slurmctld slurmd sbatch squeue scontrol; do
  command -v "$tool" >/dev/null || skip "no $tool here (Debian: slurm-wlm, munge)"
done
[[ $(id --user) == 0 ]] || skip 'only root can start slurmd'

work=$(mktemp --directory)
# munge wants every folder above its socket closed to others' writing; the temporary folder is open but sticky.
chmod 755 "$work"
started=()
clean_up() {
  local id
  for id in "${started[@]}"; do kill "$id" 2>/dev/null || true; done
  for id in "${started[@]}"; do wait "$id" 2>/dev/null || true; done
  rm --recursive --force "$work"
}
trap clean_up EXIT

host=$(hostname --short)
port=$((20000 + RANDOM % 20000))
export SLURM_CONF=$work/slurm.conf

mkdir "$work"/{munge,state,spool,log}
mungekey --create --keyfile="$work/munge/key"
munged --foreground --force --num-threads=2 --key-file="$work/munge/key" --socket="$work/munge/socket" \
  --pid-file="$work/munge/pid" --log-file="$work/log/munged" --seed-file="$work/munge/seed" &
started+=($!)

cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/log/slurmctld
SlurmdLogFile=$work/log/slurmd
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
MpiDefault=none
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF

start() { # NAME COMMAND...
  "${@:2}" >"$work/log/$1.out" 2>&1 &
  started+=($!)
}
# Tries COMMAND until it succeeds, for up to SECONDS.
await() { # SECONDS COMMAND...
  local end=$((SECONDS + $1))
  until "${@:2}" >/dev/null 2>&1; do
    ((SECONDS < end)) || return 1
    sleep 0.2
  done
}

await 20 test -S "$work/munge/socket" || skip "munged does not start: $(tail -n 1 "$work/log/munged")"
start slurmctld slurmctld -D
start slurmd slurmd -D -N "$host"
is_idle() { [[ $(sinfo --noheader --format=%t) == idle ]]; }
await 60 is_idle || {
  tail -n 5 "$work"/log/slurmctld "$work"/log/slurmd
  skip 'slurmd does not come up here'
}

sweep=$root/cases/sweeps/sphere_radius.toml
cd "$work"
"$program" sweep "$sweep" -o "$work/at_once" -j 1

submit() { # ARGUMENTS...
  ISORIM=$program sbatch --parsable --output="$work/log/task-%a.out" "$@"
}
no_jobs() { [[ -z $(squeue --noheader) ]]; }

# Two of three shards first: the third is missing, and said to be.
job=$(ISORIM_SHARDS=3 submit --array=1,3 "$root/cases/sweeps/job_array.slurm" "$sweep" "$work/array")
await 120 no_jobs || { squeue; scontrol show job "$job"; exit 1; }
cat "$work"/log/task-*.out
status=0
"$program" sweep "$sweep" -o "$work/array" --merge 2>"$work/merge.err" || status=$?
cat "$work/merge.err"
[[ $status == 2 ]] || { echo "merge of an incomplete array: status $status, expected 2"; exit 1; }
grep --quiet '3 cases of 9 are missing: 2, 5, 8' "$work/merge.err"

# Then the whole array: what is there is not computed again.
before=$(stat --format=%Y.%i "$work/array/shard_1_of_3/cases/1/results.json")
submit --array=1-3 "$root/cases/sweeps/job_array.slurm" "$sweep" "$work/array" >/dev/null
await 120 no_jobs || { squeue; exit 1; }
"$program" sweep "$sweep" -o "$work/array" --merge
[[ $(stat --format=%Y.%i "$work/array/shard_1_of_3/cases/1/results.json") == "$before" ]]
cmp "$work/at_once/sweep.csv" "$work/array/sweep.csv"
echo 'the job array gives what the sweep gives at once'
