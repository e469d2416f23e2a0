#!/usr/bin/python3
"""phantom_omni's messages become the bridge's, in metres; its force falls to zero when anything is silent."""

import math

import numpy as np
import rospy
import rostest

from foreign_messages import OmniButtonEvent, OmniFeedback, OmniState
from haptic_driver import CLUTCH, FORCE, PRESENT, HapticTest, Received
from messages import wrench

STATE = "/phantom/state"


def state(x, y, z, locked=False):
    """mm"""
    message = OmniState()
    message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
    message.pose.orientation.w = 1
    message.locked = locked
    return message


class OmniTest(HapticTest):
    driver = {STATE: OmniState}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.feedback = Received("/phantom/force_feedback", OmniFeedback)
        cls.buttons = rospy.Publisher("/phantom/button", OmniButtonEvent, queue_size=10, latch=True)

    def good(self):
        return {STATE: state(10, 20, -30), FORCE: wrench(0.1, 0.2, -0.3, "haptic")}

    def check_force(self, wanted, messages):
        self.until(lambda: len(self.feedback.messages) and np.array_equal(self.feedback.forces()[-1], wanted), messages,
                   f"no force {wanted}")

    def check_zero_and_stays(self, messages):
        """Within the time-outs the force is zero, is said again and again, and stays so."""
        self.check_force([0.1, 0.2, -0.3], self.good)
        self.world.run(100, messages)
        self.check_force([0, 0, 0], messages)
        before = len(self.feedback.messages)
        self.until(lambda: len(self.feedback.messages) > before + 20, messages, "zero force is not repeated")
        np.testing.assert_array_equal(self.feedback.forces()[before:], 0)

    def test_millimetres_become_metres(self):
        self.world.run(5, self.good)
        np.testing.assert_allclose(self.hand(), [0.01, 0.02, -0.03], rtol=1e-12)

    def press(self, grey, white):
        self.buttons.publish(OmniButtonEvent(grey_button=grey, white_button=white))
        self.until(lambda: PRESENT in self.world.seen and self.seen(PRESENT).buttons[0] == white
                   and self.seen(CLUTCH).buttons[0] == grey, self.good, f"not clutch {grey} and operator {white}")

    def test_the_force_is_the_drivers_own_message(self):
        self.check_force([0.1, 0.2, -0.3], self.good)
        self.feedback.check_type(self, OmniFeedback)

    def test_buttons_are_kept_until_they_change(self):
        for grey, white in ((1, 0), (0, 1), (1, 1), (0, 0)):
            self.press(grey, white)
            self.world.run(1000, self.good)
            self.assertEqual((self.seen(CLUTCH).buttons[0], self.seen(PRESENT).buttons[0]), (grey, white))

    def test_the_operator_of_a_device_that_was_silent_presses_again(self):
        self.press(0, 1)
        self.world.run(100, lambda: {FORCE: wrench(0, 0, 0)})
        self.assertEqual(self.seen(PRESENT).buttons[0], 0)
        self.world.run(100, self.good)
        self.assertEqual(self.seen(PRESENT).buttons[0], 0)
        self.press(0, 0)
        self.press(0, 1)

    def test_the_lock_that_each_press_turns_over_is_no_clutch(self):
        """The driver turns `locked` over at each press of the white button: locked at every second one."""
        locked = False
        for _ in range(3):
            locked = not locked
            told = lambda: {**self.good(), STATE: state(10, 20, -30, locked)}
            self.buttons.publish(OmniButtonEvent(white_button=1))
            self.until(lambda: PRESENT in self.world.seen and self.seen(PRESENT).buttons[0] == 1, told, "no operator")
            self.world.run(50, told)
            self.assertEqual((self.seen(CLUTCH).buttons[0], self.seen(PRESENT).buttons[0]), (0, 1))
            self.buttons.publish(OmniButtonEvent())
            self.until(lambda: self.seen(PRESENT).buttons[0] == 0, told, "the operator stays")

    def test_without_a_fresh_force_none_is_rendered(self):
        self.check_zero_and_stays(lambda: {STATE: state(0, 0, 0)})
        self.check_zero_and_stays(lambda: {**self.good(), FORCE: wrench(math.nan, 0, 0)})

    def test_a_silent_or_senseless_device_gets_no_force(self):
        self.check_zero_and_stays(lambda: {FORCE: wrench(0.1, 0.2, -0.3)})
        self.check_silent()
        self.check_zero_and_stays(lambda: {**self.good(), STATE: state(math.inf, 0, 0)})
        self.check_silent()


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_omni", OmniTest)
