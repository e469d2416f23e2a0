#!/usr/bin/python3
"""The action touch/find stops the needle where it touches the cell, by the image; what may not be lowered stays."""

import copy
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from cell_microinjection.msg import (CellState, FindTouchAction, FindTouchGoal, OperatingState, StringStamped,
                                     VisionState)
from geometry_msgs.msg import PoseStamped

PATIENCE = 300  # s
ALLOWED = 0.5e-6  # m, of the touch from the cell's surface
ALLOWED_FORCE = 3e-9  # N, of the force from the cell's
RADIUS = 38e-6  # m, of mouse_oocyte_zona
ABOVE = 6e-6  # m over the cell, where the approaches begin
FARTHEST = 3.5e-6  # m, past the touch


class TouchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.seen, cls.lowest = {}, float("inf")
        for topic, kind in (("/needle/operating_state", OperatingState), ("/controller/operating_state", OperatingState),
                            ("/vision/state", VisionState), ("/cell/state", CellState)):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.seen.update({topic: message}), queue_size=1)
        rospy.Subscriber("/needle/measured_cp", PoseStamped, cls.on_needle, queue_size=1)
        cls.move = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=1)
        cls.controller = rospy.Publisher("/controller/state_command", StringStamped, queue_size=1)
        cls.action = actionlib.SimpleActionClient("/touch/find", FindTouchAction)
        assert cls.action.wait_for_server(rospy.Duration(PATIENCE))

    @classmethod
    def on_needle(cls, message):
        cls.seen["needle"] = message
        cls.lowest = min(cls.lowest, message.pose.position.z)

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            time.sleep(0.05)

    def command(self, command, state):
        def reached():
            message = self.seen.get("/controller/operating_state")
            if message and message.state == state:
                return True
            self.controller.publish(StringStamped(string=command))
            time.sleep(0.2)
            return False
        self.until(reached, f"the controller {state}")

    def height(self):
        return self.seen["needle"].pose.position.z

    def setUp(self):
        self.until(lambda: "needle" in self.seen, "the needle")
        self.command("disable", "DISABLED")
        goal = PoseStamped()
        goal.header.frame_id, goal.pose = "world", copy.deepcopy(self.seen["needle"].pose)
        goal.pose.position.z = RADIUS + ABOVE

        def arrived():
            goal.header.stamp = rospy.Time.now()
            self.move.publish(goal)
            time.sleep(0.5)
            return abs(self.height() - RADIUS - ABOVE) < 0.1e-6
        self.until(arrived, "the start of the approach")
        placed = rospy.Time.now()

        def is_seen():
            state = self.seen.get("/vision/state")
            return (state and state.header.stamp > placed and state.cell.verdict == state.cell.FOUND
                    and state.injection_pipette.verdict == state.injection_pipette.FOUND)
        self.until(is_seen, "cell and tip")
        type(self).lowest = self.height()

    def find(self, travel=0):
        self.action.send_goal(FindTouchGoal(travel=travel))
        self.assertTrue(self.action.wait_for_result(rospy.Duration(PATIENCE)))
        return self.action.get_result()

    def test_stops_at_the_touch(self):
        self.command("enable", "ENABLED")
        result = self.find()
        self.assertTrue(result.success, result.message)
        ended = rospy.Time.now()
        self.until(lambda: "/cell/state" in self.seen and self.seen["/cell/state"].header.stamp > ended,
                   "a state of the cell after the end")
        cell = self.seen["/cell/state"]
        print(f"{result.message}; contact {1e6 * result.contact[2]:.3f} um, truth {1e6 * RADIUS:.3f} um, "
              f"{1e6 * result.depth:.2f} um past it, {1e9 * result.force:.1f} nN, truth {1e9 * cell.force.z:.1f} nN")
        self.assertAlmostEqual(result.contact[2], RADIUS, delta=ALLOWED)
        self.assertLess(result.interval, 0.5e-6)
        self.assertAlmostEqual(result.force, cell.force.z, delta=ALLOWED_FORCE)  # the second witness
        self.assertGreater(result.force, 2 * ALLOWED_FORCE)
        self.assertGreater(self.lowest, RADIUS - FARTHEST)
        self.assertTrue(cell.in_contact)

    def test_ends_with_the_travel(self):
        self.command("enable", "ENABLED")
        result = self.find(3e-6)
        self.assertFalse(result.success)
        self.assertIn("no touch within 3 um", result.message)
        self.assertGreater(self.lowest, RADIUS + ABOVE - 3.2e-6)

    def test_refuses_a_disabled_controller_and_a_travel_that_is_too_long(self):
        self.assertIn("must be ENABLED", self.find().message)
        self.command("enable", "ENABLED")
        for travel in (1, -1e-6, float("nan")):
            self.assertIn("travel", self.find(travel).message)
        self.assertAlmostEqual(self.lowest, RADIUS + ABOVE, delta=0.2e-6)

    def test_stops_when_cancelled(self):
        self.command("enable", "ENABLED")
        self.action.send_goal(FindTouchGoal())
        ended = (GoalStatus.ABORTED, GoalStatus.REJECTED)
        self.until(lambda: self.height() < RADIUS + ABOVE - 1e-6 or self.action.get_state() in ended, "a motion")
        self.assertNotIn(self.action.get_state(), ended, self.action.get_result())
        self.action.cancel_goal()
        self.assertTrue(self.action.wait_for_result(rospy.Duration(PATIENCE)))
        self.assertEqual(self.action.get_state(), GoalStatus.PREEMPTED)
        self.assertGreater(self.lowest, RADIUS)


if __name__ == "__main__":
    rospy.init_node("operator")
    rostest.rosrun("cell_microinjection", "touch", TouchTest)
