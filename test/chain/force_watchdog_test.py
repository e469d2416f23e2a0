#!/usr/bin/python3
"""A haptic device gets zero force, again and again, when its bridge or adapter is silent, and only then."""

import time
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from rosgraph_msgs.msg import Clock

from foreign_messages import DeviceFeedback, OmniFeedback
from messages import wrench
from participant import PATIENCE

TOPICS = {"crtk": ("/haptic/servo_cf", WrenchStamped), "omni": ("/phantom/force_feedback", OmniFeedback),
          "geomagic": ("/Geomagic/force_feedback", DeviceFeedback), "dvrk": ("/MTMR/body/servo_cf", WrenchStamped)}
TIMEOUT = 0.05  # s, the node's default


def vector(message):
    """@returns the force of any kind of message (N)."""
    vector3 = message.wrench.force if isinstance(message, WrenchStamped) else message.force
    return [vector3.x, vector3.y, vector3.z]


class ForceWatchdogTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.zeros = []  # what the watchdog said
        cls.now = rospy.Time(100)
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=10, latch=True)
        cls.device = rospy.myargv()[1]
        topic, cls.kind = TOPICS[cls.device]
        cls.bridge = rospy.Publisher(topic, cls.kind, queue_size=10)
        rospy.Subscriber(topic, cls.kind, cls.hear)
        cls.clock.publish(cls.now)

    @classmethod
    def hear(cls, message):
        if message._connection_header["callerid"] == "/force_watchdog":
            cls.zeros.append(message)

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.01)

    def go_on(self, seconds):
        type(self).now += rospy.Duration(seconds)
        self.clock.publish(self.now)

    def quiet(self, seconds):
        """Nothing of the watchdog's within `seconds` (s) of the wall's time."""
        before = len(self.zeros)
        # In many parts: what has come while this process stood still is read between two of them.
        for _ in range(round(seconds / 0.01)):
            time.sleep(0.01)
        return len(self.zeros) == before

    def check_zero_again_and_again(self):
        before = len(self.zeros)
        self.until(lambda: len(self.zeros) > before + 20, "no zero force")
        for message in self.zeros[before:]:
            np.testing.assert_array_equal(vector(message), 0)
            if self.kind is DeviceFeedback:
                self.assertEqual(len(message.lock), 3, "its driver reads three without asking")

    def pressing(self):
        if self.kind is WrenchStamped:
            return wrench(0, 0, 1.5, "haptic")
        message = self.kind()
        message.force.z = 1.5
        return message

    def test_zero_only_while_the_bridge_is_silent(self):
        if self.device == "dvrk":
            self.assertTrue(self.quiet(0.5), "the first force of all frees an arm, which nothing holds yet")
        else:
            self.check_zero_again_and_again()  # there is no bridge yet
        self.until(lambda: self.bridge.get_num_connections() > 1, "nobody hears the bridge")
        for _ in range(3):
            self.bridge.publish(self.pressing())  # and time stands still
            self.until(lambda: self.quiet(0.2), "it talks across the bridge")
            self.go_on(0.9 * TIMEOUT)
            self.assertTrue(self.quiet(0.2), "it is impatient")
            self.go_on(0.2 * TIMEOUT)
            self.check_zero_again_and_again()
            if self.kind is WrenchStamped:
                self.assertEqual(self.zeros[-1].header.frame_id, "haptic")
                self.assertEqual(self.zeros[-1].header.stamp, self.now)


if __name__ == "__main__":
    rospy.init_node("bridge")
    rostest.rosrun("cell_microinjection", f"force_watchdog_{rospy.myargv()[1]}", ForceWatchdogTest)
