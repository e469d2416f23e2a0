#!/usr/bin/python3
"""The axes of a haptic device are calibrated from the console alone, by three motions of the hand and the mouse."""

import unittest
from pathlib import Path

import rospy
import rostest
import yaml
from sensor_msgs.msg import Joy

import console_eye
from console_user import PATIENCE, START_PATIENCE, ConsoleUser
from killable_nodes import KillableNodes, parameters
from live_chain import RATE, TIMEOUT, Hand, Master
from messages import pose

REACH = 0.04  # m of a motion


class PlacedHand(Hand):
    """Is at `place` (m, of the device)."""

    def __init__(self):
        self.place, self.published = (0.0, 0.0, 0.0), 0
        super().__init__()

    def _run(self):
        while not self._ended.is_set() and not rospy.is_shutdown():
            message = pose(*self.place, "haptic")
            message.header.stamp = rospy.Time.now()
            self._publisher.publish(message)
            self._clutch.publish(Joy(header=message.header, buttons=[0]))
            self.published += 1
            rospy.rostime.wallsleep(1 / RATE)


class ConsoleAxesTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("hand_and_mouse")
        cls.open_console("axes")
        cls.file = Path(cls.folder.name) / "device_axes.yaml"
        patient = {key: TIMEOUT for key in ("hand", "needle", "predicted", "measured", "controller")}
        cls.nodes = KillableNodes({"haptic_bridge": parameters("haptic_bridge", rate=RATE, timeouts=patient,
                                                               axes_file=str(cls.file))})
        cls.hand = PlacedHand()

    @classmethod
    def tearDownClass(cls):
        cls.hand.end()
        cls.nodes.stop()
        cls.close_console()
        cls.master.kill()

    def report(self):
        return f"{super().report()}; {self.nodes.report()}"

    def offers(self, count, patience=PATIENCE):
        """Places of the offered buttons, as soon as there are that many, and the picture of what is beside the first."""
        def check():
            console = self.look()
            if not console:
                return None
            buttons = console_eye.offered_right_of(console.stop_right, self.picture)
            return (buttons, console_eye.beside(buttons[0], self.picture)) if len(buttons) == count else None
        return self.until(check, f"{count} offered buttons", patience)

    def step(self, before, count):
        """Presses the first button. @returns its text after that"""
        buttons, _ = self.offers(3 if before else 2)
        self.click(buttons[0])

        def changed():
            text = self.offers(count)[1]
            return text if text != before else None
        return self.until(changed, "another effect of the button")

    def written(self):
        return yaml.safe_load(self.file.read_text(encoding="utf-8"))["haptic_bridge"]["device_axes"] if self.file.exists() else None

    def test_three_motions_and_their_undo(self):
        self.offers(2, START_PATIENCE)  # Axes and Undo; End has nothing to end
        text = self.step(None, 3)
        self.click(self.offers(3)[0][0])  # the hand has not moved
        self.shows(lambda seen: console_eye.has_lamp("red", seen.stop_right, self.picture), "a refusal")
        self.assertEqual(self.offers(3)[1], text)
        for place, count in (((0, -REACH, 0), 3), ((REACH, -REACH, 0), 3), ((REACH, -REACH, REACH), 2)):
            self.assertIsNone(self.written())
            self.hand.place = place
            before = self.hand.published
            self.until(lambda before=before: self.hand.published > before + 0.2 * RATE, "a hand that is there")
            text = self.step(text, count)
        self.until(lambda: self.written() == "-y x z", "the axes in the file")
        self.click(self.offers(2)[0][1])
        self.until(lambda: self.written() == "x y z", "the axes of before in the file")


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_axes", ConsoleAxesTest)
