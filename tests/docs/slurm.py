# SPDX-License-Identifier: MIT
"""A Slurm of one machine, of this user and for this process alone, which listens to nobody else."""
import contextlib
import os
import pathlib
import pwd
import shutil
import socket
import subprocess
import tempfile
import time

CONFIGURATION = """ClusterName=test
SlurmctldHost=localhost
AuthType=auth/none
CredType=cred/none
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmctldPidFile={folder}/controller.pid
SlurmdPidFile={folder}/node.pid
SlurmdSpoolDir={folder}/spool
StateSaveLocation={folder}/state
SlurmctldLogFile={folder}/controller.log
SlurmdLogFile={folder}/node.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
SlurmdParameters=config_overrides
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName=localhost CPUs={processors} State=UNKNOWN
PartitionName=all Nodes=localhost Default=YES MaxTime=INFINITE State=UP
"""


def path():
    """Daemons are not in everybody's PATH."""
    return os.pathsep.join([os.environ["PATH"], "/usr/sbin"])


def is_there():
    return all(shutil.which(tool, path=path()) for tool in ("slurmctld", "slurmd", "sbatch", "sinfo"))


def free_ports(number):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(number)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


def wait_until_idle(env, folder):
    for _ in range(300):
        found = subprocess.run(["sinfo", "--noheader", "--format=%T"], env=env, capture_output=True, text=True)
        if found.stdout.strip() == "idle":
            return
        time.sleep(0.1)
    raise RuntimeError("Slurm does not begin: " + "".join(log.read_text()[-1000:] for log in folder.glob("*.log")))


@contextlib.contextmanager
def cluster():
    """What the environment of its users has; it ends with the block."""
    with tempfile.TemporaryDirectory() as name, contextlib.ExitStack() as stack:
        folder = pathlib.Path(name)
        (folder / "state").mkdir()
        (folder / "spool").mkdir()
        (folder / "slurm.conf").write_text(CONFIGURATION.format(
            user=pwd.getpwuid(os.getuid()).pw_name, ports=free_ports(2), folder=folder,
            processors=max(2, os.cpu_count() or 1)))  # a task of the page has two
        given = {"SLURM_CONF": str(folder / "slurm.conf")}
        env = {**os.environ, **given, "PATH": path()}
        for command in (["slurmctld", "-D", "-c"], ["slurmd", "-D", "-N", "localhost"]):
            daemon = subprocess.Popen(command, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL)
            stack.callback(daemon.wait)
            stack.callback(daemon.terminate)
        wait_until_idle(env, folder)
        yield given
