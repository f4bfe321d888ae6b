#!/usr/bin/env bash
# A Slurm cluster for tests, on one machine: a munged, a slurmctld and two slurmd with configuration, key, ports and state of their
# own in one folder. Read by slurm.sh (`source`); needs Debian's packages slurm-wlm and munge. Nothing system-wide is read or
# changed. It runs as whoever starts it, who need not be root.

PATH=$PATH:/usr/sbin:/sbin
nodes=(node1 node2)

# The first of four free ports in a row.
free_ports() {
  local try port
  for try in {1..50}; do
    local first=$((20000 + (RANDOM % 2500) * 4)) taken=no
    for port in $first $((first + 1)) $((first + 2)); do
      if (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then taken=yes; fi
    done
    if [ $taken = no ]; then
      echo "$first"
      return
    fi
  done
  echo "error: found no free ports between 20000 and 30000 after $try tries" >&2
  return 1
}

# start_cluster FOLDER: starts everything, and returns when both nodes are idle. Sets SLURM_CONF.
start_cluster() {
  cluster=$1
  local ports host node
  ports=$(free_ports)
  host=$(uname -n)
  host=${host%%.*}
  mkdir -p "$cluster"/{key,socket,controller,log}
  # munged wants a key that only its user reads, and a socket that everybody reaches.
  chmod 711 "$cluster" "$cluster/socket"
  chmod 700 "$cluster/key"
  (umask 077 && dd if=/dev/urandom of="$cluster/key/munge.key" bs=128 count=1 status=none)
  munged --foreground --key-file="$cluster/key/munge.key" --seed-file="$cluster/key/seed" --socket="$cluster/socket/munge" \
    --pid-file="$cluster/socket/pid" --log-file="$cluster/log/munged" &>"$cluster/log/munged.out" &
  daemons=($!)

  cat >"$cluster/slurm.conf" <<CONF
ClusterName=luthier
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$ports
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
# A job that is requeued waits as long as its credential is valid.
AuthInfo=socket=$cluster/socket/munge,cred_expire=20
StateSaveLocation=$cluster/controller
SlurmdSpoolDir=$cluster/%n
SlurmctldPidFile=$cluster/controller.pid
SlurmdPidFile=$cluster/%n.pid
SlurmctldLogFile=$cluster/log/controller
SlurmdLogFile=$cluster/log/%n
# No control groups: they would need root, and a machine has one tree of them.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$cluster/completed
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
MpiDefault=none
MailProg=/bin/true
# A node that has been silent for this many seconds is down, and its jobs start elsewhere.
SlurmdTimeout=10
KillWait=5
MinJobAge=36000
ReturnToService=2
NodeName=node1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((ports + 1)) CPUs=1 State=UNKNOWN
NodeName=node2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((ports + 2)) CPUs=1 State=UNKNOWN
PartitionName=bake Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$cluster/slurm.conf

  wait_for "munged's socket" 500 test -S "$cluster/socket/munge"
  slurmctld -D -c &>"$cluster/log/controller.out" &
  daemons+=($!)
  for node in "${nodes[@]}"; do
    mkdir -p "$cluster/$node"
    start_node "$node"
  done
  wait_for "two idle nodes" 1000 idle_nodes 2
}

# start_node NAME: each node reads the configuration by a name of its own, which its processes keep in their environment.
start_node() {
  cp "$cluster/slurm.conf" "$cluster/$1.conf"
  SLURM_CONF=$cluster/$1.conf slurmd -D -N "$1" &>"$cluster/log/$1.out" &
  daemons+=($!)
}

idle_nodes() { [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | sort -u | wc -l)" = "$1" ]; }

# wait_for WHAT LOOKS COMMAND...: returns when the command succeeds. A busy machine is slow to look, too.
wait_for() {
  local what=$1 most=$2 looks=0
  shift 2
  until "$@"; do
    if [ $((looks += 1)) -gt "$most" ]; then
      echo "error: no $what after $most looks" >&2
      [ -z "${cluster-}" ] || tail -n 5 "$cluster"/log/* >&2
      return 1
    fi
    sleep 0.2
  done
}

# processes_of CONFIGURATION: the processes that were started with it: slurmd, slurmstepd, and the job's own.
processes_of() {
  local process
  for process in /proc/[0-9]*; do
    if tr '\0' '\n' <"$process/environ" 2>/dev/null | grep -qxF "SLURM_CONF=$1"; then echo "${process#/proc/}"; fi
  done 2>/dev/null
}

# kill_node NAME: SIGKILL to everything that runs on the node, in one step, as if its power were cut.
kill_node() {
  local found
  mapfile -t found < <(processes_of "$cluster/$1.conf")
  ps -o pid=,args= -p "$(IFS=,; echo "${found[*]}")"
  kill -KILL "${found[@]}"
}

# Ends what start_cluster started: first the jobs, then the daemons, and by force what has not ended ten seconds later.
stop_cluster() {
  [ -n "${cluster-}" ] || return 0
  local found deadline=$((SECONDS + 10))
  scancel --me 2>/dev/null || true
  until [ -z "$(squeue -h --me 2>/dev/null)" ] || [ $SECONDS -ge $deadline ]; do sleep 0.2; done
  kill "${daemons[@]}" 2>/dev/null || true
  deadline=$((SECONDS + 10))
  while [ -n "$(jobs -rp)" ] && [ $SECONDS -lt $deadline ]; do sleep 0.2; done
  mapfile -t found < <(for conf in "$cluster"/*.conf; do processes_of "$conf"; done)
  if [ ${#found[@]} -gt 0 ]; then kill -KILL "${found[@]}" 2>/dev/null || true; fi
  wait "${daemons[@]}" 2>/dev/null || true
}
