#!/usr/bin/python3
"""Adapters of haptic devices behind their drivers' own messages, as processes: a hand counts only while its driver takes the
force; type, md5 sum and definition of the messages are the drivers'; the driver gets zero force from an adapter that is asked
to end, and from the watchdog when the adapter was killed. What an adapter does with its messages is in test/nodes/haptic."""

import signal
import threading
import unittest

import genpy.dynamic
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped

from case import case
from foreign_messages import DeviceFeedback, OmniFeedback, OmniState
from killable_nodes import PACKAGE, KillableNodes
from live_chain import Master, until
from messages import pose, wrench

# What the driver tells and what it takes.
DEVICES = {"omni": ("/phantom/state", OmniState, "/phantom/force_feedback", OmniFeedback),
           "geomagic": ("/Geomagic/pose", PoseStamped, "/Geomagic/force_feedback", DeviceFeedback)}
RATE = 200  # Hz
PATIENT = 2.0  # s, in place of the time-outs: more than the machine may stand still
FORCE = (0.1, 0.2, -0.3)  # N, of the bridge
ADAPTER, WATCHDOG = "/haptic_device", "/force_watchdog"
REASON = "/driver does not subscribe to the hand's force, "


class Driver:
    """A device's driver, and the bridge."""

    def __init__(self, kind):
        topic, self._kind, self.topic, self.feedback = DEVICES[kind]
        self.heard = []  # forces
        self._position = rospy.Publisher(topic, self._kind, queue_size=1)
        self._bridge = rospy.Publisher("/haptic/servo_cf", WrenchStamped, queue_size=1)
        self._subscriber = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        while not self._ended.wait(1 / RATE):
            position, force = self._kind(), wrench(*FORCE, "haptic")
            position.pose = pose(10, 20, -30).pose
            position.header.stamp = force.header.stamp = rospy.Time.now()
            self._position.publish(position)
            self._bridge.publish(force)

    def take_forces(self):
        self._subscriber = rospy.Subscriber(self.topic, self.feedback, self.heard.append, queue_size=100)

    def take_none(self):
        if self._subscriber:
            self._subscriber.unregister()
        self._subscriber = None

    def of(self, sender):
        return [message for message in list(self.heard) if message._connection_header["callerid"] == sender]

    def close(self):
        self._ended.set()
        self._thread.join()
        self.take_none()
        self._position.unregister()
        self._bridge.unregister()


def vector(message):
    return message.force.x, message.force.y, message.force.z


class HapticLiveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("driver")

    @classmethod
    def tearDownClass(cls):
        cls.master.kill()

    def begin(self, kind):
        self.driver = Driver(kind)
        self.addCleanup(self.driver.close)
        self.hands, self.said = [], ""
        for topic, message, handle in (("/haptic/measured_cp", PoseStamped, self.hands.append),
                                       ("/diagnostics", DiagnosticArray, self.on_diagnostics)):
            self.addCleanup(rospy.Subscriber(topic, message, handle).unregister)
        config = yaml.safe_load((PACKAGE / f"config/haptic/{kind}.yaml").read_text())
        self.nodes = KillableNodes({
            "haptic_device": {**config["haptic_device"], "timeout": PATIENT, "force_timeout": PATIENT, "diagnostic_period": 0.1},
            "force_watchdog": {**config["force_watchdog"], "kind": kind}})
        self.addCleanup(self.nodes.forget)
        self.addCleanup(self.nodes.stop)

    def on_diagnostics(self, message):
        for status in message.status:
            if status.name == "haptic_device: device":
                self.said = status.message

    def check_follows(self):
        until(lambda: self.hands and not self.hands[-1].header.stamp.is_zero(), "a hand that is followed")

    def check_not_followed(self):
        """Not, for a reason; and so it stays."""
        until(lambda: REASON + self.driver.topic in self.said, f"the reason; it says: {self.said}")
        until(lambda: self.hands and self.hands[-1].header.stamp.is_zero(), "a hand that is not followed")
        count = len(self.hands)
        until(lambda: len(self.hands) > count + 10, "that it is said again and again")
        self.assertTrue(all(hand.header.stamp.is_zero() for hand in self.hands[count:]))

    def check_a_force(self):
        begin = len(self.driver.of(ADAPTER))
        until(lambda: any(vector(message) == FORCE for message in self.driver.of(ADAPTER)[begin:]), "the bridge's force")

    def check_type(self):
        """The publisher's own words: type, md5 sum, and a definition with that md5 sum."""
        message, kind = self.driver.of(ADAPTER)[-1], self.driver.feedback
        header = message._connection_header
        self.assertEqual((header["type"], header["md5sum"]), (kind._type, kind._md5sum))
        told = genpy.dynamic.generate_dynamic(header["type"], header["message_definition"])[kind._type]
        self.assertEqual(told._md5sum, kind._md5sum)
        if kind is DeviceFeedback:
            self.assertEqual(list(message.lock), [False] * 3, "its driver reads three without asking")

    def check_zero_of_the_watchdog(self):
        begin = len(self.driver.of(WATCHDOG))
        until(lambda: len(self.driver.of(WATCHDOG)) > begin + 20, "zero force of the watchdog, again and again")
        self.assertEqual({vector(message) for message in self.driver.of(WATCHDOG)}, {(0, 0, 0)})

    def check_device(self, kind):
        self.begin(kind)
        self.check_not_followed()
        self.driver.take_forces()
        self.check_follows()
        self.driver.take_none()
        self.check_not_followed()
        self.driver.take_forces()
        self.check_a_force()
        self.check_type()
        # SIGHUP: its terminal was closed.
        for number, status in ((signal.SIGTERM, 0), (signal.SIGHUP, 0), (signal.SIGKILL, -signal.SIGKILL)):
            self.assertEqual(self.nodes.kill("haptic_device", number), status)
            if status == 0:
                until(lambda: {vector(message) for message in self.driver.of(ADAPTER)[-3:]} == {(0, 0, 0)},
                      "zero force at the last")
            self.check_zero_of_the_watchdog()
            self.nodes.start("haptic_device")
            self.check_a_force()
            self.check_follows()
        self.assertEqual(self.nodes.dead(), [], self.nodes.report())

    def test_devices(self):
        for kind in DEVICES:
            with case(kind):
                try:
                    self.check_device(kind)
                finally:
                    self.doCleanups()


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "haptic_live", HapticLiveTest)
