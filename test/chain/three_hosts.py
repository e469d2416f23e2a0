"""The chain over three hosts with a slow network that loses frames: rig (master, controller, micromanipulator), haptic (hand,
bridge) and solver (cell). Each fault of the page on time-outs, and pulled cables: the needle has to rest."""

import os
import signal
import subprocess
import time

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped

import lossy_network
from live_chain import TIMEOUT, HandProcess, LiveChain, until
from lossy_network import HostNamespace, LossySwitch
from messages import position

DELAY, LOSS = 0.02, 0.05  # s one way; share of the frames
ADDRESSES = {"rig": "10.88.0.1", "haptic": "10.88.0.2", "solver": "10.88.0.3"}
PORT = 11311
PLACES = {"haptic_bridge": "haptic", "cell_simulator": "solver"}  # the other nodes are at the rig
STILL = 2e-9        # m
STOP_TIME = 0.5     # s that the controller, the needle and the news of it take
OBSERVED = 1.5      # s
MASTER_FROZEN = 5.0  # s, as the page says; 0.5 for a dead one
# Without the micromanipulator nothing says where the needle is.
FAULTS = [(how, who) for who in ("hand", "haptic_bridge", "injection_controller", "cell_simulator")
          for how in ("killed", "frozen")] + [("pulled", host) for host in ADDRESSES] + [("frozen", "master")]


class RemoteHand(HandProcess):
    """On the host `haptic`."""

    environment = {"ROS_IP": ADDRESSES["haptic"]}


class ThreeHosts:
    def __init__(self, delay=DELAY, loss=LOSS):
        self.hosts, self.switch, self.chain, self._master = {}, None, None, None
        self._poses = []
        try:
            self._start(delay, loss)
        except BaseException:
            self.close()
            raise

    def _start(self, delay, loss):
        for name, address in ADDRESSES.items():
            self.hosts[name] = HostNamespace(address)
        self.switch = LossySwitch(list(self.hosts.values()), delay, loss)
        # The test is on the rig's host from here on, and so is what it starts.
        lossy_network.enter(self.hosts["rig"])
        os.environ.update(ROS_MASTER_URI=f"http://{ADDRESSES['rig']}:{PORT}", ROS_IP=ADDRESSES["rig"])
        os.environ.pop("ROS_HOSTNAME", None)
        self._master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        import rosgraph
        until(rosgraph.is_master_online, "a master")
        rospy.init_node("watcher_of_three_hosts")
        enter = {node: [*self.hosts[host].enter, "env", f"ROS_IP={ADDRESSES[host]}"] for node, host in PLACES.items()}
        RemoteHand.enter = self.hosts["haptic"].enter
        self.chain = LiveChain({}, hand=RemoteHand, enter=enter)
        self._subscriber = rospy.Subscriber("/needle/measured_cp", PoseStamped, self._poses.append)
        self.chain.check_follows()

    def close(self):
        if self.chain:
            self.chain.end_processes()
        if self._master:
            self._master.kill()
            self._master.wait()
        if self.switch:
            self.switch.close()
        for host in self.hosts.values():
            host.close()

    def fail(self, how, who):
        if how == "pulled":
            self.switch.pulled.add(ADDRESSES[who])
        elif who == "master":
            self._master.send_signal(signal.SIGSTOP)
        elif who == "hand":
            self.chain.hand.fail(how)
        else:
            self.chain.nodes.kill(who) if how == "killed" else self.chain.nodes.freeze(who)

    def recover(self, how, who):
        if how == "pulled":
            self.switch.pulled.clear()
        elif who == "master":
            self._master.send_signal(signal.SIGCONT)
        elif who == "hand":
            self.chain.hand.recover(how)
        elif how == "killed":
            self.chain.nodes.start(who)
        else:
            self.chain.nodes.thaw(who)

    def observe(self, seconds):
        """Returns the largest distance between the needle's places in that time, m. The poses' stamps count, which are
        of this host's clock: on a machine that stalls they may come late."""
        begin = rospy.Time.now()
        end = begin + rospy.Duration(seconds)
        self._poses.clear()
        until(lambda: self._poses and self._poses[-1].header.stamp > end, "poses of the needle")
        places = [position(message) for message in list(self._poses) if message.header.stamp >= begin]
        return float(np.ptp(places, axis=0).max())

    def measure(self, how, who):
        """Returns the distance (m) that the needle moves after the time-outs of a fault; then it has to follow again."""
        self.fail(how, who)
        time.sleep((MASTER_FROZEN if who == "master" else TIMEOUT) + STOP_TIME)
        moved = self.observe(OBSERVED)
        self.recover(how, who)
        self.chain.check_follows()
        return moved
