#!/usr/bin/python3
"""A folder of images plays as the microscope's camera: in order, with the file's format, without what cannot be read."""

import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from matplotlib import image as files
from sensor_msgs.msg import CameraInfo, Image

PATIENCE = 30  # s
CAMERA = pathlib.Path(sys.argv[0]).parent / "camera"  # this program is found beside it
LEVELS = (0, 40, 80, 120, 160)  # of the images' corner


class CameraTest(unittest.TestCase):
    def setUp(self):
        self.images, self.infos, self.status = [], [], {}
        self.subscribers = [
            rospy.Subscriber("/microscope/image_raw", Image, self.images.append, queue_size=100),
            rospy.Subscriber("/microscope/camera_info", CameraInfo, self.infos.append, queue_size=100),
            rospy.Subscriber("/diagnostics", DiagnosticArray, self.on_diagnostics)]
        self.folder = pathlib.Path(tempfile.mkdtemp())
        for number, level in enumerate(LEVELS):
            image = np.full((30, 40, 3), 128, np.uint8)
            image[0, 0] = level
            image[1, 1] = 200, 100, 50  # red, green, blue
            files.imsave(self.folder / f"plane{number + 8}.png", image)
        (self.folder / "plane10a.png").write_bytes(b"no image")

    def on_diagnostics(self, message):
        self.status.update({status.name: status for status in message.status})

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            time.sleep(0.02)

    def play(self, **parameters):
        arguments = [f"_{key}:={value}" for key, value in
                     {"source": "folder", "path": self.folder, "rate": 20, **parameters}.items()]
        self.process = process = subprocess.Popen([str(CAMERA), *arguments, "__name:=camera"])

        def end():
            process.terminate()
            process.wait()
            for key in rospy.get_param("/camera", {}):
                rospy.delete_param(f"/camera/{key}")
        self.addCleanup(end)

    def camera_status(self):
        return next((status for name, status in list(self.status.items()) if name.startswith("camera")), None)

    def test_plays_in_order_and_again(self):
        self.play(loop=True)
        # Images and what belongs to them come through connections of their own.
        self.until(lambda: len(self.images) > 3 * len(LEVELS) and self.infos, "three loops")
        pixels = [np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, -1) for image in self.images]
        self.assertIn(self.images[0].encoding, ("bgra8", "bgr8"))
        self.assertEqual(pixels[0].shape[:2], (30, 40))
        np.testing.assert_array_equal(pixels[0][1, 1, :3], (50, 100, 200))
        # The camera numbers what it publishes: what a full queue loses on the way is no fault of its order.
        seen = [(image.header.seq, LEVELS.index(corner[0, 0, 0])) for image, corner in zip(self.images, pixels)]
        # plane8, plane9, plane10, ...: by number, although 10 comes before 8 in the alphabet.
        self.assertTrue(all(later > number and (after - before - (later - number)) % len(LEVELS) == 0
                            for (number, before), (later, after) in zip(seen, seen[1:])), seen)
        stamps = [image.header.stamp for image in self.images]
        self.assertTrue(all(before < after for before, after in zip(stamps, stamps[1:])))
        self.assertEqual({(info.width, info.height) for info in self.infos}, {(40, 30)})

    def test_says_what_it_skipped_and_that_it_has_ended(self):
        self.play()
        self.until(lambda: self.camera_status() and "ended" in self.camera_status().message, "the end")
        self.assertEqual(self.camera_status().level, DiagnosticStatus.WARN)
        self.assertIn("plane10a.png", self.camera_status().message)
        values = {value.key: value.value for value in self.camera_status().values}
        self.assertEqual(values["frames"], str(len(LEVELS)))

    def test_ends_although_a_read_blocks(self):
        blocked = pathlib.Path(tempfile.mkdtemp())
        os.mkfifo(blocked / "plane1.png")  # nobody writes it: who opens it for reading waits for ever
        self.play(path=blocked)
        self.until(lambda: self.camera_status() and "no frame" in self.camera_status().message, "a camera that waits")
        self.process.terminate()
        self.assertEqual(self.process.wait(PATIENCE), 0)


if __name__ == "__main__":
    rospy.init_node("watcher")
    rostest.rosrun("cell_microinjection", "camera", CameraTest)
