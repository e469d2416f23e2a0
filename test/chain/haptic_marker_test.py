#!/usr/bin/python3
"""What rviz says of the dragged handle, at x 1e4, moves the hand at a limited speed while the mouse button is down."""

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, InteractiveMarkerUpdate

from case import case
from cell_microinjection.msg import OperatingState
from haptic_driver import PRESENT, HapticTest
from messages import pose
from participant import INVALID

NEEDLE, TARGET = "/needle/measured_cp", "/teleop/servo_cp"
TIP = np.array([1e-6, 2e-6, 30e-6])
HANDLE = 1e4 * (TIP + [36e-6, 0, 0])  # display units; config/haptic/marker.yaml


class MarkerTest(HapticTest):
    driver = {NEEDLE: PoseStamped, TARGET: PoseStamped}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.shown = {}
        rospy.Subscriber("/hand_marker/update_full", InteractiveMarkerInit, cls.on_init)
        rospy.Subscriber("/hand_marker/update", InteractiveMarkerUpdate, cls.on_update)
        cls.controller = rospy.Publisher("/controller/operating_state", OperatingState, queue_size=1, latch=True)
        cls.rviz = rospy.Publisher("/hand_marker/feedback", InteractiveMarkerFeedback, queue_size=100)
        cls.world.await_links()
        cls.world.run(1100)  # for a second after time 0 the server takes a mouse for the second one at once

    @classmethod
    def on_init(cls, message):
        for marker in message.markers:
            cls.shown.update(frame=marker.header.frame_id, menu=[entry.title for entry in marker.menu_entries])

    @classmethod
    def on_update(cls, message):
        for update in message.poses:
            p = update.pose.position
            cls.shown["place"] = np.array([p.x, p.y, p.z])

    def held(self):
        return {NEEDLE: pose(*TIP)}

    def good(self):
        return {**self.held(), TARGET: pose(*TIP)}

    def say(self, event, place=HANDLE, frame="viz/world", entry=0):
        message = InteractiveMarkerFeedback(client_id="test", marker_name="hand", event_type=event, menu_entry_id=entry)
        message.header.frame_id = frame
        message.pose = pose(*place).pose
        self.rviz.publish(message)

    def present(self):
        return PRESENT in self.world.seen and self.seen(PRESENT).buttons[0]

    def setUp(self):
        self.until(lambda: "frame" in self.shown, self.good, "no marker")
        self.world.run(200, self.good)
        self.say(InteractiveMarkerFeedback.MOUSE_UP)
        self.until(lambda: not self.present(), self.good, "the operator stays")

    def test_the_handle_goes_with_the_needle(self):
        self.until(lambda: "place" in self.shown and np.allclose(self.shown["place"], HANDLE, atol=1e-3), self.good,
                   "the handle is not beside the needle")
        self.assertEqual(self.shown["frame"], "viz/world")

    def test_drag(self):
        start = self.hand()
        down = 1e4 * np.array([0, 0, -4e-6])
        self.say(InteractiveMarkerFeedback.MOUSE_DOWN)
        self.until(self.present, self.good, "the operator is not present")
        np.testing.assert_allclose(self.hand(), start, atol=1e-12)
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, HANDLE + down)
        # 4 um are 4 mm of the hand, and 0.4 s at 0.01 m/s.
        self.until(lambda: not np.array_equal(self.hand(), start), self.good, "the hand does not move")
        self.world.run(100, self.good)
        self.assertLess(np.linalg.norm(self.hand() - start), 1.2e-3)
        self.world.run(320, self.good)
        np.testing.assert_allclose(self.hand() - start, [0, 0, -4e-3], atol=1e-9)
        self.say(InteractiveMarkerFeedback.MOUSE_UP)
        self.until(lambda: not self.present(), self.good, "the operator stays")

    def drag(self, way=-4e-6):
        """The handle is taken hold of and dragged along z; the hand is on its way."""
        start, self.place = self.hand(), HANDLE + 1e4 * np.array([0, 0, way])
        self.say(InteractiveMarkerFeedback.MOUSE_DOWN)
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, self.place)
        self.until(lambda: not np.array_equal(self.hand(), start), self.good, "the hand does not move")
        return start

    def go_on(self, ticks, messages):
        """With rviz that says that the mouse button is down."""
        for _ in range(ticks // 100):
            self.say(InteractiveMarkerFeedback.KEEP_ALIVE, self.place)
            self.world.run(100, messages)

    def test_a_hold_on_the_way_is_waited_for(self):
        start = self.drag()
        self.world.run(100, self.good)
        self.world.tick({**self.held(), TARGET: INVALID})
        self.world.run(20, self.held)
        there = self.hand()
        self.go_on(300, self.held)
        np.testing.assert_array_equal(self.hand(), there)
        self.assertTrue(self.present())
        self.go_on(400, self.good)
        np.testing.assert_allclose(self.hand() - start, [0, 0, -4e-3], atol=1e-9)

    def test_a_handle_that_was_dragged_for_nothing_is_put_back_and_counts_from_where_it_is(self):
        start, self.place = self.hand(), HANDLE + 1e4 * np.array([0, 0, -30e-6])
        self.shown.pop("place", None)
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, self.place)  # of a drag that has not begun
        self.until(lambda: np.allclose(self.shown.get("place", 0), HANDLE, atol=1e-3), self.good, "it stays away")
        self.say(InteractiveMarkerFeedback.MOUSE_DOWN, self.place)
        self.until(self.present, self.good, "the operator is not present")
        self.go_on(400, self.good)
        np.testing.assert_allclose(self.hand(), start, atol=1e-9)

    def test_after_a_long_hold_the_handle_must_be_taken_hold_of_again(self):
        self.drag()
        self.go_on(900, self.held)
        self.assertFalse(self.present())
        there = self.hand()
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, self.place)
        self.go_on(300, self.good)
        self.assertFalse(self.present())
        np.testing.assert_array_equal(self.hand(), there)
        self.setUp()
        self.drag()

    def test_a_controller_that_does_not_follow_is_a_hold(self):
        for state in (OperatingState(state="PAUSED"), OperatingState(state="ENABLED", is_busy=True)):
            with case(state.state):
                self.setUp()
                self.drag()
                self.controller.publish(state)
                self.go_on(1000, self.good)
                self.assertFalse(self.present())
                self.controller.publish(OperatingState(state="ENABLED"))
                self.world.run(100, self.good)

    def test_a_mouse_that_is_silent_is_gone(self):
        self.say(InteractiveMarkerFeedback.MOUSE_DOWN)
        self.until(self.present, self.good, "the operator is not present")
        self.world.run(500, self.good)
        self.say(InteractiveMarkerFeedback.KEEP_ALIVE)
        self.world.run(700, self.good)
        self.assertTrue(self.present())
        self.world.run(1000, self.good)
        self.assertFalse(self.present())

    def test_another_frame_is_refused(self):
        start = self.hand()
        self.say(InteractiveMarkerFeedback.MOUSE_DOWN)
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, HANDLE + [0, 0, -1], frame="world")
        self.say(InteractiveMarkerFeedback.MOUSE_DOWN)
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, [np.nan, 0, 0])
        self.say(InteractiveMarkerFeedback.MENU_SELECT, entry=4)  # comes after them
        self.until(lambda: "disable" in self.commands, self.good, "no command")
        self.assertFalse(self.present())
        np.testing.assert_array_equal(self.hand(), start)

    def test_menu(self):
        self.assertEqual(self.shown["menu"], ["Enable", "Inject", "Withdraw (home)", "Disable"])
        before = len(self.commands)
        for entry in (1, 2, 3):
            self.say(InteractiveMarkerFeedback.MENU_SELECT, entry=entry)
        self.until(lambda: len(self.commands) >= before + 3, self.good, "no command")
        self.assertEqual(self.commands[before:before + 3], ["enable", "inject", "home"])


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_marker", MarkerTest)
