"""A real Slurm on this machine: its controller, two nodes of one core on the loopback, and munge with a key of its own.

Nothing of it outlives the context, and nothing of the machine's own Slurm or munge is touched.
"""
import getpass
import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

PROGRAMS = ('munged', 'slurmctld', 'slurmd', 'sbatch', 'squeue', 'scontrol', 'sinfo', 'scancel')
NODES = ('node0', 'node1')
PATIENCE = 60  # s for a daemon
CONFIGURATION = """ClusterName=trial
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/controller.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/log/controller
SlurmdLogFile={folder}/log/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=2,default_queue_depth=1000
ReturnToService=2
SlurmdTimeout=30
MaxArraySize=10001
MaxJobCount=20000
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=node0 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[0]} CPUs=1 RealMemory=1000
NodeName=node1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1 RealMemory=1000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing_programs():
    path = os.environ.get('PATH', '') + ':/usr/sbin:/sbin'
    return [name for name in PROGRAMS if not shutil.which(name, path=path)]


def free_ports(count):
    """Returns ports that were free together."""
    sockets = [socket.socket() for _ in range(count)]
    try:
        for each in sockets:
            each.bind(('127.0.0.1', 0))
        return [each.getsockname()[1] for each in sockets]
    finally:
        for each in sockets:
            each.close()


class LocalSlurm:
    def __init__(self, folder):
        self.folder = Path(folder)
        self.environment = {**os.environ, 'PATH': os.environ.get('PATH', '') + ':/usr/sbin:/sbin',
                            'SLURM_CONF': str(self.folder / 'slurm.conf')}

    def __enter__(self):
        for name in ('state', 'log', 'spool/node0', 'spool/node1', 'munge'):
            (self.folder / name).mkdir(parents=True)
        self._start_munge()
        controller_port, *ports = free_ports(3)
        (self.folder / 'slurm.conf').write_text(CONFIGURATION.format(
            folder=self.folder, host=socket.gethostname(), user=getpass.getuser(), controller_port=controller_port,
            ports=ports), encoding='utf-8')
        try:
            self.start_controller()
            for node in NODES:
                self.run('slurmd', '-N', node)
            self.wait_for(lambda: all(self.state(node) == 'IDLE' for node in NODES), 'two idle nodes')
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for name in (*NODES, 'controller', 'munge/munged'):
            self._end(self.folder / f'{name}.pid')

    def _start_munge(self):
        key = self.folder / 'munge/key'
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        munge = self.folder / 'munge'
        # Its checks of the folders' owners are for a key that several users share.
        self.run('munged', '--force', f'--socket={munge}/socket', f'--key-file={key}', f'--pid-file={munge}/munged.pid',
                 f'--log-file={munge}/log', f'--seed-file={munge}/seed')

    @staticmethod
    def _end(pid_file):
        try:
            pid = int(pid_file.read_text())
            os.kill(pid, signal.SIGTERM)
            end = time.monotonic() + PATIENCE
            while Path(f'/proc/{pid}').exists() and time.monotonic() < end:
                time.sleep(0.05)
        except (OSError, ValueError):
            pass

    def start_controller(self):
        self.run('slurmctld')

    def restart_controller(self, pause):
        """It is gone for `pause` s. Jobs go on meanwhile."""
        self._end(self.folder / 'controller.pid')
        time.sleep(pause)
        self.start_controller()

    def run(self, *command):
        """Returns its output."""
        done = subprocess.run([str(word) for word in command], env=self.environment, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f'{" ".join(map(str, command))}: {done.stderr.strip() or done.stdout.strip()}')
        return done.stdout

    def state(self, node):
        """Returns the states of a node, as IDLE+DRAIN. (sinfo names the host, which both nodes share.)"""
        words = self.run('scontrol', '--oneliner', 'show', 'node', node).split()
        return next(word.partition('=')[2] for word in words if word.startswith('State='))

    def waiting_jobs(self):
        """Returns how many array tasks and jobs are waiting or running."""
        return len(self.run('squeue', '--noheader', '--array', '--format=%i').split())

    def processes(self):
        """Returns the pids of the running jobs' programs."""
        found = []
        for line in subprocess.run(['ps', '-eo', 'pid=,args='], capture_output=True, text=True).stdout.splitlines():
            pid, _, command = line.strip().partition(' ')
            if str(self.folder) in command and ' --task ' in command:
                found.append(int(pid))
        return found

    @staticmethod
    def wait_for(condition, what, patience=PATIENCE):
        end = time.monotonic() + patience
        while not condition():
            if time.monotonic() > end:
                raise RuntimeError(f'{what}: not within {patience} s')
            time.sleep(0.1)
