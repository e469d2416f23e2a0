#!/usr/bin/python3
"""The bridge renders zero force and withdraws its target while hand, needle or force is not valid."""

import math
import pathlib
import unittest

import numpy as np
import rospy
import rostest
import yaml
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from cell_microinjection.msg import InjectionStatus, OperatingState
from cell_microinjection.srv import CalibrateAxes, CalibrateAxesRequest
from messages import force, pose, wrench
from participant import INVALID, Participant


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant(
            {"/haptic/measured_cp": PoseStamped, "/haptic/clutch": Joy, "/needle/measured_cp": PoseStamped,
             "/cell/predicted_cf": WrenchStamped, "/controller/injection_state": InjectionStatus,
             "/controller/operating_state": OperatingState},
            {"/haptic/servo_cf": WrenchStamped, "/teleop/servo_cp": PoseStamped})

    def good(self):
        return {"/haptic/measured_cp": pose(0, 0, 0, "haptic"), "/needle/measured_cp": pose(0, 0, 25e-6),
                "/cell/predicted_cf": wrench(0, 0, 1e-6), "/controller/injection_state": InjectionStatus()}

    def check_open(self, bad, why):
        """`bad` replaces messages; None: silence."""
        self.world.run(200, self.good)
        np.testing.assert_allclose(force(self.world.seen["/haptic/servo_cf"]), [0, 0, 0.2], rtol=1e-12)
        self.assertFalse(self.world.seen["/teleop/servo_cp"].header.stamp.is_zero())
        merged = {**self.good(), **bad}
        level, text = self.world.run_to_status(
            "haptic_bridge: loop", 300,
            lambda: {topic: message for topic, message in merged.items() if message is not None})
        np.testing.assert_array_equal(force(self.world.seen["/haptic/servo_cf"]), 0)
        self.assertTrue(self.world.seen["/teleop/servo_cp"].header.stamp.is_zero())
        self.assertNotEqual(level, 0)
        self.assertIn(why, text)

    def test_hand(self):
        self.check_open({"/haptic/measured_cp": None}, "no valid hand position")
        self.check_open({"/haptic/measured_cp": pose(math.nan, 0, 0)}, "no valid hand position")

    def test_needle(self):
        self.check_open({"/needle/measured_cp": None}, "no valid needle position")
        self.check_open({"/needle/measured_cp": pose(0, 0, math.inf)}, "no valid needle position")

    def test_controller(self):
        self.check_open({"/controller/injection_state": None}, "the controller is silent")

    def test_clutch_that_cannot_be_read(self):
        self.world.tick({**self.good(), "/haptic/clutch": Joy(buttons=[0])})
        self.world.tick({**self.good(), "/haptic/clutch": INVALID})
        self.world.run(200, self.good)
        self.assertTrue(self.world.seen["/teleop/servo_cp"].header.stamp.is_zero())
        self.world.tick({**self.good(), "/haptic/clutch": Joy(buttons=[0])})

    def test_force(self):
        self.check_open({"/cell/predicted_cf": INVALID}, "no valid force")
        self.check_open({"/cell/predicted_cf": None}, "no valid force")
        self.check_open({"/cell/predicted_cf": wrench(0, math.nan, 0)}, "no valid force")
        self.check_open({"/cell/predicted_cf": wrench(0, 0, 1e-6, "camera")}, "no valid force")


class AxesTest(TrustTest):
    """So does it while the axes of the device are calibrated."""

    def at(self, hand, clutch=0, state="ENABLED"):
        return {"/haptic/measured_cp": pose(*hand, "haptic"), "/needle/measured_cp": pose(0, 0, 25e-6),
                "/cell/predicted_cf": wrench(0, 0, 1e-6), "/controller/injection_state": InjectionStatus(),
                "/controller/operating_state": OperatingState(state=state), "/haptic/clutch": Joy(buttons=[clutch])}

    def step(self, action, hand, **more):
        self.world.run(100, self.at(hand, **more))
        return self.world.call("/haptic_bridge/calibrate_axes", CalibrateAxes, getattr(CalibrateAxesRequest, action),
                               messages=self.at(hand, **more))

    def force_after(self, hand):
        self.world.run(600, self.at(hand))
        return force(self.world.seen["/haptic/servo_cf"])

    def check_held(self, hand):
        np.testing.assert_array_equal(self.force_after(hand), 0)
        self.assertTrue(self.world.seen["/teleop/servo_cp"].header.stamp.is_zero())

    def written(self, answer):
        """The file of the answer, which a thread of the node's own writes, when it has its axes."""
        self.world.run(200, self.at((0, 0, 0)))
        path = pathlib.Path(answer.file)
        for _ in range(3000):
            if path.exists() and f"device_axes: {answer.device_axes}" in path.read_text(encoding="utf-8"):
                break
            rospy.rostime.wallsleep(0.01)
        return yaml.safe_load(path.read_text(encoding="utf-8"))

    def test_a_whole_calibration_and_its_undo(self):
        self.force_after((0, 0, 0))
        answer = self.step("BEGIN", (0, 0, 0))
        self.assertFalse(answer.success)
        self.assertIn("follows the hand", answer.message)
        answer = self.step("BEGIN", (0, 0, 0), clutch=1)
        self.assertEqual((answer.success, answer.next), (True, "right"))
        self.check_held((0, 0, 0))  # with the clutch released
        answer = self.step("MOTION", (0.005, 0, 0))
        self.assertEqual((answer.success, answer.next), (False, "right"))
        self.assertTrue(self.step("MOTION", (0.035, 0.003, 0)).success)
        self.assertTrue(self.step("MOTION", (0.035, 0.003, -0.03)).success)
        self.check_held((0.035, 0.003, -0.03))
        # The clutch is pressed: how many ticks the call takes depends on the machine, and the hand must not lead from there.
        answer = self.step("MOTION", (0.035, 0.033, -0.03), clutch=1)
        self.assertEqual((answer.success, answer.next, answer.device_axes), (True, "", "x -z y"))
        self.assertAlmostEqual(answer.angle_to_axis, math.atan(0.1), 6)
        self.assertEqual(self.written(answer), {"haptic_bridge": {"device_axes": "x -z y"}})
        # Up is now the device's y, and the hand leads again.
        np.testing.assert_allclose(self.force_after((0, 0, 0)), [0, 0.2, 0], atol=1e-12)

        self.assertFalse(self.step("UNDO", (0, 0, 0)).success)
        answer = self.step("UNDO", (0, 0, 0), clutch=1)
        self.assertEqual((answer.success, answer.device_axes), (True, "x y z"))
        self.assertEqual(self.written(answer), {"haptic_bridge": {"device_axes": "x y z"}})
        np.testing.assert_allclose(self.force_after((0, 0, 0)), [0, 0, 0.2], atol=1e-12)

    def test_a_controller_that_is_disabled_lets_it_begin(self):
        self.assertTrue(self.step("BEGIN", (0, 0, 0), state="DISABLED").success)
        self.check_held((0, 0, 0))
        self.assertTrue(self.step("STOP", (0, 0, 0)).success)
        np.testing.assert_allclose(self.force_after((0, 0, 0)), [0, 0, 0.2], atol=1e-12)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_haptic_bridge", AxesTest)
