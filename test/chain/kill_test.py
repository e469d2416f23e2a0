#!/usr/bin/python3
"""A hand leads the needle. Whichever node is killed (SIGKILL), or with the argument freeze frozen (SIGSTOP), in whatever
state: within the time-outs of config/ the needle rests and the force on the hand is zero. In lock step, so that these are
times of the session and hold to a tick or two."""
import numpy as np
import rospy
import rostest

from case import case
from killable_session import (BRIDGE, CONTROLLER_TIMEOUT, HAND, HAND_TIMEOUT, LINK, OPERATOR, RIG, SETPOINT, SLACK,
                              TICK, KillCase)
from messages import position

# Without and with a force. The way back is the same to every time-out: nobody knows of the hand's phases.
PHASES = ("approach", 60), ("indent", 200)


class KillTest(KillCase):
    def test_hand(self):
        for phase, ticks in self.cases(*PHASES):
            with case(phase):
                self.by_hand()
                self.in_phase(phase, ticks)
                killed = self.kill("operator")
                self.check_needle(killed, HAND_TIMEOUT)
                self.check_force(killed, HAND_TIMEOUT, felt=phase == "indent")
                self.tearDown()

    def test_bridge(self):
        for phase, ticks in self.cases(*PHASES):
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
        for phase, ticks in self.cases(*PHASES):
            with case(phase):
                self.by_hand()
                self.in_phase(phase, ticks)
                killed = self.kill("injection_controller", 400)
                self.check_needle(killed, RIG["command_timeout"])
                self.check_force(killed, BRIDGE["timeouts"]["controller"], earlier=0.1, felt=phase != "approach")
                self.tearDown()

    def test_micromanipulator(self):
        for phase, ticks in self.cases(*PHASES):
            with case(phase):
                self.by_hand()
                self.in_phase(phase, ticks)
                killed = self.kill("micromanipulator")
                self.check_needle(killed, CONTROLLER_TIMEOUT, SETPOINT, after=0)
                self.check_force(killed, BRIDGE["timeouts"]["needle"], felt=phase != "approach")
                self.tearDown()

    def test_who_tells_the_force(self):
        for node, source, phase, ticks in [*(("cell_simulator", "predicted", *each) for each in self.cases(*PHASES)),
                                           ("force_sensor", "measured", "indent", 200)]:
            with case(node, phase):
                self.by_hand(["force_sensor"] if source == "measured" else [], source=source)
                self.in_phase(phase, ticks)
                killed = self.kill(node)
                self.check_needle(killed, CONTROLLER_TIMEOUT)
                self.check_force(killed, BRIDGE["timeouts"][source], felt=phase != "approach")
                self.tearDown()

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

    def test_who_wakes_up_ends(self):
        """It would take part with what it knew when it was frozen."""
        if not self.FREEZES:
            return
        for node in ("injection_controller", "micromanipulator", "haptic_bridge"):
            with case(node):
                self.by_hand()
                self.in_phase("approach", 60)
                self.kill(node)
                self.assertEqual(self.session.nodes.wake_up(node), 0)
                self.session.chain.run(100)
                self.tearDown()


if __name__ == "__main__":
    rospy.init_node("killer")
    rostest.rosrun("cell_microinjection", "kill", KillTest)
