#!/bin/sh
# The Slurm job array of docs/commands.md on a real Slurm: one node on the loopback
# interface, in a temporary directory, with its daemons started here. The parts it
# computes must merge to the bytes of a single run.
#
#   tests/slurm.sh [path of rubscope, by default target/release or target/debug]
#
# Skips with a line and exit status 0 where Slurm or munge are not installed
# and cannot be, or where their daemons do not start; 1 when the maps differ.
set -u
here=$(cd "$(dirname "$0")/.." && pwd)
skip() { echo "skipped: $*"; exit 0; }
fail() { echo "failed: $*" >&2; exit 1; }

program=${1:-$here/target/release/rubscope}
[ -x "$program" ] || program=$here/target/debug/rubscope
[ -x "$program" ] || fail "no rubscope at $program: run cargo build first"
case $program in /*) ;; *) program=$PWD/$program ;; esac

PATH=$PATH:/usr/sbin:/sbin
missing() { ! command -v slurmctld || ! command -v slurmd || ! command -v munged; }
[ "$(id -u)" = 0 ] || skip "the daemons of Slurm must be started by root"
if missing > /dev/null; then
    command -v apt-get > /dev/null || skip "slurm-wlm and munge are not installed, and there is no apt-get"
    DEBIAN_FRONTEND=noninteractive apt-get install -y slurm-wlm munge > /dev/null 2>&1
    missing > /dev/null && skip "slurm-wlm and munge cannot be installed here"
fi

work=$(mktemp -d) || fail "no temporary directory"
chmod 755 "$work"
munged_pid='' controller='' node=''
cleanup() {
    for process in $node $controller $munged_pid; do
        kill "$process" 2> /dev/null && wait "$process" 2> /dev/null
    done
    rm -rf "$work"
}
trap cleanup EXIT
trap 'exit 1' INT TERM HUP

# Waits up to ten seconds for a command to succeed.
await() {
    for _ in $(seq 100); do
        "$@" > /dev/null 2>&1 && return 0
        sleep 0.1
    done
    return 1
}

mkdir -m 755 "$work/munge" "$work/state" "$work/spool" "$work/job"
head -c 1024 /dev/urandom > "$work/munge/key"
chmod 600 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" \
    --pid-file="$work/munge/pid" --seed-file="$work/munge/seed" --log-file="$work/munge/log" \
    > "$work/munge/out" 2>&1 &
munged_pid=$!
await munge --no-input --socket="$work/munge/socket" || skip "munged does not start: $(tail -1 "$work/munge/out")"

host=$(hostname -s)
cat > "$work/slurm.conf" << CONF
ClusterName=rubscope
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=500 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=10 State=UP
CONF
export SLURM_CONF="$work/slurm.conf"
slurmctld -D > "$work/slurmctld.log" 2>&1 &
controller=$!
slurmd -D > "$work/slurmd.log" 2>&1 &
node=$!
is_idle() { [ "$(sinfo --noheader --format=%t)" = idle ]; }
await is_idle || skip "Slurm does not start: $(grep -h -E 'error|fatal' "$work/slurmctld.log" "$work/slurmd.log" | head -1)"

# The job of the document, unchanged, and its options without the share.
cd "$work/job" || fail "no directory for the job"
awk '/^```sh$/ { text = ""; inside = 1; next }
     /^```$/   { if (inside && text ~ /^#!\/bin\/sh\n#SBATCH/) { printf "%s", text; exit } inside = 0 }
     inside    { text = text $0 "\n" }' "$here/docs/commands.md" > map.sbatch
[ -s map.sbatch ] || fail "docs/commands.md has no job array"
options=$(tr -d '\\\n' < map.sbatch | sed 's/.*rubscope map \(.*\) --threads.*/\1/')
mkdir bin
ln -s "$program" bin/rubscope
PATH=$work/job/bin:$PATH
sbatch --wait map.sbatch || { cat slurm-*.out; fail "the job array"; }
ls map-*.csv > /dev/null 2>&1 || { cat slurm-*.out; fail "the job array left no parts"; }
rubscope map merge map-*.csv --out merged.csv || fail "merge"
# shellcheck disable=SC2086
rubscope map $options --out single.csv || fail "single run: $options"
cmp merged.csv single.csv || fail "the merged map is not that of one run"
echo "passed: $(ls map-*.csv | wc -l) tasks of $(slurmctld -V) gave the map of one run, $(wc -l < single.csv) lines"
