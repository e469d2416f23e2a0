#!/usr/bin/python3
"""A live session on a master of its own: who is asked to end says zero force last; without the master, or while it
hangs, all rests. How long that takes is wall time (nodes/master_watch.h) and not looked at here."""

import itertools
import math
import signal
import threading
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped

from cell_microinjection.msg import InjectionPulse, InjectorState
from killable_nodes import KillableNodes
from live_chain import RATE, Master, chain_parameters, until
from messages import force, pose, position

LOST = "the ROS master is lost"
STILL = 2e-9  # m


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


class Hand:
    """Presses until it feels the cell, whenever the others are ready; then up and down in it, so that the needle never
    rests by itself."""

    PRESSED = 0.15  # N
    SPEED, STROKE = 5e-3, 0.5e-3  # m/s, m

    def __init__(self, feels):
        self._publisher = rospy.Publisher("/haptic/measured_cp", PoseStamped, queue_size=1)
        self._feels, self._z, self._turn = feels, 0.0, None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._ended = threading.Event()
        self._thread.start()

    def end(self):
        self._ended.set()
        self._thread.join()

    def _run(self):
        step = -self.SPEED / RATE
        while not self._ended.is_set():
            if self._turn is None:
                self._turn = self._z if self._feels() > self.PRESSED else None
            elif not 0 <= self._z - self._turn <= self.STROKE:
                step = math.copysign(step, self._turn - self._z)
            self._z += step
            message = pose(0, 0, self._z, "haptic")
            message.header.stamp = rospy.Time.now()
            self._publisher.publish(message)
            rospy.rostime.wallsleep(1 / RATE)


class MasterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("master_killer")
        cls.nodes = KillableNodes({node: settings for node, settings in chain_parameters().items() if node != "force_sensor"})
        cls.felt, cls.needle = Heard("/haptic/servo_cf", WrenchStamped), Heard("/needle/measured_cp", PoseStamped)
        cls.injector = Heard("/injector/state", InjectorState)
        cls.diagnostics = Heard("/diagnostics", DiagnosticArray)
        cls.hand = Hand(cls.feels)
        cls.numbers = itertools.count(1)
        cls.pulses = rospy.Publisher("/injector/pulse", InjectionPulse, queue_size=1)

    @classmethod
    def tearDownClass(cls):
        cls.hand.end()
        cls.nodes.stop()
        cls.master.kill()

    def setUp(self):
        try:
            until(self.pressed, "a force on the hand")
        except AssertionError as error:
            said = self.said(-12, (": inputs", ": loop"))
            raise AssertionError(f"{error}; {said}; {self.nodes.report()}") from None

    @classmethod
    def feels(cls):
        """@returns the force on the hand along z (N)."""
        return force(cls.felt.messages[-1])[2] if cls.felt.messages else 0.0

    def pressed(self):
        return self.feels() > 0.05

    def said(self, begin, of):
        """What the nodes have said of these since that diagnostic message."""
        return [f"{status.name}: {status.message}" for message in self.diagnostics.messages[begin:]
                for status in message.status if status.name.endswith(of)]

    def test_1_a_bridge_that_is_asked_to_end_says_zero_force(self):
        self.assertEqual(self.nodes.kill("haptic_bridge", signal.SIGTERM), 0)
        until(lambda: not any(force(message).any() for message in self.felt.messages[-5:]), "zero force at the last")
        self.nodes.start("haptic_bridge")
        until(self.pressed, "the force again")

    def begin_pulse(self):
        until(lambda: self.pulses.get_num_connections() and self.injector.messages, "the injector")
        asked = False

        def busy():
            nonlocal asked
            state = self.injector.messages[-1]
            # One that was late on a machine that stalls is refused.
            if not state.busy and (not asked or "it is stale" in state.refusal):
                asked = True
                message = InjectionPulse(id=next(self.numbers), pressure=20e3, duration=60.0)
                message.header.stamp = rospy.Time.now()
                self.pulses.publish(message)
            return state.busy
        until(busy, "a pulse")
        until(lambda: np.ptp(self.needle.newest(RATE, position)[:, 2]) > 50e-9, "a needle that moves")

    def lost(self):
        """Of each node that has told of its inputs whether it says by now that the master is lost."""
        newest = {}
        for said in self.said(0, (": inputs",)):
            node, _, text = said.partition(": ")
            newest[node] = LOST in text
        return newest.values()

    def check_all_rests(self):
        # Each finds out by itself, and one that stood still meanwhile later than others.
        until(lambda: self.lost() and all(self.lost()), "that the master is lost")
        until(lambda: not self.felt.newest(20, force).any(), "zero force")
        until(lambda: np.ptp(self.needle.newest(RATE, position)[:, 2]) < STILL, "a needle that rests")
        until(lambda: not self.injector.messages[-1].busy, "the end of the pulse")
        self.assertFalse(self.felt.newest(RATE, force).any())
        begin = len(self.diagnostics.messages)
        until(lambda: len(self.diagnostics.messages) > begin + 20, "diagnostics")
        said = self.said(begin + 5, (": inputs",))
        self.assertTrue(said)
        self.assertTrue(all(LOST in status for status in said), said)

    def test_2_while_the_master_hangs_all_rests_and_then_goes_on(self):
        self.begin_pulse()
        self.master.signal(signal.SIGSTOP)
        self.check_all_rests()
        self.master.signal(signal.SIGCONT)
        until(self.pressed, "the force again")
        # Each finds out by itself: the injector may be later than those who make the force.
        until(lambda: not any(self.lost()), "that the master is back")

    def test_3_without_a_master_and_with_one_that_does_not_know_the_nodes_all_rests(self):
        self.begin_pulse()
        self.master.kill()
        self.check_all_rests()
        type(self).master = Master(self.master.port)
        self.needle.newest(3 * RATE, position)  # a few questions to the new one
        self.check_all_rests()


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "master", MasterTest)
