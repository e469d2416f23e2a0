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
        """An image that was begun from now on: several older ones may be under way."""
        self.images.clear()
        begin = rospy.Time.now()
        self.until(lambda: self.images and self.images[-1].header.stamp > begin, "an image")
        image = self.images[-1]
        self.assertEqual((image.encoding, image.header.frame_id), ("mono8", "microscope_optical_frame"))
        return np.frombuffer(image.data, np.uint8).reshape(image.height, image.width).astype(float)

    def test_needle_and_cell_are_where_they_are_said_to_be(self):
        self.tip[:] = [20e-6, 0, 60e-6]
        column, row = (CENTRE + [self.tip[0] / PIXEL, -self.tip[2] / PIXEL]).round().astype(int)
        image = None

        def shown():  # not in an image that was begun before the microscope had read a pose of now
            nonlocal image
            image = self.newest()
            contrast = image[:, column - 60:column + 60].std(axis=1)  # of the needle's walls, above its tip
            return contrast[row - 30:row - 10].min() > 3 * contrast[row + 15:row + 30].max()
        self.until(shown, "the needle where it is said to be")
        self.until(lambda: self.infos, "the camera's info")
        info = self.infos[-1]
        self.assertEqual((info.width, info.height), image.shape[::-1])
        # The ooplasm's dark rim reaches outwards from the border, on both sides of the cell.
        profile = image[int(CENTRE[1]) - 3:int(CENTRE[1]) + 4].mean(axis=0)
        for side in (-1, 1):
            places = CENTRE[0] + side * np.arange(RADIUS / PIXEL - 20, RADIUS / PIXEL + 20)
            rim = places[np.argmin(profile[places.round().astype(int)])]
            self.assertAlmostEqual(abs(rim - CENTRE[0]) * PIXEL, RADIUS, delta=2e-6)

    def test_focus_moves_and_blurs(self):
        sharp = self.newest()
        self.until(lambda: self.focus and self.command.get_num_connections(), "the focus")
        self.command.publish(JointState(name=["focus"], position=[20e-6]))
        self.until(lambda: abs(self.focus[-1].position[0] - 20e-6) < 1e-12, "the focus' motion")
        blurred = self.newest()
        rim = np.s_[int(CENTRE[1]) - 3:int(CENTRE[1]) + 4, :400 + int(CENTRE[0])]
        self.assertLess(np.abs(np.diff(blurred[rim].mean(axis=0))).max(), np.abs(np.diff(sharp[rim].mean(axis=0))).max())
        for wrong in ([1.0], [float("nan")], []):  # beyond the range, not finite, not one number
            self.command.publish(JointState(name=["focus"], position=wrong))
        self.pass_time(0.7)
        self.assertAlmostEqual(self.focus[-1].position[0], 20e-6, delta=1e-12)
        self.command.publish(JointState(name=["focus"], position=[0]))
        self.until(lambda: self.focus[-1].position[0] == 0, "the focus' way back")

    def pass_time(self, duration):
        """That the microscope is past, whose state of the focus has the stamp of its step. @returns the end"""
        end = rospy.Time.now() + rospy.Duration(duration)
        self.until(lambda: self.focus and self.focus[-1].header.stamp > end, "the microscope's next steps")
        return end

    def silent(self):
        """Whether no image is begun in a second, after one in which the cell's last state grows stale. It may have come
        late: the microscope counts from its arrival."""
        self.pass_time(2)
        begin = self.pass_time(1)
        self.pass_time(1)
        return not any(image.header.stamp > begin for image in self.images)

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
