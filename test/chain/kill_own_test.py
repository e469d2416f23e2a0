#!/usr/bin/python3
"""The controller injects of its own. Whichever node is killed (SIGKILL), or with the argument freeze frozen (SIGSTOP),
in whatever state: within the time-outs of config/ the needle rests and no pulse flows. In lock step."""

import numpy as np
import rospy
import rostest

from case import case
from cell_microinjection.msg import StringStamped
from killable_session import (CONTROLLER_TIMEOUT, INJECT, INJECTOR, NEEDLE, RIG, SETPOINT, SLACK, START, STILL,
                              KillCase)
from messages import position


class KillOwnTest(KillCase):
    def in_course(self, state, ticks):
        """A session some ticks into a state; of withdraw: given up while it indents."""
        self.by_itself()
        self.in_state("indent" if state == "withdraw" else state, ticks)
        if state == "withdraw":
            self.session.commands.publish(StringStamped(string="withdraw"))
            self.in_state("withdraw", ticks)

    def test_controller(self):
        for state, ticks in self.cases(("approach", 100), ("indent", 60), ("withdraw", 60)):
            with case(state):
                self.in_course(state, ticks)
                killed = self.kill("injection_controller")
                self.check_needle(killed, RIG["command_timeout"])
                self.tearDown()

    def test_micromanipulator(self):
        for state, ticks in self.cases(("approach", 100), ("indent", 60), ("withdraw", 60)):
            with case(state):
                self.in_course(state, ticks)
                killed = self.kill("micromanipulator")
                self.check_needle(killed, CONTROLLER_TIMEOUT, SETPOINT, after=0)
                self.tearDown()

    def test_cell_simulator(self):
        for state, ticks in self.cases(("approach", 100), ("indent", 60)):
            with case(state):
                self.in_course(state, ticks)
                killed = self.kill("cell_simulator")
                self.check_needle(killed, CONTROLLER_TIMEOUT)
                self.tearDown()

    def test_no_force_is_needed_to_withdraw(self):
        self.in_course("withdraw", 60)
        killed = self.kill("cell_simulator", 60)
        self.session.until(lambda: self.session.says("/controller/injection_state", "state", "idle"), "the way out",
                           ticks=10000)
        self.session.chain.run(100)
        self.session.catch_up(NEEDLE)
        times, places = self.session.series(NEEDLE, position)
        heights = places[times > killed][:, 2]
        self.assertGreater(np.diff(heights).min(), -STILL, "never deeper")
        self.assertGreater(heights[-1], START - STILL, "it is out")

    def check_no_pulse(self, killed, timeout):
        self.session.catch_up(INJECTOR)
        times, busy = self.session.series(INJECTOR, lambda message: message.busy)
        self.assertLessEqual(times[busy].max() - killed, timeout + SLACK)
        self.assertGreater(times[busy].max() - killed, 0)
        pressures = self.session.series(INJECTOR, lambda message: message.pressure)[1]
        self.assertAlmostEqual(pressures[-1], INJECT["balance"], delta=1)

    def check_rests(self, killed):
        """All the time since, and in the cell."""
        self.session.catch_up(NEEDLE)
        times, places = self.session.series(NEEDLE, position)
        self.assertLess(np.ptp(places[times > killed][:, 2]), STILL)
        self.assertLess(places[-1][2], 28e-6)

    def test_pulse(self):
        """It ends with the one who asked for it, and where it is not known any more what is injected into."""
        for node, timeout in (("injection_controller", INJECT["pulse_timeout"]),
                              ("micromanipulator", CONTROLLER_TIMEOUT), ("cell_simulator", CONTROLLER_TIMEOUT)):
            with case(node):
                self.by_itself()
                self.in_state("inject", 100)
                killed = self.kill(node, 320)
                self.check_no_pulse(killed, timeout + SLACK)
                if node != "micromanipulator":
                    self.check_rests(killed)
                self.tearDown()

    def test_injector_that_dies_in_a_pulse_leaves_the_needle_where_it_is(self):
        self.by_itself()
        self.in_state("inject", 100)
        killed = self.kill("injector")
        self.check_rests(killed)


if __name__ == "__main__":
    rospy.init_node("killer")
    rostest.rosrun("cell_microinjection", "kill_own", KillOwnTest)
