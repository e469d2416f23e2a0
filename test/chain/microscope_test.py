#!/usr/bin/python3
"""The virtual microscope shows what the topics say, where they say it, and nothing when they are silent."""

import time
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import CameraInfo, Image, JointState
from tf2_msgs.msg import TFMessage

from cell_microinjection.msg import CellState

from specimen import sphere, transform

PATIENCE = 30  # s
PIXEL = 0.25e-6  # m
CENTRE = np.array([695.5, 519.5])  # px, of the world's origin
RADIUS = 40e-6  # m


class MicroscopeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.images, cls.infos, cls.focus = [], [], []
        cls.state = sphere(RADIUS)
        cls.tip = np.array([20e-6, 0, 60e-6])
        cls.shown = True
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        cls.needle = rospy.Publisher("/needle/measured_cp", PoseStamped, queue_size=1)
        cls.cell = rospy.Publisher("/cell/state", CellState, queue_size=1)
        cls.command = rospy.Publisher("/focus/move_jp", JointState, queue_size=1)
        rospy.Subscriber("/microscope/image_raw", Image, cls.images.append, buff_size=1 << 24)
        rospy.Subscriber("/microscope/camera_info", CameraInfo, cls.infos.append)
        rospy.Subscriber("/focus/measured_js", JointState, cls.focus.append)

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            self.tf.publish(TFMessage([transform("cell", (0, 0, 0))]))
            pose = PoseStamped()
            pose.header.frame_id, pose.header.stamp = "world", rospy.Time.now()
            p = pose.pose.position
            (p.x, p.y, p.z), pose.pose.orientation.w = self.tip, 1
            self.needle.publish(pose)
            if self.shown:
                self.cell.publish(self.state)
            time.sleep(0.02)

    def newest(self):
        """The second image from now on: the first may be under way."""
        self.images.clear()
        self.until(lambda: len(self.images) > 1, "an image")
        image = self.images[-1]
        self.assertEqual((image.encoding, image.header.frame_id), ("mono8", "microscope_optical_frame"))
        return np.frombuffer(image.data, np.uint8).reshape(image.height, image.width).astype(float)

    def test_needle_and_cell_are_where_they_are_said_to_be(self):
        self.tip[:] = [20e-6, 0, 60e-6]
        image = self.newest()
        info = self.infos[-1]
        self.assertEqual((info.width, info.height), image.shape[::-1])
        column, row = (CENTRE + [self.tip[0] / PIXEL, -self.tip[2] / PIXEL]).round().astype(int)
        strip = image[:, column - 60:column + 60]
        contrast = strip.std(axis=1)  # of the needle's walls, above its tip
        self.assertGreater(contrast[row - 30:row - 10].min(), 3 * contrast[row + 15:row + 30].max())
        # The ooplasm's dark rim reaches outwards from the border, on both sides of the cell.
        profile = image[int(CENTRE[1]) - 3:int(CENTRE[1]) + 4].mean(axis=0)
        for side in (-1, 1):
            places = CENTRE[0] + side * np.arange(RADIUS / PIXEL - 20, RADIUS / PIXEL + 20)
            rim = places[np.argmin(profile[places.round().astype(int)])]
            self.assertAlmostEqual(abs(rim - CENTRE[0]) * PIXEL, RADIUS, delta=2e-6)

    def test_focus_moves_and_blurs(self):
        sharp = self.newest()
        self.command.publish(JointState(name=["focus"], position=[20e-6]))
        self.until(lambda: abs(self.focus[-1].position[0] - 20e-6) < 1e-12, "the focus' motion")
        blurred = self.newest()
        rim = np.s_[int(CENTRE[1]) - 3:int(CENTRE[1]) + 4, :400 + int(CENTRE[0])]
        self.assertLess(np.abs(np.diff(blurred[rim].mean(axis=0))).max(), np.abs(np.diff(sharp[rim].mean(axis=0))).max())
        for wrong in ([1.0], [float("nan")], []):  # beyond the range, not finite, not one number
            self.command.publish(JointState(name=["focus"], position=wrong))
        begin = len(self.focus)
        self.until(lambda: len(self.focus) > begin + 20, "the focus' state")
        self.assertAlmostEqual(self.focus[-1].position[0], 20e-6, delta=1e-12)
        self.command.publish(JointState(name=["focus"], position=[0]))
        self.until(lambda: self.focus[-1].position[0] == 0, "the focus' way back")

    def silent(self):
        """Waits for a second after the last image that may be under way."""
        begin = len(self.focus)
        self.until(lambda: len(self.focus) > begin + 60, "the microscope's next steps")
        self.images.clear()
        begin = len(self.focus)
        self.until(lambda: len(self.focus) > begin + 30, "the microscope's next steps")
        return not self.images

    def test_no_image_of_a_cell_that_is_silent_or_not_finite(self):
        self.newest()
        type(self).shown = False
        try:
            self.assertTrue(self.silent(), "an image of a stale cell")
            type(self).shown = True
            self.newest()
            height = self.state.vertices[5].z
            self.state.vertices[5].z = float("nan")
            self.assertTrue(self.silent(), "an image of a cell that is not finite")
            self.state.vertices[5].z = height
            self.newest()
        finally:
            type(self).shown = True


if __name__ == "__main__":
    rospy.init_node("specimen")
    rostest.rosrun("cell_microinjection", "microscope", MicroscopeTest)
