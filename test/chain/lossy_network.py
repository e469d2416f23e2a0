"""Hosts as network namespaces, joined by a switch of the test's own that delays and loses Ethernet frames and whose cables
can be pulled. It needs root and /dev/net/tun, and no netem, which many kernels do not have."""

import ctypes
import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import threading
import time

TUNSETIFF, TAP, NO_HEADER = 0x400454CA, 0x0002, 0x1000
FRAME = 65536  # bytes, more than any frame


def possible():
    return os.geteuid() == 0 and os.access("/dev/net/tun", os.R_OK | os.W_OK) and subprocess.run(
        ["unshare", "--net", "true"], capture_output=True).returncode == 0


def enter(host):
    """This thread, and what it starts from now on, is in the namespace of a host."""
    libc = ctypes.CDLL(None, use_errno=True)
    with open(f"/proc/{host.keeper}/ns/net", "rb") as namespace:
        if libc.setns(namespace.fileno(), 0):
            raise OSError(ctypes.get_errno(), "setns")


class HostNamespace:
    """One interface, `wire`, at the switch. `enter`: the command that runs another one in it."""

    def __init__(self, address):
        self.address = address
        self._keeper = subprocess.Popen(["unshare", "--net", "sleep", "10000"])
        self.keeper = self._keeper.pid
        own = os.readlink("/proc/self/ns/net")
        while os.readlink(f"/proc/{self.keeper}/ns/net") == own:
            time.sleep(0.01)
        self.enter = ["nsenter", "--target", str(self.keeper), "--net"]
        self.tap = self._open_tap()
        for command in (["link", "set", "lo", "up"], ["address", "add", f"{address}/24", "dev", "wire"],
                        ["link", "set", "wire", "up"]):
            self.run("ip", *command)

    def _open_tap(self):
        """A thread enters the namespace for it; the descriptor stays there."""
        opened = []

        def open_there():
            enter(self)
            tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
            fcntl.ioctl(tap, TUNSETIFF, struct.pack("16sH", b"wire", TAP | NO_HEADER))
            opened.append(tap)

        thread = threading.Thread(target=open_there)
        thread.start()
        thread.join()
        if not opened:
            raise OSError("no interface in the namespace")
        return opened[0]

    def run(self, *command):
        return subprocess.run([*self.enter, *command], check=True, capture_output=True, text=True).stdout

    def close(self):
        os.close(self.tap)
        self._keeper.kill()
        self._keeper.wait()


class LossySwitch:
    """Joins hosts (HostNamespace). Each frame is `delay` s late, and lost with the probability `loss`; 0.25 of the delay is
    jitter that keeps the frames in order."""

    def __init__(self, hosts, delay, loss, seed=1):
        self._ports = [host.tap for host in hosts]
        self._names = {host.tap: host.address for host in hosts}
        self.delay, self.loss = delay, loss
        self.pulled = set()  # addresses
        self.passed = self.lost = 0
        self._random = random.Random(seed)
        self._known, self._waiting, self._last = {}, [], {}
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _due(self, source):
        due = time.monotonic() + self.delay * (1 + 0.25 * self._random.random())
        self._last[source] = max(due, self._last.get(source, 0))
        return self._last[source]

    def _take(self, source):
        while True:
            try:
                frame = os.read(source, FRAME)
            except BlockingIOError:
                return
            self._known[frame[6:12]] = source
            if self._names[source] in self.pulled or self._random.random() < self.loss:
                self.lost += 1
                continue
            self.passed += 1
            heapq.heappush(self._waiting, (self._due(source), self.passed, source, frame))

    def _give(self, source, frame):
        target = self._known.get(frame[:6])
        for port in [target] if target else [each for each in self._ports if each != source]:
            if self._names[port] in self.pulled:
                continue
            try:
                os.write(port, frame)
            except (BlockingIOError, OSError):  # a full queue loses frames, as a switch does
                pass

    def _run(self):
        poll = select.poll()
        for port in self._ports:
            poll.register(port, select.POLLIN)
        while not self._ended.is_set():
            wait = 1000 * (self._waiting[0][0] - time.monotonic()) if self._waiting else 50
            for port, _ in poll.poll(min(50, max(0, wait))):
                self._take(port)
            while self._waiting and self._waiting[0][0] <= time.monotonic():
                _, _, source, frame = heapq.heappop(self._waiting)
                self._give(source, frame)

    def close(self):
        self._ended.set()
        self._thread.join()
