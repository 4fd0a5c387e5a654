#!/usr/bin/env bash
# Starts a Slurm in a folder of its own. A job of ranks loses a node, is requeued, and ends with the
# record of one thread. It needs root, slurmctld, slurmd, slurm-client and munge.
#   bash tests/slurm.sh [SUITE]
set -euo pipefail
cd "$(dirname "$0")/.."
suite=$PWD/${1:-suites/brdf.yaml}
assay=$PWD/build/harness/assay
for program in munged slurmctld slurmd sbatch "$assay-mpi"; do
  command -v "$program" >/dev/null || { echo "skipped: $program is missing"; exit 77; }
done

work=$(mktemp -d)
processes=()
stop() {
  # shellcheck disable=SC2046  # one word a process
  kill -KILL $(processes_of n1) $(processes_of n2) 2>/dev/null || true
  kill "${processes[@]}" 2>/dev/null || true
  wait
  rm -rf "$work"
}
trap stop EXIT
mkdir "$work"/{state,tmp.n1,tmp.n2,one,ranks}
host=$(hostname -s)
cat >"$work/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
StateSaveLocation=$work/state
SlurmctldPidFile=$work/slurmctld.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdSpoolDir=$work/spool.%n
SlurmdPidFile=$work/slurmd.%n.pid
SlurmdLogFile=$work/slurmd.%n.log
SlurmdParameters=config_overrides
SlurmdTimeout=10
ReturnToService=2
KillWait=2
TmpFS=$work/tmp.%n
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=17001 CPUs=2
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=17002 CPUs=2
PartitionName=all Nodes=ALL Default=YES State=UP
END
export SLURM_CONF=$work/slurm.conf
# Two nodes of one machine share no memory segments.
export OMPI_MCA_btl=self,tcp OMPI_MCA_btl_tcp_if_include=lo

head -c 1024 /dev/urandom >"$work/munge.key"
chmod 400 "$work/munge.key"
munged --force --foreground --key-file "$work/munge.key" --socket "$work/munge.socket" \
  --pid-file "$work/munge.pid" --log-file "$work/munge.log" --seed-file "$work/munge.seed" &
processes+=($!)
slurmctld -D &
processes+=($!)
start_node() {
  slurmd -D -N "$1" &
  node=$!
  processes+=("$node")
}
start_node n1
start_node n2

# Tasks of a node, and the steps that started them: they are no children of its slurmd.
processes_of() {
  local folder
  for folder in /proc/[0-9]*; do
    grep -qzxF "SLURM_CONF=$SLURM_CONF" "$folder/environ" 2>/dev/null || continue
    grep -qzx "SLURMD_NODENAME=$1" "$folder/environ" 2>/dev/null || continue
    basename "$folder"
    grep -h '^PPid' "$folder/status" | cut -f2 | while read -r parent; do
      [ "$(cat "/proc/$parent/comm")" != slurmstepd ] || echo "$parent"
    done
  done | sort -u
}
state_of_job() { squeue -h -o %T -j "$job" 2>/dev/null || true; }
# await SECONDS COMMAND…: until it succeeds.
await() {
  local i
  for ((i = 0; i < 10 * $1; ++i)); do
    if "${@:2}"; then return; fi
    sleep .1
  done
  echo "FAILED: waited $1 s for ${*:2}"
  tail -n 5 "$work"/*.log "$work/out" || true
  exit 1
}
has_nodes() { [ "$(sinfo -h -N -o %T)" = $'idle\nidle' ]; }
runs() { [ "$(state_of_job)" = RUNNING ]; }
is_over() { [ -z "$(state_of_job)" ]; }
waits() { [ "$(state_of_job)" = PENDING ]; }
lost() { [ "$(state_of_job)" != RUNNING ]; }

"$assay" run "$suite" --quiet --threads 1 --report json="$work/one/run.json" \
  --report console=/dev/null || [ $? -le 3 ]
await 60 has_nodes
job=$(sbatch --parsable --requeue -N 2 -n 4 -o "$work/out" --wrap "srun --mpi=pmix $assay run $suite \
  --quiet --checkpoint $work/kept --checkpoint-every .1 --report json=$work/ranks/run.json")
await 60 runs
await 60 test -s "$work/kept.kept"
# shellcheck disable=SC2046  # one word a process
kill -KILL "$node" $(processes_of n2)
[ -s "$work/kept" ] || { echo 'FAILED: the run was over before its node was lost'; exit 1; }
await 60 lost
rm -rf "$work"/spool.n2 "$work"/tmp.n2/*  # as a node that starts anew
start_node n2
await 60 waits
await 60 has_nodes
# Slurm would start it two minutes later.
scontrol update JobId="$job" StartTime=now
await 300 is_over
diff <(jq -S 'del(.. | .seconds?, .started?, .threads?)' "$work/one/run.json") \
  <(jq -S 'del(.. | .seconds?, .started?, .threads?)' "$work/ranks/run.json") ||
  { echo 'FAILED: another record'; tail -n 20 "$work/out"; exit 1; }
[[ $(scontrol show job "$job" -o) =~ Restarts=([0-9]+) && ${BASH_REMATCH[1]} -gt 0 ]] ||
  { echo 'FAILED: the job was over before its node was lost'; exit 1; }
echo "a job that lost a node gave the record of one thread"
