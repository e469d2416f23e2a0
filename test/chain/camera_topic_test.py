#!/usr/bin/python3
"""camera:=topic: the node vision sees the images of another driver, in the formats that drivers have."""

import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import CellInImage, CellState, VisionState
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Image
from tf2_msgs.msg import TFMessage

from case import case
from specimen import sphere, transform

PATIENCE = 120  # s
PIXEL, RADIUS = 0.25e-6, 30e-6  # m


def converted(image, encoding):
    """@returns the grey image in another format; a grey scene has the same mosaic as a grey image"""
    grey = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width)
    pixels = {"mono8": grey, "bayer_rggb8": grey, "mono16": grey.astype(np.uint16) * 256,
              "rgb8": np.repeat(grey[:, :, None], 3, axis=2), "bgra8": np.repeat(grey[:, :, None], 4, axis=2)}[encoding]
    return Image(header=image.header, height=image.height, width=image.width, encoding=encoding,
                 step=pixels.nbytes // image.height, data=pixels.tobytes())


class CameraTopicTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.states, cls.encoding, cls.cut, cls.cut_stamps = [], "mono8", False, []
        cls.state = sphere(RADIUS)
        cls.cell = rospy.Publisher("/cell/state", CellState, queue_size=1)
        cls.needle = rospy.Publisher("/needle/measured_cp", PoseStamped, queue_size=1)
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        cls.driver = rospy.Publisher("/driver/image", Image, queue_size=1)
        rospy.Subscriber("/rendered/image_raw", Image, cls.on_image, queue_size=1, buff_size=1 << 24)
        rospy.Subscriber("/vision/state", VisionState, cls.states.append, queue_size=1)
        cls.ended = threading.Event()
        world = threading.Thread(target=cls.publish)
        world.start()
        cls.addClassCleanup(world.join)
        cls.addClassCleanup(cls.ended.set)

    @classmethod
    def publish(cls):
        while not cls.ended.wait(0.05):
            pose = PoseStamped()
            pose.header.frame_id, pose.header.stamp = "world", rospy.Time.now()
            pose.pose.position.z, pose.pose.orientation.w = 60e-6, 1
            cls.needle.publish(pose)
            cls.tf.publish(TFMessage([transform("cell", (0, 0, 0))]))
            cls.cell.publish(cls.state)

    @classmethod
    def on_image(cls, image):
        sent = converted(image, cls.encoding)
        if cls.cut:
            sent.data = sent.data[:-1]
            cls.cut_stamps.append(image.header.stamp)
        cls.driver.publish(sent)

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            time.sleep(0.02)

    def test_sees_the_cell_in_the_formats_of_drivers(self):
        for encoding in ("mono8", "rgb8", "bayer_rggb8", "bgra8", "mono16"):
            with case(encoding):
                type(self).encoding = encoding
                begin = rospy.Time.now()

                def seen():
                    state = self.states[-1] if self.states else None
                    return state and state.header.stamp > begin and state.cell.verdict == CellInImage.FOUND
                self.until(seen, "the cell")
                self.assertAlmostEqual(PIXEL * self.states[-1].cell.diameter, 2 * RADIUS, delta=1e-6)

    def test_a_short_image_is_not_read(self):
        self.until(lambda: self.states, "the first image")
        heard = []
        counter = rospy.Subscriber("/driver/image", Image, heard.append, queue_size=1, buff_size=1 << 24)
        self.addCleanup(counter.unregister)
        type(self).cut = True
        self.addCleanup(setattr, type(self), "cut", False)
        self.until(lambda: len(self.cut_stamps) > 8 and heard and heard[-1].header.stamp >= self.cut_stamps[8],
                   "short images of the driver")
        type(self).cut = False
        # Vision reads the images in their order, and its answer has the stamp of the image.
        self.until(lambda: self.states[-1].header.stamp > self.cut_stamps[-1], "the answer to a whole image")
        self.assertEqual({state.header.stamp for state in self.states} & set(self.cut_stamps), set())


if __name__ == "__main__":
    rospy.init_node("driver")
    rostest.rosrun("cell_microinjection", "camera_topic", CameraTopicTest)
