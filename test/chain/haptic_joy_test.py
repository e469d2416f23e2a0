#!/usr/bin/python3
"""A joystick's deflection becomes a place of the hand; the operator is there while the held stick was let go first."""

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import Joy

from haptic_driver import HAND, PRESENT, HapticTest


def joy(x=0, y=0, z=0, held=True, button=None):
    """config/haptic/joy.yaml"""
    message = Joy(axes=[x, y, 0, 0, z, 0], buttons=[0] * 11)
    message.buttons[4] = int(held)
    if button is not None:
        message.buttons[button] = 1
    return {"/joy": message}


class JoyTest(HapticTest):
    driver = {"/joy": Joy}

    def present(self):
        return self.seen(PRESENT).buttons[0]

    def test_deflection(self):
        self.world.run(30, joy)
        self.assertEqual(self.present(), 1)
        self.world.run(30, lambda: joy(1, -0.5, -1))
        np.testing.assert_allclose(self.hand(), [-0.015, -0.0075, -0.015], rtol=1e-6)
        self.assertEqual(self.present(), 1)

    def test_dead_man(self):
        self.world.run(30, joy)
        self.world.run(30, lambda: joy(z=-1, held=False))
        self.assertEqual(self.present(), 0)
        self.world.run(30, lambda: joy(z=-1))  # held again, still deflected
        self.assertEqual(self.present(), 0)

    def test_silence(self):
        self.world.run(30, joy)
        self.world.run(100, joy(z=-1))
        self.world.run(250)
        self.check_silent()
        self.world.run(30, lambda: joy(z=-1))
        self.assertFalse(self.seen(HAND).header.stamp.is_zero())
        self.assertEqual(self.present(), 0)

    def test_a_button_is_a_word_once(self):
        self.world.run(30, joy)
        before = len(self.commands)
        self.world.run(30, lambda: joy(button=0))
        self.world.run(30, joy)
        self.world.run(30, lambda: joy(button=1))
        self.until(lambda: len(self.commands) >= before + 2, joy, "no command")
        self.assertEqual(self.commands[before:], ["inject", "home"])


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_joy", JoyTest)
