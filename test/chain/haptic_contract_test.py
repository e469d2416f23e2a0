#!/usr/bin/python3
"""Each haptic device, emulated behind its driver's topics, does a whole injection: the needle follows while the dead-man
is held down, each time anew, and what the device renders on the hand is the force on the needle."""

import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import TimeReference

from cell_microinjection.msg import CellState, InjectionStatus, InjectorState, StringStamped
from messages import force, position
from participant import Participant

GAIN = 2e5  # config/haptic_bridge.yaml
STICKS = ("joy", "spacenav")  # they set a speed, and render no force
TRACES = {"/haptic/force_trace": "needle", "/needle/setpoint_trace": "hand"}  # what was measured before
LIMIT = 15000  # ticks


class HapticContractTest(unittest.TestCase):
    def setUp(self):
        self.driver = rospy.myargv()[1]
        traces = dict.fromkeys(TRACES, TimeReference) if self.driver == "crtk" else {}
        self.world = Participant({}, {
            "/needle/measured_cp": PoseStamped, "/cell/predicted_cf": WrenchStamped, "/cell/state": CellState,
            "/emulated_haptic/measured_cf": WrenchStamped, "/operator/phase": StringStamped,
            "/controller/injection_state": InjectionStatus, "/injector/state": InjectorState, **traces})
        self.states, self.rest = [], None
        self.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=1)
        self.world.await_links()

    def needle(self):
        return position(self.world.seen["/needle/measured_cp"])

    def felt(self):
        """N that the device renders on the hand."""
        return force(self.world.seen["/emulated_haptic/measured_cf"])

    def tick(self):
        self.world.tick()
        told = self.world.seen.get("/controller/injection_state")
        if told and told.state != "idle" and self.states[-1:] != [told.state]:
            self.states.append(told.state)

    def until(self, phase):
        """Ticks to the begin of a phase of the hand's motion."""
        for _ in range(LIMIT):
            told = self.world.seen.get("/operator/phase")
            if told and told.string == phase:
                return
            self.tick()
        level, why = self.world.status("haptic_bridge: loop")
        self.fail(f"phase {phase} never came; the bridge: {level} {why}; the injection: {self.states}")

    def test_a_whole_injection(self):
        self.until("rest")
        self.rest = self.needle()
        self.until("away")
        stroke = self.rest[2] - self.needle()[2]
        self.assertGreater(stroke, 2e-6, "the needle follows when the dead-man is held down first")
        self.assertLess(stroke, 6e-6)
        for _ in range(50):
            self.tick()
        held = self.needle()
        self.until("taken up")
        np.testing.assert_allclose(self.needle(), held, atol=5e-9, err_msg="let go, the needle stays")
        self.until("indent")
        self.assertGreater(held[2] - self.needle()[2], 15e-6, "and follows when it is held down again")
        self.check_felt_in_the_cell()
        self.until("inject")
        self.check_injection()
        self.until("done")
        self.check_out()

    def check_felt_in_the_cell(self):
        """What the hand feels before the membrane gives way is the force on the tip, in its direction."""
        sums, count, sideways = np.zeros(2), 0, 0.0
        while self.world.seen["/operator/phase"].string == "indent" and "punctured" not in self.states:
            self.tick()
            tip = force(self.world.seen["/cell/predicted_cf"])
            if not self.world.seen["/cell/state"].in_contact or tip[2] < 0.3e-6:
                continue
            count += 1
            sums += [self.felt()[2], GAIN * tip[2]]
            sideways = max(sideways, np.hypot(*self.felt()[:2]))
        self.assertGreater(count, 50, "the needle pressed the cell")
        if self.driver in STICKS:
            return self.assertEqual(sums[0], 0)
        # The mean, since the hand's own motion is damped (passivity, driver) and the device may be slow.
        self.assertAlmostEqual(sums[0] / sums[1], 1, delta=0.25)
        self.assertLess(sideways, 0.1 * sums[1] / count)
        for topic, source in TRACES.items() if self.driver == "crtk" else ():
            trace = self.world.seen[topic]
            self.assertEqual(trace.source, source)
            self.assertLessEqual(trace.time_ref, trace.header.stamp)
            self.assertLess((trace.header.stamp - trace.time_ref).to_sec(), 0.05)

    def check_injection(self):
        before = self.world.seen["/injector/state"].pulses
        # The stick's button is down as soon as the phase begins, and may be heard before it.
        self.assertEqual([state for state in self.states if state != "inject"][-1], "punctured")
        if self.driver not in STICKS:
            self.commands.publish(StringStamped(string="inject"))
        self.until("retract")
        self.assertIn("inject", self.states)
        self.assertEqual(self.world.seen["/injector/state"].pulses, before + 1)

    def check_out(self):
        self.assertEqual(self.states[self.states.index("indent"):],
                         ["indent", "punctured", "inject", "punctured", "withdraw", "approach"])
        self.assertTrue(self.world.seen["/cell/state"].punctured)
        self.assertFalse(self.world.seen["/cell/state"].in_contact)
        np.testing.assert_allclose(self.felt(), 0, atol=0.05)
        self.assertGreater(self.needle()[2], self.rest[2] - 35e-6)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_contract", HapticContractTest)
