#!/usr/bin/python3
"""A tilted needle is shown where it is, at x 1e4, with the force on it in its own direction."""

import time
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import TransformStamped, WrenchStamped
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

PATIENCE = 30  # s
SCALE = 1e4
TIP, TILT = np.array([5e-6, -3e-6, 40e-6]), 0.4  # m; rad about y
AXIS = np.array([np.sin(TILT), 0, np.cos(TILT)])  # of the pipette, `world`


def transform(child, position=(0, 0, 0), tilt=0.0):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = "world", rospy.Time.now()
    t, q = message.transform.translation, message.transform.rotation
    t.x, t.y, t.z = position
    q.y, q.w = np.sin(tilt / 2), np.cos(tilt / 2)
    return message


class DisplayTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.frames, cls.markers = {}, {}
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        cls.force = rospy.Publisher("/force_sensor/measured_cf", WrenchStamped, queue_size=1)
        rospy.Subscriber("/tf", TFMessage, cls.on_frames)
        for topic in ("/viz/markers", "/viz/still"):
            rospy.Subscriber(topic, MarkerArray, cls.on_markers)

    @classmethod
    def on_frames(cls, message):
        cls.frames.update({t.child_frame_id: t for t in message.transforms})

    @classmethod
    def on_markers(cls, message):
        cls.markers.update({marker.ns: marker for marker in message.markers})

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            self.tf.publish(TFMessage([transform("needle_tip", TIP, TILT), transform("holding_pipette")]))
            force = WrenchStamped()
            force.header.frame_id, force.header.stamp = "needle_tip", rospy.Time.now()
            force.wrench.force.z = 2e-6
            self.force.publish(force)
            time.sleep(0.05)

    def test_needle(self):
        self.until(lambda: "viz/needle_tip" in self.frames, "the needle's frame")
        shown = self.frames["viz/needle_tip"]
        self.assertEqual(shown.header.frame_id, "viz/world")
        t, q = shown.transform.translation, shown.transform.rotation
        np.testing.assert_allclose([t.x, t.y, t.z], SCALE * TIP, atol=1e-9)
        np.testing.assert_allclose([q.x, q.y, q.z, q.w], [0, np.sin(TILT / 2), 0, np.cos(TILT / 2)], atol=1e-9)
        self.until(lambda: "injection_pipette" in self.markers, "the pipette")
        pipette = self.markers["injection_pipette"]
        self.assertEqual(pipette.header.frame_id, "viz/needle_tip")
        heights = np.array([point.z for point in pipette.points])
        self.assertAlmostEqual(heights.min(), 0, delta=0.1)  # it reaches from the tip out of the cell
        self.assertGreater(heights.max(), 1)

    def arrow(self):
        """One of a force that came when the needle's frame was known: before, it counts as along the world's axes."""
        begin = time.monotonic()
        self.until(lambda: time.monotonic() > begin + 1 and "measured_force" in self.markers, "the force's arrow")
        self.assertEqual(self.markers["measured_force"].action, Marker.ADD)
        return self.markers["measured_force"]

    def test_force(self):
        self.until(lambda: "viz/needle_tip" in self.frames, "the needle's frame")
        arrow = self.arrow()
        self.assertEqual(arrow.header.frame_id, "viz/world")
        tail, head = (np.array([point.x, point.y, point.z]) for point in arrow.points)
        np.testing.assert_allclose((head - tail) / np.linalg.norm(head - tail), AXIS, atol=1e-6)
        beside = tail - SCALE * TIP
        self.assertAlmostEqual(beside @ AXIS, SCALE * 20e-6, delta=1e-6)
        self.assertAlmostEqual(np.linalg.norm(beside - (beside @ AXIS) * AXIS), SCALE * 16e-6, delta=1e-6)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "display", DisplayTest)
