#!/usr/bin/python3
"""A real rig is not enabled while others can reach its nodes: the driver of a Zaber rig, with its device emulated, in
network namespaces that the test makes. And the namespace of isolated shells. Needs to be root."""

import os
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PATIENCE = 60  # s of wall time; only what hangs takes that long
ADDRESS, PEER = "10.77.0.1", "10.77.0.2"
PORT = 11311  # of the master, free in a namespace of its own


def run(*command, **options):
    return subprocess.run(command, check=True, **options)


def until(condition, what):
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError(f"{what}: not within {PATIENCE} s")


class Neighbour:
    """Another host: a namespace at the other end of a cable to the present one."""

    def __init__(self):
        self._process = subprocess.Popen(["unshare", "--net", "sleep", "1000"])
        pid = str(self._process.pid)
        own = os.readlink("/proc/self/ns/net")
        until(lambda: os.readlink(f"/proc/{pid}/ns/net") != own, "a namespace")
        self._enter = ["nsenter", "--target", pid, "--net"]
        run("ip", "link", "add", "cable", "type", "veth", "peer", "name", "end", "netns", pid)
        run("ip", "address", "add", f"{ADDRESS}/24", "dev", "cable")
        run("ip", "link", "set", "cable", "up")
        run(*self._enter, "ip", "address", "add", f"{PEER}/24", "dev", "end")
        run(*self._enter, "ip", "link", "set", "end", "up")

    def reaches(self, port):
        code = f"import socket; socket.create_connection(('{ADDRESS}', {port}), {PATIENCE})"
        return subprocess.run([*self._enter, sys.executable, "-c", code], stderr=subprocess.DEVNULL).returncode == 0

    def unplug(self):
        """The interface stays up, and keeps its address."""
        run(*self._enter, "ip", "link", "set", "end", "down")

    def close(self):
        self._process.kill()
        self._process.wait()


class Rig:
    """Master, emulated device and driver in the present namespace."""

    def __init__(self, folder, **parameters):
        import rospkg
        import rospy
        import yaml
        from cell_microinjection.msg import OperatingState
        from diagnostic_msgs.msg import DiagnosticArray
        package = rospkg.RosPack().get_path("cell_microinjection")
        device = yaml.safe_load(open(f"{package}/config/rigs/zaber.yaml", encoding="utf-8"))
        device["port"]["path"] = f"{folder}/rig"
        self._programs = [subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], stdout=subprocess.DEVNULL)]
        until(lambda: subprocess.run(["rosparam", "list"], capture_output=True).returncode == 0, "a master")
        rospy.set_param("/robot_description", open(f"{package}/urdf/rig.urdf", encoding="utf-8").read())
        rospy.set_param("/micromanipulator", {"rig": "zaber", "device": device, **parameters})
        rospy.init_node("watcher")
        self.state, self.reasons = None, []
        rospy.Subscriber("/needle/operating_state", OperatingState, lambda message: setattr(self, "state", message.state))
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)
        self._start("emulate", "zaber", "--link", f"{folder}/rig")
        self._start("micromanipulator")

    def _start(self, program, *arguments):
        self._programs.append(subprocess.Popen(["rosrun", "cell_microinjection", program, *arguments]))

    def _on_diagnostics(self, message):
        self.reasons = [status.message for status in message.status if status.name == "micromanipulator: commands"]

    def refuses(self, why):
        return self.state == "DISABLED" and any(why in reason for reason in self.reasons)

    def port(self):
        """Of the driver's own server."""
        import rosgraph
        return int(rosgraph.Master("/watcher").lookupNode("/micromanipulator").rstrip("/").rpartition(":")[2])

    def close(self):
        for program in reversed(self._programs):
            program.terminate()
            program.wait()


def alone(rig):
    until(lambda: rig.state == "ENABLED", "ENABLED where nobody else is")


