#!/usr/bin/python3
"""The action Inject: approach, puncture, injection, withdrawal; and from wherever it is cancelled the needle comes out."""

import threading

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from cell_microinjection.msg import InjectAction, InjectGoal

from injection_chain import InjectionChainTest

PUNCTURE = 1.2e-6  # N, of the zona in injected_oocyte.yaml
GOAL = {"puncture": True, "layers": 1, "depth": 15e-6, "margin": 2e-6, "hold_time": 0.1, "pressure": 20e3, "duration": 0.3}
ENDED = (GoalStatus.SUCCEEDED, GoalStatus.PREEMPTED, GoalStatus.ABORTED)


class InjectTest(InjectionChainTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.client = actionlib.SimpleActionClient("/controller/inject", InjectAction)
        cls.chain.await_links()
        # The server's status comes with ticks.
        waiting = threading.Thread(target=cls.client.wait_for_server)
        waiting.start()
        while waiting.is_alive():
            cls.chain.tick()

    def send(self, **changes):
        type(self).states = []
        type(self).told = []
        self.client.send_goal(InjectGoal(**{**GOAL, **changes}), feedback_cb=self.on_feedback)

    @classmethod
    def on_feedback(cls, feedback):
        now = feedback.state, feedback.layer, feedback.layers
        if not cls.told or cls.told[-1] != now:
            cls.told.append(now)

    def result(self):
        # The status may come before the result.
        self.tick_until(lambda: self.client.get_state() in ENDED and self.client.get_result(), "the result")
        return self.client.get_state(), self.client.get_result()

    def test_1_a_goal_that_cannot_be_is_aborted_with_the_reason(self):
        start = self.needle()
        for changes, why in (({"layers": 0}, "layers = 0"), ({"depth": 1.0}, "depth is above depth_limit"),
                             ({"depth": float("nan")}, "depth = nan")):
            self.send(**changes)
            state, result = self.result()
            self.assertEqual((state, result.outcome), (GoalStatus.ABORTED, "refused"))
            self.assertIn(why, result.reason)
        np.testing.assert_array_equal(self.needle(), start)

    def test_2_cancelled_while_it_indents_it_withdraws(self):
        start = self.needle()
        self.send()
        self.tick_until(lambda: self.status().state == "indent" and self.status().depth > 1e-6, "an indentation")
        self.assertGreater(self.chain.seen["/cell/state"].force.z, 0)
        at = self.needle()[2]
        self.client.cancel_goal()
        lowest = at
        for _ in range(200):
            self.chain.tick()
            lowest = min(lowest, self.needle()[2])
        self.assertGreater(lowest, at - 0.5e-6, "it goes no deeper")
        self.assertEqual(self.status().state, "withdraw")
        state, result = self.result()
        self.assertEqual((state, result.outcome, result.punctures), (GoalStatus.PREEMPTED, "preempted", 0))
        self.check_out(start)
        self.assertFalse(self.chain.seen["/cell/state"].punctured)

    def test_3_a_whole_injection(self):
        start, before = self.needle(), self.chain.seen["/injector/state"]
        self.send()
        state, result = self.result()
        self.assertEqual((state, result.outcome, result.reason), (GoalStatus.SUCCEEDED, "injected", ""))
        self.chain.run(300)
        self.check_out(start)
        passed = [name for name in self.states if name != "idle"]
        self.assertEqual(passed, ["approach", "contact", "indent", "punctured", "inject", "punctured", "withdraw"])
        self.assertEqual(result.punctures, 1)
        self.assertAlmostEqual(result.puncture_force / PUNCTURE, 1, delta=0.05)
        self.assertGreaterEqual(result.max_depth, result.puncture_depth + 1.9e-6)
        cell, injector = self.chain.seen["/cell/state"], self.chain.seen["/injector/state"]
        self.assertTrue(cell.punctured)
        self.assertEqual((len(cell.holes), cell.inside), (1, False))
        self.assertEqual(injector.pulses, before.pulses + 1)
        # What the pressure's fall after the pulse pushes out is not the pulse's.
        self.assertAlmostEqual(result.volume / (injector.volume - before.volume), 1, delta=0.1)
        self.assertGreater(result.volume, 0)

    def test_4_cancelled_while_it_injects_the_pulse_stops_and_it_withdraws(self):
        self.move_aside(8e-6)  # of the hole
        start, pulses = self.needle(), self.chain.seen["/injector/state"].pulses
        self.send(duration=30.0)
        self.tick_until(lambda: self.chain.seen["/injector/state"].busy, "a pulse")
        self.chain.run(100)
        self.assertEqual(self.status().state, "inject")
        self.client.cancel_goal()
        self.tick_until(lambda: self.status().state == "withdraw", "the withdrawal")
        self.chain.run(5)
        self.assertFalse(self.chain.seen["/injector/state"].busy)
        state, result = self.result()
        self.assertEqual((state, result.outcome, result.punctures), (GoalStatus.PREEMPTED, "preempted", 1))
        self.check_out(start)
        self.assertEqual(self.chain.seen["/injector/state"].pulses, pulses)

    def test_5_through_two_membranes(self):
        """States and feedback tell of each; the injector works behind the last."""
        self.move_aside(-16e-6)  # where no hole is
        start, pulses = self.needle(), self.chain.seen["/injector/state"].pulses
        self.send(layers=2)
        # The state between the membranes lasts one tick; the count stays.
        self.tick_until(lambda: self.status().punctures > 0, "the first puncture")
        self.assertEqual(self.status().punctures, 1)
        self.tick_until(lambda: self.status().punctures == 2, "the second puncture")
        self.assertEqual(self.status().state, "punctured")
        # The cell tells its state 60 times a second.
        self.tick_until(lambda: self.chain.seen["/cell/state"].layers_punctured == 2, "the cell's word of both", 50)
        self.assertEqual(self.chain.seen["/injector/state"].pulses, pulses)
        state, result = self.result()
        self.assertEqual((state, result.outcome, result.punctures), (GoalStatus.SUCCEEDED, "injected", 2))
        self.check_out(start)
        self.assertEqual([name for name in self.states if name != "idle"],
                         ["approach", "contact", "indent", "punctured", "indent", "punctured", "inject", "punctured",
                          "withdraw"])
        # Feedback comes each 0.1 s: it may miss what is shorter.
        self.assertIn(("indent", 1, 2), self.told)
        self.assertIn(("indent", 2, 2), self.told)
        self.assertIn(("inject", 3, 2), self.told)
        self.assertEqual(self.told, sorted(self.told, key=lambda one: one[1]), "layers only go up")


if __name__ == "__main__":
    rospy.init_node("asker")
    # With a rig of another kind the same whole injection; what the controller does besides does not depend on the rig.
    chosen = InjectTest if rospy.myargv()[1] == "sim" else "__main__.InjectTest.test_3_a_whole_injection"
    rostest.rosrun("cell_microinjection", "inject", chosen)
