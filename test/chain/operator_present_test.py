#!/usr/bin/python3
"""With require_operator the needle follows only while the device says that the operator is there; each input has its
own time-out."""

import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from cell_microinjection.msg import InjectionStatus
from case import case
from messages import force, pose, wrench
from participant import INVALID, Participant

HAND, CLUTCH, PRESENT = "/haptic/measured_cp", "/haptic/clutch", "/haptic/operator_present"
NEEDLE, PREDICTED, CONTROLLER = "/needle/measured_cp", "/cell/predicted_cf", "/controller/injection_state"


class PresentCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({HAND: PoseStamped, CLUTCH: Joy, PRESENT: Joy, NEEDLE: PoseStamped,
                                 PREDICTED: WrenchStamped, CONTROLLER: InjectionStatus},
                                {"/haptic/servo_cf": WrenchStamped, "/teleop/servo_cp": PoseStamped})

    def good(self, present=1):
        return {HAND: pose(0, 0, 0, "haptic"), CLUTCH: Joy(buttons=[0]), PRESENT: Joy(buttons=[present]),
                NEEDLE: pose(0, 0, 25e-6), PREDICTED: wrench(0, 0, 1e-6), CONTROLLER: InjectionStatus()}

    def follows(self):
        return not self.world.seen["/teleop/servo_cp"].header.stamp.is_zero()

    def setUp(self):
        self.world.run(200, self.good)
        self.assertTrue(self.follows())


class OperatorPresentTest(PresentCase):
    def run_without(self, ticks, *topics):
        self.world.run(ticks, lambda: {key: value for key, value in self.good().items() if key not in topics})

    def test_absent(self):
        self.world.run(200, lambda: self.good(present=0))
        self.assertFalse(self.follows())
        self.assertEqual(list(force(self.world.seen["/haptic/servo_cf"])), [0, 0, 0])

    def test_what_cannot_be_read_is_no_operator(self):
        for bad in (Joy(), INVALID):
            self.world.run(200, self.good)
            self.world.run(200, lambda: {**self.good(), PRESENT: bad})
            self.assertFalse(self.follows())

    def test_every_combination_of_clutch_and_operator(self):
        silent = object()
        for clutch in (0, 1, Joy(), INVALID, silent):
            for present in (1, 0, Joy(), INVALID, silent):
                with case(clutch, present):
                    self.world.run(20, self.good)
                    self.assertTrue(self.follows())
                    told = {CLUTCH: clutch, PRESENT: present}
                    for topic, what in told.items():
                        told[topic] = Joy(buttons=[what]) if isinstance(what, int) else what
                    merged = {**self.good(), **told}
                    self.world.run(120, lambda: {topic: what for topic, what in merged.items() if what is not silent})
                    self.assertEqual(self.follows(), clutch == 0 and present == 1)

    def test_each_input_is_stale_after_its_own_time(self):
        for topic, timeout in ((PRESENT, 100), (CLUTCH, 100), (HAND, 50), (NEEDLE, 50), (PREDICTED, 300),
                               (CONTROLLER, 250)):
            with case(topic):
                self.world.run(200, self.good)
                self.run_without(timeout - 5, topic)
                self.assertTrue(self.follows())
                self.run_without(15, topic)
                self.assertFalse(self.follows())


class OnChangeTest(PresentCase):
    """A CRTK driver of a device with pedals: config/haptic/external.yaml."""

    def quiet(self, *topics):
        return {key: value for key, value in self.good().items() if key not in (CLUTCH, PRESENT, *topics)}

    def test_what_was_told_last_holds(self):
        self.world.run(2000, self.quiet)
        self.assertTrue(self.follows())
        self.world.tick({**self.quiet(), PRESENT: Joy(buttons=[0])})
        self.world.run(20, self.quiet)
        self.assertFalse(self.follows())

    def test_but_not_past_a_pose_that_was_stale(self):
        self.world.run(200, lambda: self.quiet(HAND))
        self.world.run(500, self.quiet)
        self.assertFalse(self.follows())

    def test_a_tap_leaves_no_button_held_down(self):
        for tapped in (2, 3):
            for topic, follows in ((CLUTCH, True), (PRESENT, False)):
                with case(topic, tapped):
                    self.world.run(200, self.good)
                    self.world.tick({**self.quiet(), topic: Joy(buttons=[tapped])})
                    self.world.run(20, self.quiet)
                    self.assertEqual(self.follows(), follows)


if __name__ == "__main__":
    rospy.init_node("world")
    device = rospy.myargv()[1]
    rostest.rosrun("cell_microinjection", f"operator_present_{device}",
                   {"repeats": OperatorPresentTest, "changes": OnChangeTest}[device])
