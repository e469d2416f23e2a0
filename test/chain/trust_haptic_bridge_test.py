#!/usr/bin/python3
"""The bridge renders zero force and withdraws its target while hand, needle or force is not valid."""

import math
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from cell_microinjection.msg import InjectionStatus
from messages import force, pose, wrench
from participant import INVALID, Participant


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant(
            {"/haptic/measured_cp": PoseStamped, "/haptic/clutch": Joy, "/needle/measured_cp": PoseStamped,
             "/cell/predicted_cf": WrenchStamped, "/controller/injection_state": InjectionStatus},
            {"/haptic/servo_cf": WrenchStamped, "/teleop/servo_cp": PoseStamped})

    def good(self):
        return {"/haptic/measured_cp": pose(0, 0, 0, "haptic"), "/needle/measured_cp": pose(0, 0, 25e-6),
                "/cell/predicted_cf": wrench(0, 0, 1e-6), "/controller/injection_state": InjectionStatus()}

    def check_open(self, bad, why):
        """`bad` replaces messages; None: silence."""
        self.world.run(200, self.good)
        np.testing.assert_allclose(force(self.world.seen["/haptic/servo_cf"]), [0, 0, 0.2], rtol=1e-12)
        self.assertFalse(self.world.seen["/teleop/servo_cp"].header.stamp.is_zero())
        merged = {**self.good(), **bad}
        level, text = self.world.run_to_status(
            "haptic_bridge: loop", 300,
            lambda: {topic: message for topic, message in merged.items() if message is not None})
        np.testing.assert_array_equal(force(self.world.seen["/haptic/servo_cf"]), 0)
        self.assertTrue(self.world.seen["/teleop/servo_cp"].header.stamp.is_zero())
        self.assertNotEqual(level, 0)
        self.assertIn(why, text)

    def test_hand(self):
        self.check_open({"/haptic/measured_cp": None}, "no valid hand position")
        self.check_open({"/haptic/measured_cp": pose(math.nan, 0, 0)}, "no valid hand position")

    def test_needle(self):
        self.check_open({"/needle/measured_cp": None}, "no valid needle position")
        self.check_open({"/needle/measured_cp": pose(0, 0, math.inf)}, "no valid needle position")

    def test_controller(self):
        self.check_open({"/controller/injection_state": None}, "the controller is silent")

    def test_clutch_that_cannot_be_read(self):
        self.world.tick({**self.good(), "/haptic/clutch": Joy(buttons=[0])})
        self.world.tick({**self.good(), "/haptic/clutch": INVALID})
        self.world.run(200, self.good)
        self.assertTrue(self.world.seen["/teleop/servo_cp"].header.stamp.is_zero())
        self.world.tick({**self.good(), "/haptic/clutch": Joy(buttons=[0])})

    def test_force(self):
        self.check_open({"/cell/predicted_cf": INVALID}, "no valid force")
        self.check_open({"/cell/predicted_cf": None}, "no valid force")
        self.check_open({"/cell/predicted_cf": wrench(0, math.nan, 0)}, "no valid force")
        self.check_open({"/cell/predicted_cf": wrench(0, 0, 1e-6, "camera")}, "no valid force")


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_haptic_bridge", TrustTest)
