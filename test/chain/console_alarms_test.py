#!/usr/bin/python3
"""The operator's console beside processes that die, hang, come and go: what only real ones show. The alarms themselves, one
by one, are tested in test/rviz/console_alarms_test.cpp. The test is the hand."""

import contextlib
import unittest
from pathlib import Path

import rospy
import rostest
from cell_microinjection.msg import OperatingState
from std_msgs.msg import Bool

import console_eye
from console_user import ConsoleUser
from killable_nodes import parameters
from live_chain import LiveChain, Master
from processes import Child


def microscope():
    """A small picture, seldom, which costs little."""
    small = {"width": 174, "height": 130, "pixel_size": 2e-6, "origin": [86.5, 64.5]}
    return parameters("microscope", camera=small, rate=2)


class ConsoleAlarmsTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("operator_of_a_failing_session")
        cls.open_console("teleoperate")
        cls.frames = Child(["rosrun", "robot_state_publisher", "robot_state_publisher"], Path(cls.folder.name) / "frames.log")
        cls.chain = LiveChain({"microscope": microscope()})
        cls.chain.follow("/controller/operating_state", OperatingState)
        cls.nodes = cls.chain.nodes

    @classmethod
    def tearDownClass(cls):
        cls.chain.close()
        cls.frames.stop(5)
        cls.close_console()
        cls.master.kill()

    def report(self):
        return f"{self.operating_state()}, {super().report()}; {self.nodes.report()}"

    def operating_state(self):
        message = self.chain.newest.get("/controller/operating_state")
        return message.state if message else None

    def shows_red(self, *wanted):
        """These lamps are red, no other one is, and the headline is green."""
        def right(seen):
            red = {name for name, colour in seen.lamps.items() if colour == "red"}
            return len(seen.lamps) == len(console_eye.ROWS[self.console]) and red == set(wanted) and seen.headline == ["green"]
        return self.shows(right, f"red lamps {wanted} below a green headline")

    @contextlib.contextmanager
    def frozen(self, *nodes):
        for node in nodes:
            self.nodes.freeze(node)
        try:
            yield
        finally:
            for node in nodes:
                self.nodes.thaw(node)

    @contextlib.contextmanager
    def killed(self, node):
        self.nodes.kill(node)
        try:
            yield
        finally:
            self.nodes.start(node)

    def test_1_devices_that_the_needle_does_not_need(self):
        def complete(seen):
            absent = [name for name, colour in seen.lamps.items() if colour in ("grey", "red")]
            return (seen.headline == ["green"] and absent == ["Switch"]
                    and (seen.lamps["Needle"], seen.lamps["Clutch"]) == ("green", "green"))
        self.shows(complete, "all nodes of the session, and a needle that follows")
        with self.frozen("force_sensor", "microscope"), self.killed("injector"):
            self.shows_red("Sensor", "Camera", "Injector")
            self.chain.check_follows()
        self.shows_red()

    def test_2_the_cable_of_an_emulated_network(self):
        """Its buttons come and go with its process."""
        top = self.shows(lambda seen: seen.headline == ["green"], "a session at rest").place["Enable"][1]

        def places():  # below the strip of steps, whose present one looks like an offered button
            rows = console_eye.rows_of_offered(self.picture, 1) if self.look() else []
            return {place for row in rows for place in row if place[1] >= top}
        before = self.until(places, "buttons")
        said = []
        heard = rospy.Subscriber("/link/plugged", Bool, lambda message: said.append(message.data))
        network = Child(["rosrun", "cell_microinjection", "link_emulator"], Path(self.folder.name) / "link_emulator.log")
        self.addCleanup(network.stop, 5)
        # A console that has just started does not know whether the cable is plugged in. The upper one is Unplug.
        more = self.until(lambda: self.more(places() - before, 2), "two more buttons")
        self.click(min(more, key=lambda place: place[1]))
        self.until(lambda: said == [False], "an unplugged cable on /link/plugged")
        network.stop(5)
        self.until(lambda: places() == before, "no buttons of a network that is gone")
        heard.unregister()

    @staticmethod
    def more(places, number):
        return places if len(places) == number else None

    def test_3_a_controller_that_hangs(self):
        """What STOP has sent meanwhile is done as soon as it goes on."""
        with self.frozen("injection_controller"):
            seen = self.shows(lambda seen: seen.headline == ["red"], "a red headline")
            self.assertFalse(any(seen.offered.values()))
            before = len(self.sent)
            self.click(seen.stop)
            self.until(lambda: len(self.sent) > before, "a command of STOP")
            self.assertEqual(self.sent[-1], "disable")
        self.until(lambda: self.operating_state() == "DISABLED", "a controller that is disabled")
        self.shows(lambda seen: seen.headline == ["grey"], "a grey headline")
        self.assertEqual(self.nodes.dead(), [])


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_alarms", ConsoleAlarmsTest)
