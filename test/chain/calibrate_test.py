#!/usr/bin/python3
"""The action calibration/calibrate finds scale, angle and backlash of a simulated rig from its images; what must not
move, does not."""

import pathlib
import time
import unittest

import actionlib
import numpy as np
import rospy
import rostest
import yaml
from actionlib_msgs.msg import GoalStatus
from cell_microinjection.msg import (CalibrateAction, CalibrateGoal, GoToPixelAction, GoToPixelGoal, OperatingState,
                                     StringStamped, VisionState)
from geometry_msgs.msg import Point, PointStamped, PoseStamped
from std_srvs.srv import Trigger

PATIENCE = 300  # s
PIXEL, BACKLASH = 0.25e-6, 2e-6  # m, of config/microscope.yaml and the test's rig
FIELD_X, FIELD_Z = 60e-6, 45e-6  # m
SETTLE = 1.0  # s, several times what config/calibration.yaml asks


class CalibrateTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.seen, cls.places, cls.moved = {}, [], rospy.Time()
        for topic, kind in (("/needle/operating_state", OperatingState), ("/controller/operating_state", OperatingState),
                            ("/vision/state", VisionState)):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.seen.update({topic: message}), queue_size=1)
        rospy.Subscriber("/needle/measured_cp", PoseStamped,
                         lambda message: cls.add_place(message), queue_size=1)
        cls.needle = rospy.Publisher("/needle/state_command", StringStamped, queue_size=1)
        cls.controller = rospy.Publisher("/controller/state_command", StringStamped, queue_size=1)
        cls.action = actionlib.SimpleActionClient("/calibration/calibrate", CalibrateAction)
        assert cls.action.wait_for_server(rospy.Duration(PATIENCE))
        cls.rezero = staticmethod(rospy.ServiceProxy("/calibration/rezero", Trigger))
        cls.undo = staticmethod(rospy.ServiceProxy("/calibration/undo", Trigger))

    @classmethod
    def add_place(cls, message):
        place = message.pose.position.x, message.pose.position.z
        if not cls.places or np.hypot(*np.subtract(place, cls.rested_at)) > 0.1e-6:
            cls.moved, cls.rested_at = message.header.stamp, place
        cls.places.append(place)

    def rests(self):
        """The tip is seen in an image since which the needle has long settled."""
        return self.tip_is_seen() and self.seen["/vision/state"].header.stamp > self.moved + rospy.Duration(SETTLE)

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            time.sleep(0.05)

    def command(self, publisher, topic, command, state):
        def reached():
            message = self.seen.get(topic)
            if message and message.state == state:
                return True
            publisher.publish(StringStamped(string=command))
            time.sleep(0.2)
            return False
        self.until(reached, f"{topic} {state}")

    def goal(self, field_x=FIELD_X, field_z=FIELD_Z):
        self.action.send_goal(CalibrateGoal(field_x=field_x, field_z=field_z))

    def result(self):
        self.assertTrue(self.action.wait_for_result(rospy.Duration(PATIENCE)))
        return self.action.get_result()

    def setUp(self):
        self.command(self.controller, "/controller/operating_state", "disable", "DISABLED")
        self.command(self.needle, "/needle/operating_state", "enable", "ENABLED")
        self.until(self.tip_is_seen, "the tip")
        self.until(lambda: self.places, "the needle")
        # Those of the needle are heard by the manipulator and by the calibration, which ends with them.
        self.until(lambda: self.needle.get_num_connections() >= 2 and self.controller.get_num_connections(),
                   "listeners to the commands")

    def tip_is_seen(self):
        state = self.seen.get("/vision/state")
        return state and state.injection_pipette.verdict == state.injection_pipette.FOUND

    def test_finds_scale_angle_and_backlash(self):
        lowest, begin = self.places[-1][1], len(self.places)
        self.goal()
        result = self.result()
        self.assertTrue(result.success, result.message)
        self.assertGreaterEqual(min(place[1] for place in self.places[begin:]), lowest - 1e-8)  # never below where it began
        self.assertAlmostEqual(result.pixel_size / PIXEL, 1, delta=1e-3)
        self.assertLess(result.pixel_size_interval, 2e-3 * PIXEL)
        self.assertAlmostEqual(np.degrees(result.angle), 0, delta=0.1)
        self.assertFalse(result.mirrored)
        for axis in (0, 2):
            self.assertAlmostEqual(result.backlash[axis], BACKLASH, delta=0.3e-6)
        path = pathlib.Path(rospy.get_param("/calibration/file"))
        written = yaml.safe_load(path.read_text())
        self.assertAlmostEqual(written["parameters"]["pixel_size"]["value"], result.pixel_size, delta=1e-12)
        self.assertFalse(self.undo().success)  # it has replaced none
        calibrated = path.read_text()
        self.until(self.rests, "an image of the resting needle")
        answer = self.rezero()
        self.assertTrue(answer.success, answer.message)
        rezeroed = path.read_text()
        self.assertNotEqual(rezeroed, calibrated)
        for expected in (calibrated, rezeroed, calibrated):
            answer = self.undo()
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(path.read_text(), expected)
        self.check_go_to_pixel()

    def check_go_to_pixel(self):
        servo = actionlib.SimpleActionClient("/visual_servo/go_to_pixel", GoToPixelAction)
        self.assertTrue(servo.wait_for_server(rospy.Duration(PATIENCE)))
        target = GoToPixelGoal(x=640, y=200)
        proposed = self.point_for(target)

        def go():
            servo.send_goal(target)
            self.assertTrue(servo.wait_for_result(rospy.Duration(PATIENCE)))
            return servo.get_result()
        refused = go()
        self.assertFalse(refused.success)
        self.assertIn("must be ENABLED", refused.message)
        self.command(self.controller, "/controller/operating_state", "enable", "ENABLED")
        result = go()
        self.assertTrue(result.success, result.message)
        self.assertLess(result.distance, 1)
        arrived = rospy.Time.now()
        self.until(lambda: self.seen["/vision/state"].header.stamp > arrived and self.tip_is_seen(),
                   "an image at the goal")
        tip = self.seen["/vision/state"].injection_pipette
        self.assertLess(np.hypot(tip.x - target.x, tip.y - target.y), 2)
        needle = rospy.wait_for_message("/needle/measured_cp", PoseStamped, PATIENCE).pose.position
        # The motors stand beside the tip by the backlash, at most.
        self.assertLess(np.hypot(proposed.x - needle.x, proposed.z - needle.z), 1.5 * BACKLASH)

    def point_for(self, pixel):
        """Where the tip would be at a proposed pixel (m, world). What is proposed no more is no place."""
        points = []
        subscriber = rospy.Subscriber("/visual_servo/proposed_point", PointStamped, points.append)
        pixels = rospy.Publisher("/visual_servo/proposed_pixel", PointStamped, queue_size=1, latch=True)
        message = PointStamped(point=Point(pixel.x, pixel.y, 0))
        message.header.stamp = rospy.Time.now()
        pixels.publish(message)
        self.until(lambda: points and not points[-1].header.stamp.is_zero(), "a proposed point")
        point = points[-1].point
        pixels.publish(PointStamped())
        self.until(lambda: points[-1].header.stamp.is_zero(), "no proposed point")
        subscriber.unregister()
        return point

    def test_refuses_while_the_controller_may_command(self):
        self.command(self.controller, "/controller/operating_state", "enable", "ENABLED")
        self.goal()
        result = self.result()
        self.assertFalse(result.success)
        self.assertIn("must be DISABLED", result.message)

    def test_refuses_a_field_that_is_too_small_or_not_finite(self):
        for field in (1e-6, -60e-6, float("nan"), 0.5):
            self.goal(field_x=field)
            result = self.result()
            self.assertFalse(result.success, field)
            self.assertTrue(result.message)

    def test_stops_when_cancelled(self):
        wide, start = 800e-6, self.places[-1]  # its first point is 4 s away
        self.goal(field_x=wide)
        self.until(lambda: abs(self.places[-1][0] - start[0]) > 3e-6, "a motion")
        self.action.cancel_goal()
        self.assertEqual(self.result().message, "cancelled")
        self.assertEqual(self.action.get_state(), GoalStatus.PREEMPTED)
        self.rest()
        self.assertLess(abs(self.places[-1][0] - start[0]), wide / 2)

    def test_another_command_ends_it(self):
        self.goal(field_x=800e-6)
        start = self.places[-1]
        self.until(lambda: abs(self.places[-1][0] - start[0]) > 3e-6, "a motion")
        self.needle.publish(StringStamped(string="stop"))
        self.assertIn("command stop", self.result().message)
        self.rest()

    def rest(self):
        """Waits until the needle has not moved for 500 of its poses."""
        def still():
            last = self.places[-500:]
            return len(last) == 500 and max(abs(place[0] - last[0][0]) for place in last) < 1e-7
        begin = len(self.places)
        self.until(lambda: len(self.places) > begin + 500 and still(), "the needle's rest")


if __name__ == "__main__":
    rospy.init_node("operator")
    rostest.rosrun("cell_microinjection", "calibrate", CalibrateTest)
