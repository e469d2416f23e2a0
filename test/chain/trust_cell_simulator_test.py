#!/usr/bin/python3
"""The cell simulator has no force for a needle pose that it cannot trust, and says so."""

import math
import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import CellState
from geometry_msgs.msg import PoseStamped, WrenchStamped

from messages import force, pose
from participant import INVALID, Participant


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/needle/measured_cp": PoseStamped},
                                {"/cell/predicted_cf": WrenchStamped, "/cell/state": CellState})

    def needle(self, z=25e-6, frame="world"):
        return {"/needle/measured_cp": pose(0, 0, z, frame)}

    def press(self):
        for step in range(300):
            self.world.tick(self.needle(31e-6 - step * 0.02e-6))
        self.world.run(50, self.needle)
        predicted = self.world.seen["/cell/predicted_cf"]
        self.assertGreater(force(predicted)[2], 0.2e-6)
        self.assertFalse(predicted.header.stamp.is_zero())

    def check_untrusted(self, messages):
        self.press()
        level, text = self.world.run_to_status("cell_simulator: solver", 300, messages)
        predicted = self.world.seen["/cell/predicted_cf"]
        self.assertTrue(predicted.header.stamp.is_zero())
        np.testing.assert_array_equal(force(predicted), 0)
        self.assertFalse(self.world.seen["/cell/state"].converged)
        self.assertNotEqual(level, 0)
        self.assertIn("no valid needle pose", text)

    def test_stale(self):
        self.check_untrusted({})

    def test_invalid(self):
        self.check_untrusted({"/needle/measured_cp": INVALID})

    def test_not_finite(self):
        self.check_untrusted(lambda: self.needle(math.nan))

    def test_infinite(self):
        self.check_untrusted(lambda: self.needle(-math.inf))

    def test_other_frame(self):
        self.check_untrusted(lambda: self.needle(frame="camera"))

    def test_recovers(self):
        self.check_untrusted(lambda: self.needle(math.nan))
        self.press()


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_cell_simulator", TrustTest)
