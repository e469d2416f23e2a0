#!/usr/bin/python3
"""Whichever node is killed (SIGKILL), in whatever state: within the time-outs of config/ the needle rests, the force on
the hand is zero and no pulse flows. In lock step, so that these are times of the session and hold to a tick or two."""

import numpy as np
import rospy
import rostest

from case import case
from killable_session import (BRIDGE, CONTROLLER_TIMEOUT, HAND, HAND_TIMEOUT, INJECT, INJECTOR, LINK, NEEDLE, OPERATOR,
                              RIG, SETPOINT, SLACK, STILL, TICK, KillCase)
from messages import position


class KillTest(KillCase):
    def test_hand(self):
        for phase, ticks in (("approach", 60), ("indent", 200)):
            with case(phase):
                self.by_hand()
                self.in_phase(phase, ticks)
                killed = self.kill("operator")
                self.check_needle(killed, HAND_TIMEOUT)
                self.check_force(killed, HAND_TIMEOUT, felt=phase == "indent")
                self.tearDown()

    def test_bridge(self):
        for phase, ticks in (("approach", 60), ("indent", 200), ("withdraw", 200)):
            with case(phase):
                self.by_hand()
                self.in_phase(phase, ticks)
                killed = self.kill("haptic_bridge")
                self.check_needle(killed, CONTROLLER_TIMEOUT)
                self.tearDown()

    def test_bridge_leaves_no_force_on_the_hand(self):
        self.by_hand()
        self.in_phase("hold", 60)
        killed = self.kill("haptic_bridge")
        self.session.catch_up(HAND)
        times, places = self.session.series(HAND, position)
        pressed = places[times <= killed][-1]
        self.assertGreater(pressed[2] - -8e-3, 1e-4, "the hand yields to the force")
        # Its acceleration leaps when the force does; else it changes little from tick to tick.
        since = (times > killed + 5 * TICK) & (times < killed + 0.1)
        leap = times[since][3:][np.abs(np.diff(places[since][:, 2], 3)).argmax()]
        self.assertAlmostEqual(leap - killed, OPERATOR["force_timeout"], delta=SLACK + TICK)
        self.assertAlmostEqual(places[-1][2], -8e-3, delta=0.1 * (pressed[2] - -8e-3))

    def test_controller(self):
        for phase, ticks in (("approach", 60), ("indent", 200), ("withdraw", 200)):
            with case(phase):
                self.by_hand()
                self.in_phase(phase, ticks)
                killed = self.kill("injection_controller", 400)
                self.check_needle(killed, RIG["command_timeout"])
                self.check_force(killed, BRIDGE["timeouts"]["controller"], earlier=0.1, felt=phase != "approach")
                self.tearDown()

    def test_micromanipulator(self):
        self.by_hand()
        self.in_phase("indent", 200)
        killed = self.kill("micromanipulator")
        self.check_needle(killed, CONTROLLER_TIMEOUT, SETPOINT, after=0)
        self.check_force(killed, BRIDGE["timeouts"]["needle"])

    def test_cell_simulator(self):
        self.by_hand()
        self.in_phase("indent", 200)
        killed = self.kill("cell_simulator")
        self.check_needle(killed, CONTROLLER_TIMEOUT)
        self.check_force(killed, BRIDGE["timeouts"]["predicted"])

    def test_hand_and_rig_apart(self):
        far, link = LINK["timeouts"]["controller"], LINK["link"]["timeout"]
        for node, rests, ends in (("injection_controller", RIG["command_timeout"], far),
                                  ("teleoperation_follower", CONTROLLER_TIMEOUT, link), ("haptic_bridge", link, None),
                                  ("operator", HAND_TIMEOUT, HAND_TIMEOUT)):
            with case(node):
                self.by_hand(linked=True)
                self.in_phase("indent", 200)
                killed = self.kill(node, 500)
                self.check_needle(killed, rests)
                if ends:
                    self.check_force(killed, ends, earlier=0.1 if node == "injection_controller" else 0)
                self.tearDown()

    def test_what_the_loop_does_not_need_leaves_it_as_it_is(self):
        self.by_hand(["force_sensor", "injector"])
        self.in_phase("indent", 50)
        for node in ("force_sensor", "injector"):
            killed = self.kill(node, 110)
            self.check_goes_on(killed)

    def test_controller_that_moves_by_itself(self):
        for state, ticks in (("approach", 100), ("indent", 60)):
            with case(state):
                self.by_itself()
                self.in_state(state, ticks)
                killed = self.kill("injection_controller")
                self.check_needle(killed, RIG["command_timeout"])
                self.tearDown()

    def check_no_pulse(self, killed, timeout):
        self.session.catch_up(INJECTOR)
        times, busy = self.session.series(INJECTOR, lambda message: message.busy)
        self.assertLessEqual(times[busy].max() - killed, timeout + SLACK)
        self.assertGreater(times[busy].max() - killed, 0)
        pressures = self.session.series(INJECTOR, lambda message: message.pressure)[1]
        self.assertAlmostEqual(pressures[-1], INJECT["balance"], delta=1)

    def check_rests(self, killed):
        """All the time since, and in the cell."""
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
        self.session.catch_up(NEEDLE)
        self.check_rests(killed)


if __name__ == "__main__":
    rospy.init_node("killer")
    rostest.rosrun("cell_microinjection", "kill", KillTest)
