#!/usr/bin/python3
"""What rviz says of the dragged handle, at x 1e4, moves the hand at a limited speed while the mouse button is down."""

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, InteractiveMarkerUpdate

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
        cls.rviz = rospy.Publisher("/hand_marker/feedback", InteractiveMarkerFeedback, queue_size=100)
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

    def good(self, led=TIP):
        return {**self.held(), TARGET: pose(*led)}

    def say(self, event, place=HANDLE, frame="viz/world", entry=0):
        message = InteractiveMarkerFeedback(client_id="test", marker_name="hand", event_type=event, menu_entry_id=entry)
        message.header.frame_id = frame
        message.pose = pose(*place).pose
        self.rviz.publish(message)

    def present(self):
        return PRESENT in self.world.seen and self.seen(PRESENT).buttons[0]

    def setUp(self):
        self.until(lambda: self.rviz.get_num_connections() and "frame" in self.shown, self.good, "no marker")
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

    def test_a_hold_on_the_way_does_not_part_needle_and_handle(self):
        start, further = self.hand(), TIP - [0, 0, 1.5e-6]
        self.say(InteractiveMarkerFeedback.MOUSE_DOWN)
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, HANDLE + 1e4 * np.array([0, 0, -4e-6]))
        self.until(lambda: not np.array_equal(self.hand(), start), self.good, "the hand does not move")
        self.world.run(100, self.good)
        self.world.tick({**self.held(), TARGET: INVALID})
        self.world.run(20, self.held)
        there = self.hand()
        self.world.run(300, self.held)
        np.testing.assert_array_equal(self.hand(), there)
        self.assertTrue(self.present())
        self.say(InteractiveMarkerFeedback.KEEP_ALIVE)
        self.world.run(400, lambda: self.good(further))
        np.testing.assert_allclose(self.hand() - there, [0, 0, -2.5e-3], atol=1e-9)

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
        self.say(InteractiveMarkerFeedback.POSE_UPDATE, HANDLE + [0, 0, -1], frame="world")
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
