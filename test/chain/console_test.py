#!/usr/bin/python3
"""An injection from the console alone, by mouse and space bar, and what the console shows of it."""

import subprocess
import unittest

import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalID
from cell_microinjection.msg import InjectionStatus, InjectorState, LoopState, OperatingState
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Image

import console_eye
from console_user import START_PATIENCE, ConsoleUser
from messages import position

COLOUR = (200, 0, 200)  # of the test's image, which nothing else on the screen has
LEAST_SHARE = 0.05      # of the screen that an image fills


class ConsoleTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.open_console()
        cls.seen, cls.states, cls.cancelled = {}, [], []
        for topic, kind in (("/controller/injection_state", InjectionStatus), ("/controller/operating_state", OperatingState),
                            ("/controller/loop_state", LoopState),
                            ("/injector/state", InjectorState), ("/needle/measured_cp", PoseStamped)):
            rospy.Subscriber(topic, kind, cls.on_message, topic)
        rospy.Subscriber("/calibration/calibrate/cancel", GoalID, cls.cancelled.append)

    @classmethod
    def tearDownClass(cls):
        cls.close_console()

    @classmethod
    def on_message(cls, message, topic):
        cls.seen[topic] = message
        state = getattr(message, "state", None)
        if topic == "/controller/injection_state" and cls.states[-1:] != [state]:
            cls.states.append(state)

    def report(self):
        last = {topic: str(self.seen.get(f"/controller/{topic}")).replace("\n", ", ")
                for topic in ("injection_state", "operating_state", "loop_state")}
        return f"states {self.states}, {last}, {super().report()}"

    def operating(self, state):
        self.until(lambda: self.seen["/controller/operating_state"].state == state, state)

    def waits_in(self, state):
        def waits():
            status = self.seen["/controller/injection_state"]
            return status.state == state and status.waits
        self.until(waits, f"waiting in {state}")

    def needle_at(self, stamp):
        """Where it is at this time of the session or right after it."""
        self.until(lambda: self.seen["/needle/measured_cp"].header.stamp >= stamp, "a pose of the needle")
        return position(self.seen["/needle/measured_cp"])

    def sent_last(self, *commands):
        """What is sent and what comes of it have connections of their own."""
        self.until(lambda: tuple(self.sent[-len(commands):]) == commands, f"{commands} at last")

    def test_1_a_whole_injection_by_mouse(self):
        console = self.shows(lambda seen: seen.offered["Enable"], "Enable", START_PATIENCE)
        self.assertEqual([name for name in console_eye.BUTTONS if console.offered[name]], ["Enable"])
        self.press("Enable")
        self.operating("ENABLED")
        self.press("Approach")
        self.waits_in("contact")
        console = self.shows(lambda seen: seen.offered["Indent"], "Indent")
        self.assertFalse(console.offered["Inject"])
        sent = len(self.sent)
        self.click(console.place["Inject"])  # greyed
        self.press("Indent")
        self.assertEqual(self.sent[sent:], ["indent"])
        self.waits_in("punctured")
        self.press("Inject")
        self.until(lambda: "inject" in self.states, "the pulse")
        self.waits_in("punctured")
        self.shows(lambda seen: not seen.offered["Inject"], "Inject greyed after the pulse")
        self.press("Withdraw")
        self.until(lambda: self.seen["/controller/injection_state"].outcome == "injected", "the outcome")
        self.assertEqual(self.sent, ["enable", "approach", "indent", "inject", "withdraw"])
        self.assertGreater(self.seen["/injector/state"].volume, 0)
        self.assertEqual([state for state in self.states if state != "idle"],
                         ["approach", "contact", "indent", "punctured", "inject", "punctured", "withdraw"])

    def test_2_stop_by_mouse_and_by_space_bar(self):
        self.until(lambda: self.states[-1:] == ["idle"], "idle")
        before = len(self.states)
        self.press("Approach")
        self.until(lambda: "approach" in self.states[before:], "the approach")
        console = self.shows(lambda seen: not seen.offered["Approach"], "Approach greyed")
        self.assertEqual(self.cancelled, [])
        self.click(console.stop)
        self.operating("PAUSED")
        paused = self.seen["/controller/operating_state"].header.stamp
        # A calibration would move the needle on: it runs while the controller is DISABLED.
        self.until(lambda: self.cancelled, "a cancel of the calibration")
        self.assertEqual(self.cancelled[0].id, "")
        self.shows(lambda seen: seen.headline == ["yellow"], "a yellow headline")
        at = self.needle_at(paused + rospy.Duration(0.5))
        np.testing.assert_allclose(self.needle_at(paused + rospy.Duration(1)), at, atol=0.1e-6)
        self.press("Enable")  # it is Resume now
        self.operating("ENABLED")
        self.sent_last("pause", "resume")
        # While the console still shows PAUSED, the space bar disables instead.
        self.shows(lambda seen: seen.offered["Disable"] and not seen.offered["Enable"], "an enabled controller")
        self.do("key", "space")
        self.operating("PAUSED")
        self.shows(lambda seen: seen.headline == ["yellow"], "a yellow headline")
        self.do("key", "space")
        self.operating("DISABLED")
        self.sent_last("pause", "disable")
        self.shows(lambda seen: seen.headline == ["grey"], "a grey headline")

    def test_3_the_lamps_of_the_devices(self):
        def all_lamps(seen):
            grey = {name for name, colour in seen.lamps.items() if colour == "grey"}
            return (len(seen.lamps) == len(console_eye.ROWS["inject"]) and grey >= {"Camera", "Hand", "Estimate"}
                    and seen.lamps["Sensor"] in ("green", "yellow"))
        self.shows(all_lamps, "all lamps, that of the sensor green or yellow")
        subprocess.run(["rosnode", "kill", "/force_sensor"], check=True, timeout=60, stdout=subprocess.DEVNULL)
        self.shows(lambda seen: seen.lamps.get("Sensor") == "red" and seen.lamps["Rig"] != "red",
                   "a red lamp of the sensor and none of the rig")

    def test_4_the_microscope_appears_with_its_first_image(self):
        self.shows(lambda seen: True, "its buttons")
        self.assertEqual(console_eye.share_of(COLOUR, self.picture), 0)
        images = rospy.Publisher("/microscope/image_raw", Image, queue_size=1)
        image = Image(width=64, height=48, encoding="rgb8", step=3 * 64, data=bytes(COLOUR) * (64 * 48))

        def shown():
            image.header.stamp = rospy.Time.now()
            images.publish(image)
            return self.look() and console_eye.share_of(COLOUR, self.picture) > LEAST_SHARE
        self.until(shown, "an image beside a console whose buttons are all to be seen")
        image.data = image.data[:100]  # shorter than it says
        images.publish(image)
        images.unregister()
        self.shows(lambda seen: console_eye.share_of(COLOUR, self.picture) == 0, "no image, since none comes")

    def test_5_a_controller_that_dies(self):
        subprocess.run(["rosnode", "kill", "/injection_controller"], check=True, timeout=60, stdout=subprocess.DEVNULL)
        console = self.shows(lambda seen: seen.headline == ["red"], "a red headline")
        self.assertFalse(any(console.offered.values()))


if __name__ == "__main__":
    rospy.init_node("operator_with_mouse")
    rostest.rosrun("cell_microinjection", "console", ConsoleTest)
