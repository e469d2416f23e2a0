#!/usr/bin/python3
"""Needle and focus are moved by steps from the operator's console, by buttons and the wheel."""

import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped, TransformStamped
from sensor_msgs.msg import Image, JointState
from tf2_msgs.msg import TFMessage

import console_eye
from console_user import PATIENCE, START_PATIENCE, ConsoleUser
from live_chain import Master
from messages import position
from shown_controller import ShownController

COLOUR = (200, 0, 200)  # of the test's image, which nothing else on the screen has
TIP = np.array([1e-6, -2e-6, 80e-6])  # m
PERIOD = 0.05  # s, of what the needle and the focus report


class Rig:
    """A needle and a focus that are at once where they are sent, and an image."""

    def __init__(self):
        self.tip, self.focus, self.moves, self.steps, self.states = TIP.copy(), 0.0, [], [], []
        self.busy = False
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self._focus = rospy.Publisher("/focus/measured_js", JointState, queue_size=1)
        self._images = rospy.Publisher("/microscope/image_raw", Image, queue_size=1)
        self._state = rospy.Publisher("/needle/operating_state", OperatingState, queue_size=1, latch=True)
        self.report()
        self._subscribers = [rospy.Subscriber("/needle/move_cp", PoseStamped, self._move),
                             rospy.Subscriber("/focus/move_jp", JointState, self._move_focus),
                             rospy.Subscriber("/needle/state_command", StringStamped,
                                              lambda message: self.states.append(message.string))]
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def report(self, busy=False):
        self.busy = busy
        self._state.publish(OperatingState(state="ENABLED", is_homed=True, is_busy=busy))

    def _move(self, message):
        self.moves.append(message)
        if not self.busy:
            self.tip = np.array(position(message))

    def _move_focus(self, message):
        self.steps.append(message.position[0])
        self.focus = message.position[0]

    def _run(self):
        image = Image(width=64, height=48, encoding="rgb8", step=3 * 64, data=bytes(COLOUR) * (64 * 48))
        while not self._ended.wait(PERIOD):
            now = rospy.Time.now()
            frame = TransformStamped(child_frame_id="needle_tip")
            frame.header.frame_id, frame.header.stamp = "world", now
            t = frame.transform.translation
            t.x, t.y, t.z = self.tip
            frame.transform.rotation.w = 1
            self._tf.publish(TFMessage([frame]))
            self._focus.publish(JointState(name=["focus"], position=[self.focus]))
            image.header.stamp = now
            self._images.publish(image)

    def close(self):
        self._ended.set()
        self._thread.join()


class ConsoleStepsTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("injection_controller")  # which the .test names it, too: the console sends nothing to others
        rospy.set_param("/microscope/focus/range", [-1.5e-6, 50e-6])
        cls.controller = ShownController(mode="manual")
        cls.open_console("calibrate")
        cls.rig = Rig()

    @classmethod
    def tearDownClass(cls):
        cls.rig.close()
        cls.controller.close()
        cls.close_console()
        cls.master.kill()

    def rows(self, count, buttons, patience=PATIENCE):
        """Rows of that many offered buttons, as soon as there are so many of them."""
        def check():
            if not self.look():
                return None
            rows = [row for row in console_eye.rows_of_offered(self.picture, 2) if len(row) == buttons]
            return (rows,) if len(rows) == count else None
        return self.until(check, f"{count} rows of {buttons} offered buttons", patience)[0]

    def test_1_the_needle(self):
        (buttons,) = self.rows(1, 6, START_PATIENCE)
        at = TIP.copy()
        for number, place in enumerate(buttons):
            self.click(place)
            self.until(lambda number=number: len(self.rig.moves) > number, f"a move of button {number}")
            at[number // 2] += 5e-6 if number % 2 else -5e-6
            move = self.rig.moves[-1]
            self.assertEqual(move.header.frame_id, "world")
            np.testing.assert_allclose(position(move), at, atol=1e-12)
            self.assertEqual(move.pose.orientation.w, 1)
        # Two steps add up while the needle is on its way; STOP ends it.
        self.rig.report(busy=True)
        time.sleep(0.5)
        for _ in range(2):
            self.click(buttons[5])
        self.until(lambda: len(self.rig.moves) == 8, "two moves")
        np.testing.assert_allclose(position(self.rig.moves[-1]), at + [0, 0, 10e-6], atol=1e-12)
        self.click(self.shows(lambda seen: True, "its buttons").stop)
        self.until(lambda: self.rig.states == ["stop"], "a stop of the needle")
        self.rig.report()

    def test_2_the_controller_has_the_needle(self):
        before = len(self.rig.moves)
        (buttons,) = self.rows(1, 6)
        self.controller.change("ENABLED")
        self.rows(0, 6)
        self.click(buttons[0])
        self.controller.change("DISABLED")
        self.rows(1, 6)
        self.assertEqual(len(self.rig.moves), before)

    def test_3_the_focus(self):
        (down, up), = self.rows(1, 2)
        for place, focus in ((up, 1e-6), (up, 2e-6), (down, 1e-6)):
            before = len(self.rig.steps)
            self.click(place)
            self.until(lambda before=before: len(self.rig.steps) > before, "a step of the focus")
            self.assertAlmostEqual(self.rig.steps[-1], focus, 12)
        left, top, right, bottom = console_eye.box_of(COLOUR, self.picture)
        self.do("mousemove", (left + right) // 2, (top + bottom) // 2)
        before = len(self.rig.steps)
        self.do("keydown", "ctrl")
        self.do("click", 5)  # the wheel towards the user
        self.do("click", 5)
        self.do("keyup", "ctrl")
        self.until(lambda: len(self.rig.steps) == before + 2, "two steps of the wheel")
        self.assertAlmostEqual(self.rig.steps[-1], -1e-6, 12)
        # The range ends before the next step: the button down is greyed.
        time.sleep(1.5)
        self.rows(0, 2)


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_steps", ConsoleStepsTest)
