#!/usr/bin/python3
"""Each click on an offered button of the operator's console sends its command, whatever changes meanwhile."""

import random
import threading
import time
import unittest

import actionlib
import rospy
import rostest
from cell_microinjection.msg import InjectAction, InjectFeedback, InjectorState, InjectResult
from sensor_msgs.msg import FluidPressure
from std_srvs.srv import Trigger, TriggerResponse

import console_eye
from console_user import START_PATIENCE, ConsoleUser
from live_chain import Master
from shown_controller import ShownController

CLICKS = 40
SEED = 7


class ShownInjector:
    """The messages and the service of an injector."""

    def __init__(self):
        self.balances, self.resets, self.busy = [], [], False
        state = rospy.Publisher("/injector/state", InjectorState, queue_size=1)
        listener = rospy.Subscriber("/injector/set_balance", FluidPressure,
                                    lambda message: self.balances.append(message.fluid_pressure))
        service = rospy.Service("/injector/reset", Trigger, self._reset)
        timer = rospy.Timer(rospy.Duration(0.1), lambda _: state.publish(InjectorState(busy=self.busy)))
        self._ends = [timer.shutdown, listener.unregister, service.shutdown]

    def _reset(self, _):
        self.resets.append(True)
        return TriggerResponse(success=True)

    def close(self):
        while self._ends:
            self._ends.pop(0)()


class ConsoleClicksTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("injection_controller")  # which the .test names it, too: the console sends nothing to others
        cls.controller = ShownController(mode="automatic", force_limit="2e-5", depth_limit="60 um")
        cls.open_console()

    @classmethod
    def tearDownClass(cls):
        cls.controller.close()
        cls.close_console()
        cls.master.kill()

    def test_1_every_click_is_a_command(self):
        place = self.shows(lambda seen: seen.offered["Enable"], "Enable", START_PATIENCE).place
        for i in range(CLICKS):
            button = "Enable" if self.controller.state == "DISABLED" else "Disable"
            console = self.shows(lambda seen, button=button: seen.offered[button], f"{button} offered")
            self.assertEqual(console.place, place)
            before = len(self.sent)
            self.click(place[button])
            self.until(lambda before=before: len(self.sent) > before, f"the command of click {i}")
        self.assertEqual(self.sent, ["enable", "disable"] * (CLICKS // 2))

    def test_2_a_click_outlasts_a_refusal_between_press_and_release(self):
        """The offer comes and goes while the button is down; it counts what is offered at the release."""
        rng = random.Random(SEED)
        place = self.shows(lambda seen: seen.offered["Enable"], "Enable").place
        for i in range(CLICKS // 4):
            self.do("mousemove", *place["Enable"])
            self.do("mousedown", 1)
            for state in ("ENABLED", "DISABLED"):  # greyed, then offered again
                time.sleep(rng.uniform(0.1, 0.3))
                self.controller.change(state)
            time.sleep(0.2)
            before = len(self.sent)
            self.do("mouseup", 1)
            self.until(lambda before=before: len(self.sent) > before, f"the command of click {i}")
            self.assertEqual(self.sent[-1], "enable")
            self.controller.change("DISABLED")
            self.shows(lambda seen: seen.offered["Enable"], "Enable offered")

    def test_3_limits_that_are_text_are_read_or_shown(self):
        self.controller.status.guard_force = 18e-6  # 90 % of 2e-5
        seen = self.shows(lambda seen: seen.guards.get("Force") == "yellow", "a force near its limit")
        self.assertEqual(seen.guards["Depth"], "empty")
        self.controller.change("ENABLED")
        self.shows(lambda seen: seen.headline == ["yellow"], "a headline that names the limit which is no number")
        self.controller.status.guard_force = 0.0
        self.controller.change("DISABLED")

    def test_4_an_automatic_injection_has_a_button(self):
        goals, ended = [], threading.Event()
        self.addCleanup(ended.set)

        def inject(goal):
            goals.append(goal)
            while not server.is_preempt_requested() and not ended.wait(0.05):
                server.publish_feedback(InjectFeedback(state="indent", layer=1, layers=2, depth=3e-6, force=1e-6))
            if server.is_preempt_requested():
                server.set_preempted(InjectResult(outcome="preempted"))
            else:
                server.set_succeeded(InjectResult(outcome="injected", punctures=2, volume=5e-15))
        server = actionlib.SimpleActionServer("/controller/inject", InjectAction, inject, auto_start=False)
        server.start()
        self.controller.change("ENABLED")

        def button(count):
            def check():
                console = self.look()
                buttons = console_eye.offered_right_of(console.stop_right, self.picture) if console else []
                return buttons[0] if len(buttons) == count else None
            return self.until(check, f"{count} offered buttons of the automatic injection")

        def lamp(colour):
            self.shows(lambda seen: console_eye.has_lamp(colour, seen.stop_right, self.picture), f"a {colour} lamp")
        self.click(button(1))
        self.until(lambda: goals, "a goal")
        self.assertTrue(goals[0].configured)
        lamp("yellow")
        self.click(button(1))  # Cancel: Start is greyed
        lamp("red")
        self.click(button(1))
        self.until(lambda: len(goals) == 2, "another goal")
        ended.set()
        lamp("green")
        self.controller.change("DISABLED")

    def test_5_the_injector_is_set_and_reset(self):
        rospy.set_param("/injector/balance", 545)
        injector = ShownInjector()
        self.addCleanup(injector.close)

        def offered(count):
            """The injector's buttons, of which so many are offered."""
            def check():
                console = self.look()
                rows = console_eye.rows_of_offered(self.picture, 1) if console else []
                places = [place for row in rows for place in row if place[0] > console.stop_right]
                return (places,) if len(places) == count else None
            return self.until(check, f"{count} offered buttons of the injector")[0]

        def sets(pressure):
            self.until(lambda: injector.balances, "a balance pressure")
            self.assertEqual(injector.balances.pop(), pressure)
        set_button, reset_button = offered(2)
        self.click(set_button)
        sets(545)
        x, y = set_button
        self.click((x - 80, y))
        self.do("key", "ctrl+a")
        self.do("type", "605")
        offered(2)
        self.click(set_button)  # without Enter
        sets(605)
        offered(2)
        self.click(reset_button)
        self.until(lambda: injector.resets, "a reset")
        injector.busy = True
        self.assertEqual(offered(1), [set_button])
        injector.busy = False
        offered(2)
        # The space bar stops while the field has the focus.
        before = len(self.sent)
        self.click((x - 80, y))
        self.do("type", "7")
        self.do("key", "space")
        self.until(lambda: len(self.sent) > before, "a command of the space bar")
        injector.close()
        offered(0)

    def test_6_nothing_is_offered_before_the_controller_listens(self):
        """What is sent before is lost."""
        self.listener.unregister()
        self.controller.deafen()
        self.shows(lambda seen: seen.headline == ["grey"] and not any(seen.offered.values()), "greyed buttons")
        self.controller.listen()
        place = self.shows(lambda seen: seen.offered["Enable"], "Enable offered").place
        self.click(place["Enable"])
        self.until(lambda: self.controller.state == "ENABLED", "an enabled controller")


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_clicks", ConsoleClicksTest)