def cabled(rig, neighbour):
    until(lambda: rig.refuses(f"cable ({ADDRESS})"), "a rig that is not enabled, and says why")
    if not neighbour.reaches(rig.port()):
        raise AssertionError("the neighbour cannot reach the node, which listens on every interface: why?")
    neighbour.unplug()
    until(lambda: rig.state == "ENABLED", "ENABLED when the cable is out")


def allowed(rig):
    until(lambda: rig.state == "ENABLED", "ENABLED as the parameter allows")


def inside(case):
    """What a test does within a namespace of its own."""
    run("ip", "link", "set", "lo", "up")
    neighbour = None if case == "alone" else Neighbour()
    with tempfile.TemporaryDirectory() as folder:
        rig = Rig(folder, **({"allow_network": True} if case == "allowed" else {}))
        try:
            cabled(rig, neighbour) if case == "cabled" else alone(rig) if case == "alone" else allowed(rig)
        finally:
            rig.close()
            if neighbour:
                neighbour.close()


def may_make_namespaces():
    return os.geteuid() == 0 and subprocess.run(["unshare", "--net", "true"], capture_output=True).returncode == 0


@unittest.skipUnless(may_make_namespaces(), "no network namespaces: needs root, and a system that allows them")
class NetworkTest(unittest.TestCase):
    def check(self, case):
        environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{PORT}", "ROS_IP": "127.0.0.1"}
        result = subprocess.run(["unshare", "--net", sys.executable, "-B", __file__, "--inside", case], env=environment,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=5 * PATIENCE)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_enabled_where_nobody_else_is(self):
        self.check("alone")

    def test_not_enabled_while_others_can_reach_it(self):
        self.check("cabled")

    def test_enabled_where_a_parameter_allows_others(self):
        self.check("allowed")


@unittest.skipUnless(may_make_namespaces(), "no network namespaces: needs root, and a system that allows them")
class IsolatedShellTest(unittest.TestCase):
    """What `./dev shell --isolated` runs a command with."""

    NAMESPACE = "cell_microinjection"
    TOOLS = Path(__file__).resolve().parents[2] / "src/tools/dev"

    def run_isolated(self, code, **environment):
        script = """
            ROOT=$1; fail() { echo "$*" >&2; exit 1; }
            for part in setup environment isolate; do source "$1/src/tools/dev/$part.sh"; done
            run_isolated "$2" -c "$3"
            """
        command = ["bash", "-c", script, "dev", self.TOOLS.parents[2], sys.executable, code]
        result = subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout.strip()

    def setUp(self):
        there = subprocess.run(["ip", "netns", "list"], capture_output=True, text=True).stdout.split()
        if self.NAMESPACE not in there:
            self.addCleanup(subprocess.run, ["ip", "netns", "delete", self.NAMESPACE], check=True)

    def test_has_the_loopback_interface_only(self):
        names = "import socket; print(*(name for _, name in socket.if_nameindex()))"
        self.assertEqual(self.run_isolated(names), "lo")

    def test_shells_find_each_other(self):
        """And not what listens outside of them."""
        with socket.create_server(("127.0.0.1", 0)) as outside:
            reach = f"import socket; print(socket.socket().connect_ex(('127.0.0.1', {outside.getsockname()[1]})) != 0)"
            self.assertEqual(self.run_isolated(reach), "True")
        place = "import os; print(os.readlink('/proc/self/ns/net'))"
        self.assertEqual(self.run_isolated(place), self.run_isolated(place))

    def test_keeps_the_environment_and_names_the_local_master(self):
        names = ("MINE", "ROS_IP", "ROS_MASTER_URI")
        show = f"import os; print(*(os.environ[name] for name in {names}))"
        outside = {"MINE": "kept", "ROS_IP": "10.0.0.1", "ROS_MASTER_URI": "http://elsewhere:1"}
        self.assertEqual(self.run_isolated(show, **outside), "kept 127.0.0.1 http://127.0.0.1:11311")


if __name__ == "__main__":
    if "--inside" in sys.argv:
        inside(sys.argv[-1])
    else:
        unittest.main()
