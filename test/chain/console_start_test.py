#!/usr/bin/python3
"""rviz starts on a screen that is drawn in software even when the X server serves its connections in an unlucky order."""

import time
import unittest

import rospy
import rostest

from console_user import START_PATIENCE, ConsoleUser
from live_chain import Master

WINDOW = 2  # the connection that OGRE makes the scene's window through; it draws through the one before
FRAMES = 3  # s, of frames; a heap that is written over ends rviz within the first ones


class ConsoleStartTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("operator_of_a_slow_screen")
        cls.open_console(slow=WINDOW)

    @classmethod
    def tearDownClass(cls):
        cls.close_console()
        cls.master.kill()

    def test_a_window_that_comes_late(self):
        self.until(lambda: self.died() or self.look(), "a console", START_PATIENCE)
        end = time.monotonic() + FRAMES
        self.until(lambda: self.died() or time.monotonic() > end, "frames")
        self.assertFalse(self.died(), self.report())


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_start", ConsoleStartTest)
