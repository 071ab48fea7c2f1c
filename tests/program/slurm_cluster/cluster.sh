#!/usr/bin/env bash
# A Slurm of its own on the loopback: a controller and two nodes of one processor each, without systemd, and
# with a munge of its own. Runs a command of the shell in FOLDER once both nodes are idle, and takes everything that it
# started along. Needs slurmctld, slurmd, slurm-client and munge (Debian). The exit code is that of the command.
#
#   cluster.sh FOLDER CONTROLLER_PORT NODE_PORT NODE_PORT COMMAND
set -uo pipefail
PATH="$PATH:/usr/sbin:/sbin"
place="$1" folder="$1/cluster" controller="$2" first="$3" second="$4" command="$5"
chmod 0755 "$place" && mkdir -m 0755 "$folder" && cd "$folder" || exit 1
export SLURM_CONF="$folder/slurm.conf"
mkdir -m 0755 spool spool/n1 spool/n2 state munge || exit 1
user="$(id -un)"
host="$(hostname -s)"

stop() {
    code=$?
    trap '' EXIT INT TERM HUP
    scancel --user="$user" >>stop.log 2>&1
    # What still runs is ended with its node; give the nodes a moment to do that themselves.
    for _ in $(seq 50); do
        [ -z "$(squeue --noheader 2>>stop.log)" ] && break
        sleep 0.1
    done
    for file in n1.pid n2.pid slurmctld.pid munge/munged.pid; do
        [ -s "$file" ] && kill "$(cat "$file")" 2>>stop.log
    done
    # A node killed by a test leaves the keepers of its tasks behind: all have this folder on their command line
    # or as their working folder.
    sleep 0.3
    for process in /proc/[0-9]*; do
        at="$(readlink "$process/cwd")" || continue
        case "$at" in
        "$folder" | "$folder"/*) [ "${process#/proc/}" != "$$" ] && [ "${process#/proc/}" != "$BASHPID" ] && kill -9 "${process#/proc/}" ;;
        esac
    done 2>>stop.log
    exit "$code"
}
trap stop EXIT
trap 'exit 1' INT TERM HUP

cat >slurm.conf <<END
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$controller
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=100000
MailProg=/bin/true
MpiDefault=none
SwitchType=switch/none
JobRequeue=1
ReturnToService=2
KillWait=2
SlurmdTimeout=15
SlurmdParameters=config_overrides
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
SlurmdPidFile=$folder/%n.pid
SlurmdLogFile=$folder/%n.log
SlurmctldPidFile=$folder/slurmctld.pid
SlurmctldLogFile=$folder/slurmctld.log
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$first CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$second CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=60
END

head -c 1024 /dev/urandom >munge/key && chmod 0400 munge/key || exit 1
munged --socket="$folder/munge/socket" --key-file="$folder/munge/key" --log-file="$folder/munge/log" \
    --pid-file="$folder/munge/munged.pid" --seed-file="$folder/munge/seed" --num-threads=2 --force \
    >>start.log 2>&1 || { cat start.log; exit 1; }
slurmctld -c -f slurm.conf >>start.log 2>&1 || { cat start.log; exit 1; }
for node in n1 n2; do
    slurmd -f slurm.conf -N "$node" >>start.log 2>&1 || { cat start.log; exit 1; }
done
for _ in $(seq 100); do
    if [ "$(sinfo --noheader --format=%T,%D 2>>start.log)" = idle,2 ]; then
        (cd "$place" && bash -c "$command") && exit 0
        cat slurmctld.log n1.log n2.log
        exit 1
    fi
    sleep 0.1
done
echo "the nodes are not idle"
cat start.log slurmctld.log n1.log n2.log
exit 1
