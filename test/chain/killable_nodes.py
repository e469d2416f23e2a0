"""The chain's programs with the parameters of config/, started by the test itself, so that it may kill them."""

import contextlib
import pathlib
import signal
import subprocess
import sys
import tempfile

import rosgraph
import rosnode
import rospkg
import rospy
import yaml

PROGRAMS = pathlib.Path(sys.argv[0]).parent  # a test is found beside them
PACKAGE = pathlib.Path(rospkg.RosPack().get_path("cell_microinjection"))
PATIENCE = 30  # s of wall time; only what hangs takes that long


def merged(base, more):
    """As rosparam does it: a map's keys one by one."""
    for key, value in more.items():
        base[key] = merged(base.get(key, {}), value) if isinstance(value, dict) else value
    return base


def parameters(node, **changes):
    """Those of config/NODE.yaml with these changes, {section: {key: value}} as well."""
    return merged(yaml.safe_load((PACKAGE / f"config/{node}.yaml").read_text()), changes)


def rig():
    """Those of the micromanipulator with the simulated rig."""
    device = yaml.safe_load((PACKAGE / "src/rigs/sim/sim.yaml").read_text())
    return parameters("micromanipulator", rig="sim", device=device)


class KillableNodes:
    """{node: its parameters}. `participants` of the lock step; none: the session is live. `remaps`: {node: its
    arguments}. `outputs`: {node: descriptor of its standard output and error} of those that do not write to a file."""

    def __init__(self, nodes, participants=(), remaps=None, outputs=None):
        rospy.set_param("/robot_description", (PACKAGE / "urdf/rig.urdf").read_text())
        rospy.set_param("/lockstep/participants", list(participants))
        self._running, self._outputs = {}, {}
        self.begin(nodes, remaps, outputs)

    def begin(self, nodes, remaps=None, outputs=None):
        """Sets their parameters and starts them."""
        for node, settings in nodes.items():
            rospy.set_param(f"/{node}", settings)
            self.start(node, *(remaps or {}).get(node, ()), output=(outputs or {}).get(node))

    def start(self, node, *arguments, output=None):
        self._outputs[node] = tempfile.TemporaryFile()
        self._running[node] = subprocess.Popen([PROGRAMS / node, *arguments], stdin=subprocess.DEVNULL,
                                               stdout=output or self._outputs[node], stderr=subprocess.STDOUT)

    def names(self):
        return set(self._running)

    def dead(self):
        return [node for node, process in self._running.items() if process.poll() is not None]

    def process(self, node):
        return self._running[node]

    def status(self, node):
        """Exit status; None while it runs."""
        return self._running[node].poll()

    def report(self):
        """Who has ended, and what the nodes have said, for the message of a test that fails."""
        said = ""
        for node, file in self._outputs.items():
            file.seek(0)
            said += "".join(f"\n{node}: {line}" for line in file.read().decode(errors="replace").splitlines())
        return f"ended: {self.dead()}{said}"

    def kill(self, node, number=signal.SIGKILL):
        """@returns its exit status."""
        process = self._running.pop(node)
        process.send_signal(number)
        return process.wait(PATIENCE)

    def stop(self):
        # All at once: what outlives another has nothing to do any more.
        for process in self._running.values():
            process.kill()
        for process in self._running.values():
            process.wait(PATIENCE)
        self._running = {}

    def forget(self):
        """Has the master forget all that were started and are dead. It would ask them to end when others of their names
        come, at ports that may by then be those of others."""
        with contextlib.redirect_stdout(None):
            rosnode.cleanup_master_blacklist(rosgraph.Master(rospy.get_name()), [f"/{node}" for node in self._outputs])
