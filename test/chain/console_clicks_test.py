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
from console_user import PATIENCE, START_PATIENCE, ConsoleUser
from live_chain import Master
from shown_controller import ShownController

CLICKS = 40
SEED = 7


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
        balances, resets = [], []
        state = rospy.Publisher("/injector/state", InjectorState, queue_size=1)
        timer = rospy.Timer(rospy.Duration(0.1), lambda _: state.publish(InjectorState()))
        self.addCleanup(timer.shutdown)
        listener = rospy.Subscriber("/injector/set_balance", FluidPressure, balances.append)
        self.addCleanup(listener.unregister)

        def reset(_):
            resets.append(True)
            return TriggerResponse(success=True)
        service = rospy.Service("/injector/reset", Trigger, reset)
        self.addCleanup(service.shutdown)

        def row():
            rows = console_eye.rows_of_offered(self.picture, 2) if self.look() else []
            return rows[0][-2:] if rows else None
        set_button, reset_button = self.until(row, "two buttons of the injector")
        self.click(set_button)
        self.until(lambda: balances, "a balance pressure")
        self.assertEqual(balances[0].fluid_pressure, 545)
        x, y = set_button
        self.click((x - 80, y))
        self.do("key", "ctrl+a")
        self.do("type", "605")
        self.do("key", "Return")
        self.click(set_button)
        self.until(lambda: len(balances) == 2, "another balance pressure")
        self.assertEqual(balances[1].fluid_pressure, 605)
        self.assertAlmostEqual(balances[1].header.stamp.to_sec(), rospy.Time.now().to_sec(), delta=PATIENCE)
        self.click(reset_button)
        self.until(lambda: resets, "a reset")
        timer.shutdown()
        self.until(lambda: self.look() and not console_eye.rows_of_offered(self.picture, 2), "greyed buttons of a silent injector")

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
