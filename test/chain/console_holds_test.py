#!/usr/bin/python3
"""A whole injection with two pipettes and two pressures by the mouse, in a live session: the test is the hand."""

import unittest

import rospy
import rostest
from cell_microinjection.msg import InjectionStatus

import console_eye
from console_user import ConsoleUser
from live_chain import Master

SESSION = ("session:=icsi", "mode:=semi_automatic", "set:=rate=200")  # Hz: not each machine keeps 1 kHz
# Which button is pressed, and where it leads to.
STEPS = (("Hold", "hold"), ("Approach", "contact"), ("Indent", "indent"), ("Aspirate", "punctured"), ("Inject", "punctured"),
         ("Withdraw", "release"), ("Release", "idle"))


class ConsoleHoldsTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("operator_of_two_pipettes")
        cls.status, cls.passed = InjectionStatus(), []
        cls.injections = rospy.Subscriber("/controller/injection_state", InjectionStatus, cls.hear)
        cls.open_console(session=SESSION, buttons=console_eye.HOLDING)

    @classmethod
    def tearDownClass(cls):
        cls.close_console()
        cls.master.kill()

    @classmethod
    def hear(cls, status):
        if status.state != cls.status.state:
            cls.passed.append(status.state)
        cls.status = status

    def report(self):
        return f"{self.passed}, {self.status}, {super().report()}"

    def test_the_whole_injection(self):
        def arrived(state):
            return self.status.state == state and (self.status.waits or state == "idle")
        self.shows(lambda seen: seen.offered["Hold"] or seen.offered["Enable"], "a session at rest")
        if self.look().offered["Enable"]:
            self.press("Enable")
        for button, state in STEPS:
            self.press(button)
            self.until(lambda state=state: arrived(state), f"{state} after {button}")
        self.assertEqual(self.status.outcome, "injected", self.report())
        self.assertEqual(self.sent[-len(STEPS):], [button.lower() for button, _ in STEPS])
        self.assertEqual(self.passed[-10:], ["hold", "approach", "contact", "indent", "aspirate", "punctured", "inject", "punctured",
                                             "withdraw", "release", "idle"][-10:])


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_holds", ConsoleHoldsTest)
