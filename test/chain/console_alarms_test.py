#!/usr/bin/python3
"""Each alarm of the operator's console, provoked in a live chain, as the picture of the console shows it, and what its
buttons do meanwhile. The test is the hand, which goes where it is sent."""

import contextlib
import unittest
from pathlib import Path

import rospy
import rostest
from cell_microinjection.msg import InjectionStatus, LoopState, OperatingState
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Joy
from std_msgs.msg import Bool

import console_eye
from console_user import ConsoleUser
from killable_nodes import parameters
from live_chain import RATE, TIMEOUT, Hand, LiveChain, Master
from messages import pose
from processes import Child

ABOVE, AT_CELL = 0.0, -30e-3  # m of the hand: 32 um and 2 um above the cell
FAR = 100e-3                  # m of the hand: through every guard, or out of the cell
DEPTH_LIMIT = 3e-6            # m
FORCE_LIMIT = 0.5e-6          # N: the cell yields 10 um until then
NEEDLE_SPEED_LIMIT = 50e-6    # m/s


class SteeredHand(Hand):
    """Goes to `goal` (m, up) at `speed` (m/s), or is silent."""

    def __init__(self):
        self.goal, self.speed, self.silent = ABOVE, 20e-3, False
        self.height = ABOVE
        super().__init__()

    def _run(self):
        while not self._ended.is_set() and not rospy.is_shutdown():
            step = self.speed / RATE
            self.height += min(step, max(-step, self.goal - self.height))
            if not self.silent:
                message = pose(0, 0, self.height, "haptic")
                message.header.stamp = rospy.Time.now()
                self._publisher.publish(message)
                self._clutch.publish(Joy(header=message.header, buttons=[0]))
            rospy.rostime.wallsleep(1 / RATE)


