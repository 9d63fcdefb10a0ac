# SPDX-License-Identifier: Apache-2.0
# Sourced by scripts that test against a real Slurm: one node on this machine, in a folder of its
# own, as root and without systemd. Debian packages: slurmctld slurmd slurm-client munge.
#   slurm_start FOLDER CPUS  munged, slurmctld and slurmd; back when the node takes jobs, and
#                            SLURM_CONF is exported then. If it does not come up in 30 s: the logs
#                            on stderr, nothing left running, status 1
#   slurm_stop FOLDER        ends them and what jobs have left; once more does no harm
# CPUS may be more than the machine has. A start forgets the jobs of the one before.

slurm_start() {
    local folder conf port PATH=$PATH:/usr/sbin
    folder=$(realpath -m "$1")
    conf=$folder/slurm.conf
    # Sockets lie in the folder, whose names have 107 bytes; slurm.conf takes no blanks, and % and #
    # mean something else there.
    if [[ ! $folder =~ ^[^[:space:]%#]{1,80}$ ]]; then
        echo "slurm_start: a folder of at most 80 characters, no blank, % or #: $folder" >&2
        return 1
    fi
    slurm_stop "$folder" || return 1
    rm -rf "$folder"/{slurmctld.state,slurmd.spool,{munged,slurmctld,slurmd}.log,munge.key}
    mkdir -p "$folder"/{slurmctld.state,slurmd.spool} || return 1
    (umask 077 && head -c 128 /dev/urandom >"$folder/munge.key") || return 1
    port=$(slurm_free_ports)
    # Addresses, as a container's own name often has none. For the same reason the two ports listen
    # on every interface: to keep to one (NoInAddrAny) is to look up that name. Who has no munge.key
    # is refused. pgid follows process groups, so what a task starts in a group of its own (timeout
    # does) outlives scancel, until slurm_stop. The scheduler looks once a second; by its defaults
    # an array or a dependency waits 3 s.
    cat >"$conf" <<CONF || return 1
ClusterName=one
SlurmctldHost=$(uname -n | cut -d. -f1)(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
SlurmUser=root
StateSaveLocation=$folder/slurmctld.state
SlurmdSpoolDir=$folder/slurmd.spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
MailProg=/bin/true
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
KillWait=2
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=one NodeAddr=127.0.0.1 CPUs=$2 RealMemory=$(awk '/^MemTotal/ { print int($2 / 1024) }' \
        /proc/meminfo)
PartitionName=all Nodes=one Default=YES MaxTime=INFINITE
CONF
    export SLURM_CONF=$conf
    if munged --force --origin=127.0.0.1 --socket="$folder/munge.socket" \
        --key-file="$folder/munge.key" --log-file="$folder/munged.log" \
        --pid-file="$folder/munged.pid" --seed-file="$folder/munge.seed" &&
        slurmctld -f "$conf" && slurmd -f "$conf" -N one && slurm_wait_idle; then
        return 0
    fi
    echo "slurm_start: the node is not idle" >&2
    tail -n 50 "$folder"/{munged,slurmctld,slurmd}.log >&2 2>/dev/null || true
    slurm_stop "$folder" || true
    return 1
}

slurm_stop() {
    local folder status=0
    folder=$(realpath -m "$1")
    [ -d "$folder" ] || return 0
    # slurmd leaves running jobs alone when it ends, and slurmctld would start the next ones. A step
    # does not end at TERM, and once its tasks have ended it tries for minutes to tell slurmctld.
    slurm_end "TERM KILL" slurm_daemons "$folder" slurmctld slurmd || status=1
    slurm_end KILL slurm_steps "$folder" || status=1
    slurm_end "TERM KILL KILL" slurm_tasks "$folder" || status=1
    slurm_end "TERM KILL" slurm_daemons "$folder" munged || status=1
    [ $status -ne 0 ] || rm -f "$folder"/{munged,slurmctld,slurmd}.pid
    return $status
}

# The rest is for the two above.

slurm_free_ports() { # the first of two neighbours that nobody listens on
    local port
    while :; do
        port=$((20000 + RANDOM % 10000)) # below those that the kernel gives to outgoing connections
        (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null && continue
        (: <"/dev/tcp/127.0.0.1/$((port + 1))") 2>/dev/null && continue
        echo "$port"
        return
    done
}

slurm_wait_idle() {
    local deadline=$((SECONDS + 30))
    while [ $SECONDS -lt $deadline ]; do
        [ "$(timeout 5 sinfo -h -o %t 2>/dev/null || true)" = idle ] && return
        sleep 0.1
    done
    return 1
}

slurm_daemons() { # FOLDER NAME...: the process numbers of those that run
    local name pid
    for name in "${@:2}"; do
        pid=$(cat "$1/$name.pid" 2>/dev/null) || continue
        # The number may be another's by now.
        grep -qsF "$1/" "/proc/$pid/cmdline" && echo "$pid"
    done
    return 0
}

# Steps are no children of slurmd, but have its log open.
slurm_steps() {
    { find /proc/[0-9]*/fd -lname "$1/slurmd.log" 2>/dev/null || true; } | cut -d/ -f3 | sort -u
}

# What a task leaves need be no child of a step; its variables tell. Who submits jobs has only the
# first of the two.
slurm_tasks() {
    {
        grep -lsxzF "SLURM_CONF=$1/slurm.conf" /proc/[0-9]*/environ |
            xargs -r grep -lsxzF SLURMD_NODENAME=one || true
    } | cut -d/ -f3
}

slurm_end() { # SIGNALS COMMAND...: ends the processes that it prints; 5 s for each signal
    local signal sent end pids
    for signal in $1; do
        sent=0 end=$((SECONDS + 5))
        while [ $SECONDS -lt $end ]; do
            pids=$("${@:2}" | tr '\n' ' ')
            [ -n "$pids" ] || return 0
            # shellcheck disable=SC2086
            [ $sent -eq 1 ] || kill -s "$signal" $pids 2>/dev/null || true
            sent=1
            sleep 0.1
        done
    done
    echo "slurm_stop: still there: $pids" >&2
    return 1
}
