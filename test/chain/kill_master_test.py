#!/usr/bin/python3
"""A live session on a master of its own: who is asked to end says zero force last; without the master, or while it
hangs, all rests. How long that takes is wall time (nodes/master_watch.h) and not looked at here."""

import csv
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

import numpy as np
import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped

from cell_microinjection.msg import InjectionPulse, InjectorState
from killable_nodes import PACKAGE, PATIENCE, KillableNodes, parameters, rig
from messages import force, position
from processes import free_port

LOST = "the ROS master is lost"
STILL = 2e-9  # m
RATE = 200  # Hz


class Master:
    def __init__(self, port):
        self._process = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL,
                                         stderr=subprocess.DEVNULL)
        until(rosgraph.is_master_online, "a master")

    def signal(self, number):
        self._process.send_signal(number)

    def kill(self):
        self._process.kill()
        self._process.wait()


def until(condition, what):
    for _ in range(100 * PATIENCE):
        if condition():
            return
        rospy.rostime.wallsleep(0.01)
    raise AssertionError(f"{what}: not within {PATIENCE} s")


class Heard:
    """Every message of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append)

    def newest(self, count, value):
        """Of the next `count` messages."""
        begin = len(self.messages)
        until(lambda: len(self.messages) >= begin + count, "messages")
        return np.array([value(message) for message in self.messages[begin:begin + count]])


def write_motion(path):
    """Into the cell, then up and down in it for ten minutes, so that the needle never rests by itself."""
    rows = [(0, 0, 0, 0, 0, "indent"), (1, 0, 0, -36e-3, 0, "indent")]
    rows += [(1 + 0.2 * i, 0, 0, -35.5e-3 if i % 2 else -36e-3, 0, "indent") for i in range(1, 3000)]
    with open(path, "w", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([("time_s", "x_m", "y_m", "z_m", "clutch", "phase"), *rows])


class KillMasterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.port = free_port()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{cls.port}"
        cls.master = Master(cls.port)
        rospy.init_node("master_killer")
        cls.folder = tempfile.TemporaryDirectory()
        motion = os.path.join(cls.folder.name, "motion.csv")
        write_motion(motion)
        # A machine that stalls must not hold the needle here, nor nodes in real time keep the test from the processor.
        patient = {key: 1.0 for key in ("hand", "needle", "predicted", "controller")}
        scene = str(PACKAGE / "test/chain/coarse_oocyte.yaml")
        cls.nodes = KillableNodes(
            {"operator": parameters("operator", rate=RATE, motion=motion, force_timeout=1.0),
             "haptic_bridge": parameters("haptic_bridge", rate=RATE, timeouts=patient),
             "injection_controller": parameters("injection_controller", rate=RATE, auto_enable=True, input_timeout=1.0),
             "micromanipulator": {**rig(), "rate": RATE, "command_timeout": 1.0}, "injector": parameters("injector"),
             "cell_simulator": parameters("cell_simulator", rate=RATE, scene=scene, model="live", needle="true",
                                          needle_timeout=1.0)})
        cls.felt, cls.needle = Heard("/haptic/servo_cf", WrenchStamped), Heard("/needle/measured_cp", PoseStamped)
        cls.injector = Heard("/injector/state", InjectorState)
        cls.diagnostics = Heard("/diagnostics", DiagnosticArray)
        cls.pulses = rospy.Publisher("/injector/pulse", InjectionPulse, queue_size=1)

    @classmethod
    def tearDownClass(cls):
        cls.nodes.stop()
        cls.master.kill()
        cls.folder.cleanup()

    def setUp(self):
        until(self.pressed, "a force on the hand")

    def pressed(self):
        return bool(self.felt.messages) and force(self.felt.messages[-1])[2] > 0.05

    def test_1_a_bridge_that_is_asked_to_end_says_zero_force(self):
        self.assertEqual(self.nodes.kill("haptic_bridge", signal.SIGTERM), 0)
        until(lambda: not self.pressed(), "zero force")
        np.testing.assert_array_equal([force(message) for message in self.felt.messages[-5:]], 0)
        self.nodes.start("haptic_bridge")
        until(self.pressed, "the force again")

    def begin_pulse(self, number):
        until(self.pulses.get_num_connections, "the injector")
        message = InjectionPulse(id=number, pressure=20e3, duration=60.0)
        message.header.stamp = rospy.Time.now()
        self.pulses.publish(message)
        until(lambda: self.injector.messages[-1].busy, "a pulse")
        self.assertGreater(np.ptp(self.needle.newest(RATE, position)[:, 2]), 50e-9, "the needle moves")

    def check_all_rests(self):
        until(lambda: not self.felt.newest(20, force).any(), "zero force")
        until(lambda: np.ptp(self.needle.newest(RATE, position)[:, 2]) < STILL, "a needle that rests")
        until(lambda: not self.injector.messages[-1].busy, "the end of the pulse")
        self.assertFalse(self.felt.newest(RATE, force).any())
        begin = len(self.diagnostics.messages)
        until(lambda: len(self.diagnostics.messages) > begin + 20, "diagnostics")
        said = [status for message in self.diagnostics.messages[begin + 5:] for status in message.status
                if status.name.endswith(": inputs")]
        self.assertTrue(said)
        self.assertTrue(all(LOST in status.message for status in said), said)

    def test_2_while_the_master_hangs_all_rests_and_then_goes_on(self):
        self.begin_pulse(1)
        self.master.signal(signal.SIGSTOP)
        self.check_all_rests()
        self.master.signal(signal.SIGCONT)
        until(self.pressed, "the force again")

    def test_3_without_a_master_and_with_one_that_does_not_know_the_nodes_all_rests(self):
        self.begin_pulse(2)
        self.master.kill()
        self.check_all_rests()
        type(self).master = Master(self.port)
        self.needle.newest(3 * RATE, position)  # a few questions to the new one
        self.check_all_rests()


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "kill_master", KillMasterTest)
