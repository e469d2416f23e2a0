#!/usr/bin/python3
"""ros_geomagic's messages become the bridge's; the force has the three locks that its driver reads."""

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Joy

from foreign_messages import DeviceFeedback
from haptic_driver import CLUTCH, FORCE, PRESENT, HapticTest, Received
from messages import pose, wrench

POSE, JOY = "/Geomagic/pose", "/Geomagic/joy"


class GeomagicTest(HapticTest):
    driver = {POSE: PoseStamped, JOY: Joy}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.feedback = Received("/Geomagic/force_feedback", DeviceFeedback)

    def good(self, grey=0, white=0):
        return {POSE: pose(10, 20, -30), JOY: Joy(buttons=[grey, white]), FORCE: wrench(0.1, 0.2, -0.3, "haptic")}

    def check_force(self, wanted, messages):
        self.until(lambda: len(self.feedback.messages) and np.array_equal(self.feedback.forces()[-1], wanted), messages,
                   f"no force {wanted}")

    def test_millimetres_become_metres(self):
        self.world.run(5, self.good)
        np.testing.assert_allclose(self.hand(), [0.01, 0.02, -0.03], rtol=1e-12)

    def test_the_force_is_the_drivers_own_message_with_three_locks(self):
        self.check_force([0.1, 0.2, -0.3], self.good)
        self.feedback.check_type(self, DeviceFeedback)
        self.assertEqual(list(self.feedback.messages[-1].lock), [False, False, False])

    def buttons(self):
        return self.seen(CLUTCH).buttons[0], self.seen(PRESENT).buttons[0]

    def test_clutch_and_operator(self):
        for grey, white in ((1, 0), (0, 1), (1, 1), (0, 0), (0, 1)):
            self.world.run(50, lambda: self.good(grey, white))
            self.assertEqual(self.buttons(), (grey, white))
        # Buttons that are silent or missing: the clutch counts as pressed, the dead-man as let go.
        self.world.run(200, lambda: {POSE: pose(0, 0, 0)})
        self.assertEqual(self.buttons(), (1, 0))
        self.world.run(50, lambda: self.good(0, 1))
        self.assertEqual(self.buttons(), (0, 1))
        self.world.run(50, lambda: {**self.good(), JOY: Joy()})
        self.assertEqual(self.buttons(), (1, 0))

    def test_without_device_or_force_none_is_rendered(self):
        for silent in (POSE, FORCE):
            self.check_force([0.1, 0.2, -0.3], self.good)
            rest = lambda: {topic: message for topic, message in self.good().items() if topic != silent}
            self.world.run(200, rest)
            self.check_force([0, 0, 0], rest)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_geomagic", GeomagicTest)
