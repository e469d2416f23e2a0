#!/usr/bin/python3
"""The action focus/find brings the needle's tip into focus, wherever the needle and the focus are; without images, tip or
rest it says why not."""

import threading
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from cell_microinjection.msg import CellState, FindFocusAction, FindFocusGoal, VisionState
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from links import await_links
from specimen import sphere, transform

PATIENCE = 300  # s
ALLOWED = 0.3e-6  # m, of the focus from the tip
RADIUS = 28e-6  # m, of the cell


class FocusTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.seen, cls.tip, cls.shown, cls.state = {}, [5e-6, 0, 60e-6], True, sphere(RADIUS)
        cls.needle = rospy.Publisher("/needle/measured_cp", PoseStamped, queue_size=1)
        cls.cell = rospy.Publisher("/cell/state", CellState, queue_size=1)
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        cls.focus = rospy.Publisher("/focus/move_jp", JointState, queue_size=1)
        for topic, kind in (("/vision/state", VisionState), ("/focus/measured_js", JointState)):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.seen.update({topic: message}), queue_size=1)
        cls.action = actionlib.SimpleActionClient("/focus/find", FindFocusAction)
        cls.ended = threading.Event()
        world = threading.Thread(target=cls.publish)
        world.start()
        cls.addClassCleanup(world.join)
        cls.addClassCleanup(cls.ended.set)
        assert cls.action.wait_for_server(rospy.Duration(PATIENCE))
        await_links(PATIENCE)  # what this test has heard, the node may not hear yet

    @classmethod
    def publish(cls):
        while not cls.ended.wait(0.02):
            pose = PoseStamped()
            pose.header.frame_id, pose.header.stamp = "world", rospy.Time.now()
            p = pose.pose.position
            (p.x, p.y, p.z), pose.pose.orientation.w = cls.tip, 1
            cls.needle.publish(pose)
            cls.tf.publish(TFMessage([transform("cell", (0, 0, 0))]))
            if cls.shown:
                cls.cell.publish(cls.state)

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            time.sleep(0.02)

    def place(self):
        return self.seen["/focus/measured_js"].position[0]

    def prepare(self, depth, focus):
        """The tip at `depth` and the focus at `focus`, m along y of the world; the tip is seen."""
        type(self).shown, self.tip[1] = True, depth
        self.until(lambda: "/focus/measured_js" in self.seen, "the focus")

        def arrived():
            self.focus.publish(JointState(name=["focus"], position=[focus]))
            return abs(self.place() - focus) < 1e-9
        self.until(arrived, "the focus' motion")
        placed = rospy.Time.now()

        def tip_is_seen():
            state = self.seen.get("/vision/state")
            return state and state.header.stamp > placed and state.injection_pipette.verdict != 0
        self.until(tip_is_seen, "the tip")

    def find(self, during=lambda feedback: None):
        self.action.send_goal(FindFocusGoal(), feedback_cb=during)
        self.assertTrue(self.action.wait_for_result(rospy.Duration(PATIENCE)))
        return self.action.get_result()

    def test_finds_the_tip_wherever_it_is(self):
        for depth, focus in ((0, 5e-6), (3.4e-6, -3e-6)):
            self.prepare(depth, focus)
            result = self.find()
            self.assertTrue(result.success, result.message)
            print(f"depth {1e6 * depth} um, from {1e6 * focus} um: {result.message}, error {1e6 * (result.height - depth):.3f} um")
            self.assertAlmostEqual(result.height, depth, delta=ALLOWED)
            self.assertLess(result.interval, 0.6e-6)
            self.assertAlmostEqual(result.tip_height, depth - focus, delta=ALLOWED)
            self.until(lambda height=result.height: abs(self.place() - height) < 1e-7, "the best plane")

    def fails(self, reason, during):
        self.prepare(0, 2e-6)
        result = self.find(during)
        self.assertFalse(result.success)
        self.assertIn(reason, result.message)
        self.until(lambda: abs(self.place() - 2e-6) < 1e-9, "the way back")

    def test_fails_when_the_needle_moves(self):
        def move(_):
            self.tip[1] = 5e-6
        self.fails("the needle moves", move)

    def test_fails_when_the_images_stop(self):
        def hide(_):
            type(self).shown = False
        self.fails("no fresh image", hide)

    def test_stops_when_cancelled(self):
        self.prepare(0, 2e-6)
        self.action.send_goal(FindFocusGoal())
        self.until(lambda: abs(self.place() - 2e-6) > 3e-6, "a motion")
        self.action.cancel_goal()
        self.assertTrue(self.action.wait_for_result(rospy.Duration(PATIENCE)))
        self.assertEqual(self.action.get_state(), GoalStatus.PREEMPTED)
        self.assertEqual(self.action.get_result().message, "cancelled")


if __name__ == "__main__":
    rospy.init_node("specimen")
    rostest.rosrun("cell_microinjection", "focus", FocusTest)
