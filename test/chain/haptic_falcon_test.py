#!/usr/bin/python3
"""A Falcon's adapter: two buttons of one Joy, which must be told again and again."""

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from haptic_driver import CLUTCH, FORCE, PRESENT, HapticTest
from messages import force, pose, wrench

POSITION, JOY, RENDERED = "/falcon/measured_cp", "/falcon/joy", "/falcon/servo_cf"


class FalconTest(HapticTest):
    driver = {POSITION: PoseStamped, JOY: Joy}
    inputs = {RENDERED: WrenchStamped}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.world.run(10)  # the driver says nothing yet
        cls.first = cls.world.seen.get(RENDERED)

    def good(self, *buttons):
        return {POSITION: pose(0.01, 0.02, 0.12, "falcon_front"), JOY: Joy(buttons=[*buttons, 0, 0]),
                FORCE: wrench(0.1, 0.2, -0.3, "haptic")}

    def told(self):
        return self.seen(CLUTCH).buttons[0], self.seen(PRESENT).buttons[0]

    def test_buttons(self):
        for present, clutch in ((1, 0), (1, 1), (0, 1), (0, 0), (1, 0)):
            self.world.run(30, lambda: self.good(present, clutch))
            self.assertEqual(self.told(), (clutch, present))
        # Silent or missing: the clutch counts as pressed, the dead-man as let go.
        for bad in ({}, {JOY: Joy(buttons=[])}):
            self.world.run(30, lambda: self.good(1, 0))
            self.assertEqual(self.told(), (0, 1))
            self.world.run(100, lambda: {POSITION: pose(0, 0, 0.12, "falcon_front"), **bad})
            self.assertEqual(self.told(), (1, 0))

    def test_zero_force_is_said_before_the_driver_says_anything(self):
        """It holds the last one for ever, which may be that of an adapter before this one."""
        self.assertIsNotNone(self.first)
        np.testing.assert_array_equal(force(self.first), 0)

    def test_the_force_is_in_the_drivers_frame(self):
        """It takes no other."""
        self.world.run(30, lambda: self.good(1, 0))
        np.testing.assert_array_equal(force(self.seen(RENDERED)), [0.1, 0.2, -0.3])
        self.assertEqual(self.seen(RENDERED).header.frame_id, "falcon_front")


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_falcon", FalconTest)
