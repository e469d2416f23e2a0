"""The chain's programs with the parameters of config/, started by the test itself, so that it may kill them."""

import pathlib
import signal
import subprocess
import sys
import tempfile

import rosgraph
import rospkg
import rospy
import yaml

from links import await_end_of_links

PROGRAMS = pathlib.Path(sys.argv[0]).parent  # a test is found beside them
PACKAGE = pathlib.Path(rospkg.RosPack().get_path("cell_microinjection"))
# Of each node: what roscpp and diagnostic_updater watch. As long as the master would tell a node of one, it knows it.
WATCHED_PARAMETERS = ("/rosout_disable_topics_generation", "~diagnostic_period")
RATE = 50  # Hz, at most, of all loops: what these tests look at does not need 1 kHz, which not each machine keeps
PATIENCE = 30  # s of wall time; only what hangs takes that long


def merged(base, more):
    """As rosparam does it: a map's keys one by one."""
    for key, value in more.items():
        base[key] = merged(base.get(key, {}), value) if isinstance(value, dict) else value
    return base


def parameters(node, **changes):
    """Those of config/NODE.yaml with these changes, {section: {key: value}} as well."""
    of_file = yaml.safe_load((PACKAGE / f"config/{node}.yaml").read_text())
    if of_file.get("rate", 0) > RATE:
        of_file["rate"] = RATE
    return merged(of_file, changes)


def rig():
    """Those of the micromanipulator with the simulated rig."""
    device = yaml.safe_load((PACKAGE / "config/rigs/sim.yaml").read_text())
    return parameters("micromanipulator", rig="sim", device=device)


class KillableNodes:
    """{node: its parameters}. `outputs`: {node: descriptor of its standard output and error} of those that do not write to a
    file. `enter`: {node: a command that runs another one in its place, as on another host}."""

    def __init__(self, nodes, outputs=None, enter=None):
        self._enter = enter or {}
        rospy.set_param("/robot_description", (PACKAGE / "urdf/rig.urdf").read_text())
        self._running, self._frozen, self._outputs = {}, {}, {}
        self.begin(nodes, outputs)

    def begin(self, nodes, outputs=None):
        """Sets their parameters and starts them."""
        for node, settings in nodes.items():
            rospy.set_param(f"/{node}", settings)
            self.start(node, output=(outputs or {}).get(node))

    def start(self, node, output=None):
        self._outputs[node] = tempfile.TemporaryFile()
        self._running[node] = subprocess.Popen([*self._enter.get(node, ()), PROGRAMS / node], stdin=subprocess.DEVNULL,
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

    def freeze(self, node):
        """It stays, and does nothing any more."""
        self._frozen[node] = self._running.pop(node)
        self._frozen[node].send_signal(signal.SIGSTOP)

    def thaw(self, node):
        """It goes on where it was."""
        self._running[node] = self._frozen.pop(node)
        self._running[node].send_signal(signal.SIGCONT)

    def stop(self):
        # All at once: what outlives another has nothing to do any more.
        processes = [*self._running.values(), *self._frozen.values()]
        for process in processes:
            process.kill()
        for process in processes:
            process.wait(PATIENCE)
        self._running, self._frozen = {}, {}

    def forget(self):
        """Has the master forget all that were started, which must be dead, and this node their connections. When others
        of their names came, the master would ask the dead ones' addresses to end, which may by then be those of new
        nodes.

        rosnode.cleanup_master_blacklist does not do: it asks for a node's address once, and so unregisters nothing of a
        second node of that name; and parameters it leaves out."""
        names = [f"/{node}" for node in self._outputs]
        addresses = dict(filter(None, map(address, names)))
        publishers, subscribers, services = rosgraph.Master(rospy.get_name()).getSystemState()
        # Subscribers first: the master tells those who are left of each publisher that goes.
        for topic, name in pairs(subscribers, addresses):
            rosgraph.Master(name).unregisterSubscriber(topic, addresses[name])
        for service, name in pairs(services, addresses):
            master = rosgraph.Master(name)
            master.unregisterService(service, master.lookupService(service))
        for topic, name in pairs(publishers, addresses):
            rosgraph.Master(name).unregisterPublisher(topic, addresses[name])
        for name in addresses:
            for key in WATCHED_PARAMETERS:
                rosgraph.Master(name).unsubscribeParam(addresses[name], key.replace("~", name + "/"))
        left = [name for name in names if address(name)]
        assert not left, f"the master still knows {left}"
        await_end_of_links(set(addresses.values()), PATIENCE)


def address(name):
    """@returns (name, its XML-RPC address at the master), None where there is no such node."""
    try:
        return name, rosgraph.Master(rospy.get_name()).lookupNode(name)
    except rosgraph.MasterError:
        return None


def pairs(state, names):
    """(topic or service, name) of each registration of these."""
    return [(what, name) for what, registered in state for name in registered if name in names]
