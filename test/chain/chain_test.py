#!/usr/bin/python3
"""Hand to needle to cell to hand: touch is felt with the right sign and size, and what is not valid holds the needle."""

import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rospkg
import rospy
import rostest
from cell_microinjection.msg import CellState, LoopState
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from messages import force, pose, position
from participant import Participant

NODES = pathlib.Path(sys.argv[0]).parent  # this program is found beside them
PACKAGE = rospkg.RosPack().get_path("cell_microinjection")
GAIN = 2e5  # config/haptic_bridge.yaml
SCALE = 1e-3
GAP = 32e-6  # m, from where the needle starts to the cell


class ChainTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Participant(
            {"/haptic/measured_cp": PoseStamped, "/haptic/clutch": Joy},
            {"/haptic/servo_cf": WrenchStamped, "/cell/predicted_cf": WrenchStamped, "/cell/state": CellState,
             "/force_sensor/measured_cf": WrenchStamped, "/needle/measured_cp": PoseStamped})
        cls.z = 0.0  # m, of the hand
        cls.chain.run(150, lambda: cls.hand())  # the loop closes and its ramp is over

    @classmethod
    def hand(cls, x=0.0):
        return {"/haptic/measured_cp": pose(x, 0, cls.z, "haptic")}

    @classmethod
    def move(cls, goal, speed=0.1):
        """Hand to z = goal (m) at a speed (m/s), then a moment's rest."""
        start, ticks = cls.z, max(1, int(abs(goal - cls.z) / speed * 1000))
        for i in range(1, ticks + 1):
            cls.z = start + (goal - start) * i / ticks
            cls.chain.tick(cls.hand())
        cls.chain.run(150, lambda: cls.hand())

    def hand_force(self):
        return force(self.chain.seen["/haptic/servo_cf"])

    def needle(self):
        return position(self.chain.seen["/needle/measured_cp"])

    def press(self, depth=4e-6):
        self.move(-(GAP + depth) / SCALE)

    def test_1_no_force_before_the_touch(self):
        self.move(-(GAP - 1e-6) / SCALE)
        np.testing.assert_allclose(self.needle(), [0, 0, 29e-6], atol=1e-9)
        np.testing.assert_array_equal(self.hand_force(), 0)

    def test_2_touch_is_felt_with_the_right_sign_and_size(self):
        self.press()
        state = self.chain.seen["/cell/state"]
        self.assertTrue(state.in_contact)
        self.assertTrue(state.converged, state.reason)
        self.assertAlmostEqual(state.contact_point.z - state.indentation, self.needle()[2], delta=1e-9)
        expected = self.indent(state.indentation)
        self.assertGreater(expected, 0.3e-6)
        felt = self.hand_force()
        self.assertAlmostEqual(felt[2] / (GAIN * expected), 1, delta=0.01)
        self.assertLess(np.linalg.norm(felt[:2]), 0.05 * felt[2])
        axial = force(self.chain.seen["/force_sensor/measured_cf"])[2]
        self.assertAlmostEqual(axial, expected, delta=0.01 * expected + 8 * 10e-9)  # sensor's noise: 10 nN rms

    def indent(self, depth):
        """Force (N) by the batch tool, which shares the solver but none of the chain."""
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "indent.csv")
            scene = PACKAGE + "/test/chain/coarse_oocyte.yaml"
            subprocess.run([str(NODES / "indent"), "--model", "live", "--scene", scene, "--depths", repr(depth),
                            "--csv", out], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(out, encoding="utf-8") as file:
                return float(next(csv.DictReader(file))["force_z_N"])

    def test_3_retraction_returns_the_force_to_zero(self):
        self.press()
        self.assertGreater(self.hand_force()[2], 0.05)
        self.move(-(GAP - 3e-6) / SCALE)
        np.testing.assert_array_equal(self.hand_force(), 0)
        self.assertFalse(self.chain.seen["/cell/state"].in_contact)

    def check_held(self, messages, why):
        """The hand sends `messages` while it would go deeper: the needle must stay and the hand feel nothing."""
        self.press()
        self.assertGreater(self.hand_force()[2], 0.05)
        self.chain.run(60, messages)  # past the time-out of 50 ms
        held = self.needle()
        type(self).z -= 5e-3
        self.chain.run(1500, messages)
        np.testing.assert_allclose(self.needle(), held, atol=1e-9)
        np.testing.assert_array_equal(self.hand_force(), 0)
        level, text = self.chain.run_to_status("haptic_bridge: loop", 0, messages)
        self.assertNotEqual(level, 0)
        self.assertIn(why, text)
        level, text = self.chain.run_to_status("injection_controller: control", 0, messages)
        self.assertNotEqual(level, 0)
        self.assertIn("needle held", text)
        for topic, part in (("/haptic/loop_state", why), ("/controller/loop_state", "")):
            state = rospy.wait_for_message(topic, LoopState, 30)
            self.assertFalse(state.follows)
            self.assertIn(part, state.hold_reason)
        # The hand is back, 5 mm deeper: the needle must not leap there, the force must not kick.
        self.chain.tick(self.hand())
        self.chain.run(5, lambda: self.hand())
        np.testing.assert_allclose(self.needle(), held, atol=1e-9)
        self.chain.run(200, lambda: self.hand())
        self.assertGreater(self.hand_force()[2], 0.05)
        type(self).z = 0.0  # a new hand, where the needle is: press the clutch and start over
        self.reset()

    def reset(self):
        """Clutch pressed while the hand goes where z = 0 means the needle's start, then released."""
        clutch = Joy(buttons=[1])
        self.chain.tick({**self.hand(), "/haptic/clutch": clutch})
        self.chain.run(20, lambda: self.hand())
        type(self).z = (self.needle()[2] - 60e-6) / SCALE
        self.chain.run(20, lambda: self.hand())
        clutch.buttons = [0]
        self.chain.tick({**self.hand(), "/haptic/clutch": clutch})
        self.chain.run(150, lambda: self.hand())
        self.move(0.0)

    def test_4_a_silent_hand_holds_the_needle(self):
        self.check_held({}, "no valid hand position")

    def test_5_a_hand_that_is_not_finite_holds_the_needle(self):
        self.check_held(lambda: {"/haptic/measured_cp": pose(0, math.nan, self.z, "haptic")}, "no valid hand position")

    def test_6_clutch_moves_the_hand_alone(self):
        self.move(-10e-3)
        before = self.needle()
        self.chain.tick({**self.hand(), "/haptic/clutch": Joy(buttons=[1])})
        self.move(0.0)
        np.testing.assert_allclose(self.needle(), before, atol=1e-9)
        self.chain.tick({**self.hand(), "/haptic/clutch": Joy(buttons=[0])})
        self.chain.run(5, lambda: self.hand())
        np.testing.assert_allclose(self.needle(), before, atol=1e-9)
        self.move(10e-3)
        np.testing.assert_allclose(self.needle(), before + [0, 0, 10e-6], atol=1e-9)


if __name__ == "__main__":
    rospy.init_node("hand")
    rostest.rosrun("cell_microinjection", "chain", ChainTest)
