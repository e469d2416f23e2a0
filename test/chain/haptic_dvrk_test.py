#!/usr/bin/python3
"""A dVRK arm's adapter: switches before any force, its state, taps, and zero force when anything is silent. With the
argument transform its positions are transforms, as before 2022."""

import math
import sys

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TransformStamped, WrenchStamped
from sensor_msgs.msg import Joy
from std_msgs.msg import Bool

from case import case
from cell_microinjection.msg import OperatingState
from haptic_driver import CLUTCH, FORCE, PRESENT, HapticTest
from messages import force, pose, transform, wrench

ARM, FOOT, HEAD, STATE = "/MTMR/measured_cp", "/console/clutch", "/console/operator_present", "/MTMR/operating_state"
RENDERED = "/MTMR/body/servo_cf"
KIND, PLACE = (TransformStamped, transform) if "transform" in sys.argv else (PoseStamped, pose)
SETTINGS = ("/MTMR/body/set_cf_orientation_absolute", "/MTMR/use_gravity_compensation")


def state(name="ENABLED", homed=True):
    return OperatingState(state=name, is_homed=homed)


class DvrkTest(HapticTest):
    driver = {ARM: KIND, FOOT: Joy, HEAD: Joy, STATE: OperatingState}
    inputs = {RENDERED: WrenchStamped}

    @classmethod
    def setUpClass(cls):
        cls.set_ = {}
        cls.switches = [rospy.Subscriber(topic, Bool, lambda message, topic=topic: cls.set_.update({topic: message.data}))
                        for topic in SETTINGS]
        super().setUpClass()
        # Who the driver is shows by its positions only: it cannot be known yet whether it has heard its settings.
        cls.world.run(300, {FORCE: wrench(0.1, 0.2, -0.3, "haptic")})
        cls.before_its_settings = cls.world.seen.get(RENDERED)

    def arm(self):
        """Buttons and state are told on change only."""
        return {ARM: PLACE(0.01, 0.02, -0.03, "HRSV"), FORCE: wrench(0.1, 0.2, -0.3, "haptic")}

    def told(self):
        return self.seen(CLUTCH).buttons[0], self.seen(PRESENT).buttons[0]

    def begin(self):
        self.world.run(300, self.arm)
        self.world.tick({**self.arm(), FOOT: Joy(buttons=[0]), HEAD: Joy(buttons=[1]), STATE: state()})
        self.world.run(30, self.arm)

    def setUp(self):
        self.begin()
        self.assertEqual(self.told(), (0, 1))
        np.testing.assert_array_equal(self.rendered(), [0.1, 0.2, -0.3])

    def rendered(self):
        return force(self.seen(RENDERED))

    def test_no_force_is_said_before_its_settings(self):
        """Not even zero: the first one frees the arm, which would then fall."""
        self.assertIsNone(self.before_its_settings)

    def test_both_switches_are_set(self):
        self.until(lambda: len(self.set_) == len(SETTINGS), self.arm, "not both settings")
        self.assertEqual(self.set_, dict.fromkeys(SETTINGS, True))

    def test_position_and_frame(self):
        np.testing.assert_allclose(self.hand(), [0.01, 0.02, -0.03], rtol=1e-12)
        self.assertEqual(self.seen(RENDERED).header.frame_id, "HRSV")

    def test_a_tap_holds_nothing_down(self):
        for topic, place in ((FOOT, 0), (HEAD, 1)):
            with case(topic):
                self.begin()
                self.world.tick({**self.arm(), topic: Joy(buttons=[2])})
                self.world.run(30, self.arm)
                self.assertEqual(self.told()[place], 0)

    def test_buttons_hold_until_they_change_but_not_past_a_silent_pose(self):
        self.world.run(2000, self.arm)
        self.assertEqual(self.told(), (0, 1))
        self.world.run(200, lambda: {FORCE: wrench(0.1, 0.2, -0.3)})
        self.check_silent()
        self.world.run(200, self.arm)
        self.assertEqual(self.told(), (0, 0))

    def test_an_arm_that_takes_no_force_has_no_hand(self):
        for bad in (state("DISABLED"), state("PAUSED"), state("FAULT"), state(homed=False)):
            with case(bad.state, bad.is_homed):
                self.begin()
                self.world.tick({**self.arm(), STATE: bad})
                self.world.run(100, self.arm)
                self.check_silent()
                np.testing.assert_array_equal(self.rendered(), 0)

    def test_without_a_fresh_force_or_a_sensible_arm_none_is_rendered(self):
        for name, bad in (("silent bridge", lambda: {ARM: PLACE(0, 0, 0)}), ("silent arm", lambda: {FORCE: wrench(1, 0, 0)}),
                          ("no number", lambda: {**self.arm(), FORCE: wrench(math.nan, 0, 0)}),
                          ("no place", lambda: {**self.arm(), ARM: PLACE(math.inf, 0, 0)})):
            with case(name):
                self.begin()
                self.world.run(200, bad)
                np.testing.assert_array_equal(self.rendered(), 0)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_dvrk", DvrkTest)
