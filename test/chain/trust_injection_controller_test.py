#!/usr/bin/python3
"""The controller holds the needle while target, needle or force cannot be trusted, and says so."""

import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped

from cell_microinjection.msg import InjectorState
from messages import pose, position, wrench
from participant import INVALID, Participant

START = 60e-6  # m


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/teleop/servo_cp": PoseStamped, "/needle/measured_cp": PoseStamped,
                                 "/cell/predicted_cf": WrenchStamped, "/injector/state": InjectorState},
                                {"/needle/servo_cp": PoseStamped})

    def setUp(self):
        self.target = self.setpoint() if "/needle/servo_cp" in self.world.seen else START
        self.world.run(300, self.good)
        self.world.run(1000, self.good)  # diagnostics of a good state
        self.assertEqual(self.world.status("injection_controller: control"), (0, "the needle follows"))

    def good(self):
        """A target, a needle that is where it was sent, a force."""
        at = self.setpoint() if "/needle/servo_cp" in self.world.seen else START
        return {"/teleop/servo_cp": pose(0, 0, self.target), "/needle/measured_cp": pose(0, 0, at),
                "/cell/predicted_cf": wrench(0, 0, 0)}

    def setpoint(self):
        return position(self.world.seen["/needle/servo_cp"])[2]

    def check_held(self, bad, why):
        """`bad` replaces messages; None: silence."""
        def messages():
            merged = {**self.good(), **bad}
            return {topic: message for topic, message in merged.items() if message is not None}
        self.world.run(60, messages)  # past the time-out of 50 ms
        held = self.setpoint()
        self.target -= 10e-6
        self.world.run(1200, messages)
        self.assertEqual(self.setpoint(), held)
        level, text = self.world.status("injection_controller: control")
        self.assertNotEqual(level, 0)
        self.assertIn(why, text)
        # Back again: what the target did meanwhile must not be caught up with, what it does now must be followed.
        self.world.run(300, self.good)
        self.assertAlmostEqual(self.setpoint(), held, delta=1e-12)
        self.target -= 2e-6
        self.world.run(300, self.good)
        self.assertAlmostEqual(self.setpoint(), held - 2e-6, delta=1e-12)

    def test_target(self):
        self.check_held({"/teleop/servo_cp": None}, "no trusted target")
        self.check_held({"/teleop/servo_cp": INVALID}, "no trusted target")
        self.check_held({"/teleop/servo_cp": pose(0, 0, math.nan)}, "no trusted target")
        self.check_held({"/teleop/servo_cp": pose(0, 0, 0, "camera")}, "no trusted target")

    def test_force(self):
        self.check_held({"/cell/predicted_cf": None}, "no trusted force")
        self.check_held({"/cell/predicted_cf": wrench(0, 0, math.inf)}, "no trusted force")

    def test_needle(self):
        self.check_held({"/needle/measured_cp": None}, "no trusted needle position")
        self.check_held({"/needle/measured_cp": pose(math.nan, 0, 0)}, "no trusted needle position")

    def test_target_that_leaps(self):
        held = self.setpoint()
        self.target -= 150e-6
        self.world.run(1200, self.good)
        self.assertEqual(self.setpoint(), held)
        self.assertIn("allowed 0.0001 m", self.world.status("injection_controller: control")[1])
        self.target += 150e-6
        self.world.run(300, self.good)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_injection_controller", TrustTest)
