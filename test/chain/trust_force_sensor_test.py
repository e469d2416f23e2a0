#!/usr/bin/python3
"""The force sensor has no reading of a force that it cannot trust, and reads along and across the pipette otherwise."""

import math
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped

from messages import force, pose, wrench
from participant import Participant


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/needle/measured_cp": PoseStamped, "/cell/predicted_cf": WrenchStamped},
                                {"/force_sensor/measured_cf": WrenchStamped})

    def messages(self, predicted, tilt=0.0):
        needle = pose(0, 0, 25e-6)
        needle.pose.orientation.y, needle.pose.orientation.w = math.sin(tilt / 2), math.cos(tilt / 2)
        both = {"/needle/measured_cp": needle, "/cell/predicted_cf": predicted}
        return {topic: message for topic, message in both.items() if message is not None}

    def reading(self):
        return self.world.seen["/force_sensor/measured_cf"]

    def test_axes_turn_with_the_pipette(self):
        self.world.run(100, self.messages(wrench(0, 0, 100e-6), tilt=math.pi / 6))
        self.assertEqual(self.reading().header.frame_id, "needle_tip")
        axial, lateral = 100e-6 * math.cos(math.pi / 6), -100e-6 * math.sin(math.pi / 6)
        expected = [lateral + 0.02 * axial, 0, axial + 0.02 * lateral]  # with the cross-axis share of 2 %
        np.testing.assert_allclose(force(self.reading()), expected, atol=6 * 240e-9)

    def test_no_reading_of_what_it_cannot_trust(self):
        for bad in (None, wrench(0, 0, math.nan), wrench(0, 0, 1e-6, "camera")):
            self.world.run(100, self.messages(wrench(0, 0, 1e-6)))
            self.assertFalse(self.reading().header.stamp.is_zero())
            self.world.run(1200, self.messages(bad))
            self.assertTrue(self.reading().header.stamp.is_zero())
            level, text = self.world.status("force_sensor: sensor")
            self.assertNotEqual(level, 0)
            self.assertIn("no trusted force", text)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_force_sensor", TrustTest)