def controller(**changes):
    """The chain's controller with these parameters instead; its own injections are not begun."""
    return parameters("injection_controller", rate=RATE, input_timeout=TIMEOUT, auto_enable=True, goal={"depth": DEPTH_LIMIT},
                      **changes)


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
        cls.chain = LiveChain({"injection_controller": controller(depth_limit=DEPTH_LIMIT), "microscope": microscope()},
                              hand=SteeredHand)
        for topic, kind in (("/controller/operating_state", OperatingState), ("/controller/loop_state", LoopState),
                            ("/controller/injection_state", InjectionStatus), ("/needle/measured_cp", PoseStamped)):
            cls.chain.follow(topic, kind)
        cls.nodes, cls.hand = cls.chain.nodes, cls.chain.hand

    @classmethod
    def tearDownClass(cls):
        cls.chain.close()
        cls.frames.stop(5)
        cls.close_console()
        cls.master.kill()

    def report(self):
        status = self.chain.newest.get("/controller/injection_state")
        return f"{self.operating_state()}, held: {self.held_by()}, {status}, {super().report()}; {self.nodes.report()}"

    def operating_state(self):
        message = self.chain.newest.get("/controller/operating_state")
        return message.state if message else None

    def held_by(self):
        message = self.chain.newest.get("/controller/loop_state")
        return message.hold_reason if message else None

    def is_held(self, reason):
        """What the console shows has come through another connection."""
        self.until(lambda: reason in (self.held_by() or ""), f"a needle that is held by: {reason}")

    def operating(self, state):
        self.until(lambda: self.operating_state() == state, state)

    def shows_red(self, *wanted, headline="green"):
        """These lamps are red, no other one is, and the headline is as it should."""
        def right(seen):
            red = {name for name, colour in seen.lamps.items() if colour == "red"}
            return len(seen.lamps) == len(console_eye.ROWS[self.console]) and red == set(wanted) and seen.headline == [headline]
        return self.shows(right, f"red lamps {wanted} below a {headline} headline")

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

    def stop(self):
        before = len(self.sent)
        self.click(self.shows(lambda seen: True, "its buttons").stop)
        self.until(lambda: len(self.sent) > before, "a command of STOP")

    def restart_controller(self, **changes):
        self.nodes.begin({"injection_controller": controller(**changes)})
        self.operating("ENABLED")

    def follows(self, goal):
        """The hand goes there, and the needle with it."""
        begin = self.chain.needle()[2]
        self.hand.goal = goal
        self.until(lambda: abs(self.chain.needle()[2] - begin) > 0.5e-6, "a needle that follows")

    def test_1_devices_that_the_needle_does_not_need(self):
        def complete(seen):
            absent = [name for name, colour in seen.lamps.items() if colour in ("grey", "red")]
            return (seen.headline == ["green"] and absent == ["Switch"]
                    and (seen.lamps["Needle"], seen.lamps["Clutch"]) == ("green", "green"))
        self.shows(complete, "all nodes of the session, and a needle that follows")
        with self.frozen("force_sensor", "microscope"), self.killed("injector"):
            self.shows_red("Sensor", "Camera", "Injector")
            self.follows(AT_CELL)
        self.shows_red()

    def test_2_a_silent_hand(self):
        self.hand.silent = True
        self.shows(lambda seen: seen.lamps.get("Needle") == "yellow", "a needle that is held")
        self.hand.silent = False
        self.shows(lambda seen: seen.lamps.get("Needle") == "green", "a needle that follows")

    def test_3_a_simulator_that_hangs_and_one_that_dies(self):
        """The virtual microscope has nothing to show without one."""
        with self.frozen("cell_simulator"):
            self.shows_red("Cell", "Camera", headline="yellow")
            self.until(lambda: self.held_by() == "no valid force", "a needle that is held")
            self.stop()
            self.operating("PAUSED")
            self.press("Enable")  # it is Resume now
            self.operating("ENABLED")
            self.shows_red("Cell", "Camera", headline="yellow")
        self.shows_red()
        with self.killed("cell_simulator"), self.killed("haptic_bridge"):
            self.shows_red("Needle", "Hand", "Cell", "Camera", headline="yellow")
            self.press("Disable")
            self.operating("DISABLED")
        self.press("Enable")
        self.operating("ENABLED")
        self.shows_red()

    def test_4_a_rig_that_hangs(self):
        with self.frozen("micromanipulator"):
            self.shows_red("Rig", headline="yellow")
            self.until(lambda: self.held_by() == "no valid needle position", "a needle that is held")
        self.shows_red()

    def press_down(self):
        """From where the hand is: what it did while the needle was held has displaced it from the needle."""
        self.hand.goal = self.hand.height - FAR

    def test_5_the_guard_of_the_depth(self):
        self.press_down()
        self.shows(lambda seen: seen.guards == {"Force": "green", "Depth": "red"} and seen.headline == ["yellow"],
                   "the depth's guard")
        self.is_held("depth past the touch")
        self.stop()
        self.operating("PAUSED")
        self.press("Enable")
        self.operating("ENABLED")
        begin = self.chain.needle()[2]
        self.hand.goal = self.hand.height + FAR  # the only way that is left
        self.shows(lambda seen: seen.guards["Depth"] in ("empty", "green") and seen.headline == ["green"], "a free needle")
        # Well out of the cell: the controller of the next test measures the force at rest.
        self.until(lambda: self.chain.needle()[2] - begin > 20e-6, "a needle above the cell")

    def test_6_a_controller_that_dies_and_the_guard_of_the_force(self):
        self.nodes.kill("injection_controller")
        seen = self.shows(lambda seen: seen.headline == ["red"], "a red headline")
        self.assertFalse(any(seen.offered.values()))
        self.restart_controller(force_limit=FORCE_LIMIT)
        self.shows(lambda seen: seen.headline == ["green"], "a controller that is back")
        self.press_down()
        self.shows(lambda seen: seen.guards["Force"] == "red" and seen.guards["Depth"] != "red" and seen.headline == ["yellow"],
                   "the force's guard")
        self.is_held("force along the pipette")
        self.press("Disable")
        self.operating("DISABLED")
        self.shows(lambda seen: seen.headline == ["grey"], "a grey headline")

    def test_7_a_needle_that_is_too_fast(self):
        self.nodes.kill("injection_controller")
        self.restart_controller(needle_speed_limit=NEEDLE_SPEED_LIMIT)
        # The motion is over in 0.4 s: who follows later would not see it.
        self.until(lambda: self.held_by() == "", "a needle that follows the hand")
        self.hand.speed, self.hand.goal = 90e-3, self.hand.height + 30e-3
        self.operating("FAULT")
        # It is red for a controller that was not heard for 1 s, too, and then nothing is offered.
        self.shows(lambda seen: seen.headline == ["red"] and
                   [name for name, offered in seen.offered.items() if offered] == ["Enable", "Disable"],
                   "a red headline, Enable and Disable offered")
        self.is_held("the needle moves at")
        self.press("Enable")
        self.operating("ENABLED")
        self.shows(lambda seen: seen.headline == ["green"], "a needle that is free again")

    def test_7b_the_cable_of_an_emulated_network(self):
        """Without such a network there are no such buttons."""
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
        for offered, wanted in ((2, [False]), (1, [False, True]), (1, [False, True, False])):
            place = self.until(lambda offered=offered: self.uppermost(places() - before, offered), f"{offered} more buttons")
            self.click(place)
            self.until(lambda wanted=wanted: said == wanted, f"{wanted} on /link/plugged")
        network.stop(5)
        self.until(lambda: places() == before, "no buttons of a network that is gone")
        heard.unregister()

    @staticmethod
    def uppermost(places, number):
        """Returns the uppermost of so many places, None where there are fewer or more."""
        return min(places, key=lambda place: place[1]) if len(places) == number else None

    def test_8_a_controller_that_hangs(self):
        with self.frozen("injection_controller"):
            seen = self.shows(lambda seen: seen.headline == ["red"], "a red headline")
            self.assertFalse(any(seen.offered.values()))
            self.stop()
            self.assertEqual(self.sent[-1], "disable")
        self.operating("DISABLED")
        self.shows(lambda seen: seen.headline == ["grey"], "a grey headline")
        self.assertEqual(self.nodes.dead(), [])


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_alarms", ConsoleAlarmsTest)
