"""Child processes that are always cleaned up: each in a session of its own, stopped with its whole family."""
import os
import signal
import socket
import subprocess
import time
from pathlib import Path


def free_port():
    """Returns a TCP port that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


def _stat(pid):
    """Returns (parent's pid, state, start time) of a process, or None when it is gone."""
    try:
        with open(f'/proc/{pid}/stat', encoding='utf-8', errors='replace') as file:
            fields = file.read().rpartition(')')[2].split()  # the name before it may hold anything
        return int(fields[1]), fields[0], fields[19]
    except (OSError, IndexError):
        return None


def _family(pid):
    """Returns {(pid, start time)} of a process and all that descend from it."""
    children, start = {}, {}
    for entry in os.listdir('/proc'):
        stat = _stat(entry) if entry.isdigit() else None
        if stat:
            children.setdefault(stat[0], []).append(int(entry))
            start[int(entry)] = stat[2]
    family, waiting = set(), [pid]
    while waiting:
        member = waiting.pop()
        if member in start:
            family.add((member, start[member]))
            waiting += children.get(member, [])
    return family


def _processor_time(path):
    with open(path, encoding='utf-8', errors='replace') as file:
        fields = file.read().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def gone(pid):
    """Returns whether a process has ended, be it that nobody has asked for its exit code."""
    stat = _stat(pid)
    return stat is None or stat[1] == 'Z'


class Child:
    """A program that runs beside us, its output in a file."""

    def __init__(self, command, log, env=None, pass_fds=()):
        self.log = log
        log.parent.mkdir(parents=True, exist_ok=True)
        with log.open('wb') as output:
            # A session of its own, so that Ctrl-C reaches us alone and we stop the children in order.
            self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output,
                                             stderr=subprocess.STDOUT, env=env, pass_fds=pass_fds,
                                             start_new_session=True)

    def favour(self, niceness):
        """Its share of the processor beside other sessions, where Linux groups by session and lets us."""
        try:
            Path(f'/proc/{self._process.pid}/autogroup').write_text(str(niceness), encoding='ascii')
        except OSError:
            pass

    def send_signal(self, number):
        self._process.send_signal(number)

    def first_thread_time(self):
        """s of processor time that its first thread has used."""
        return _processor_time(f'/proc/{self._process.pid}/task/{self._process.pid}/stat')

    def processor_time(self):
        """s of processor time that all of its threads have used."""
        return _processor_time(f'/proc/{self._process.pid}/stat')

    def running(self):
        return self._process.poll() is None

    def stop(self, patience, force_after=5):
        """Interrupts it and waits `patience` s; then terminates it and waits `force_after` s; then kills it. Leaves
        none of its descendants behind. Returns at once when it has already ended."""
        family = set()
        for number, wait in ((signal.SIGINT, patience), (signal.SIGTERM, force_after), (signal.SIGKILL, 5)):
            if not self.running():
                break
            family |= _family(self._process.pid)
            self._process.send_signal(number)
            try:
                self._process.wait(wait)
            except subprocess.TimeoutExpired:
                pass
        for pid, start in family:
            stat = _stat(pid)
            if stat and stat[2] == start and not gone(pid):  # the same process, not another that got its number
                os.kill(pid, signal.SIGKILL)

    def output(self):
        return self.log.read_text(encoding='utf-8', errors='replace')

    def tail(self, lines):
        """Returns the last lines of its output."""
        return '\n'.join(self.output().splitlines()[-lines:])


def wait_until(condition, timeout, period=0.1):
    """Returns whether `condition()` became true within `timeout` s."""
    end = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(period)
    return True
