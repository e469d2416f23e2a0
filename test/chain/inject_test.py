#!/usr/bin/python3
"""The action Inject: approach, puncture, injection, withdrawal; and from wherever it is cancelled the needle comes out."""

import threading
import unittest

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from cell_microinjection.msg import (CellState, InjectAction, InjectGoal, InjectionStatus, InjectorState, OperatingState,
                                     StringStamped)
from geometry_msgs.msg import PoseStamped

from messages import pose, position
from participant import Participant

PUNCTURE = 1.2e-6  # N, of the zona in injected_oocyte.yaml
GOAL = {"puncture": True, "layers": 1, "depth": 15e-6, "margin": 2e-6, "hold_time": 0.1, "pressure": 20e3, "duration": 0.3}
ENDED = (GoalStatus.SUCCEEDED, GoalStatus.PREEMPTED, GoalStatus.ABORTED)


class InjectTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Participant({}, {"/needle/measured_cp": PoseStamped, "/injector/state": InjectorState,
                                     "/cell/state": CellState, "/controller/injection_state": InjectionStatus,
                                     "/controller/operating_state": OperatingState})
        cls.states = []
        cls.listener = rospy.Subscriber("/controller/injection_state", InjectionStatus, cls.on_status)
        cls.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=10)
        cls.moves = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=10)
        cls.client = actionlib.SimpleActionClient("/controller/inject", InjectAction)
        # The server's status comes with ticks.
        waiting = threading.Thread(target=cls.client.wait_for_server)
        waiting.start()
        while waiting.is_alive() or not (cls.commands.get_num_connections() and cls.moves.get_num_connections()):
            cls.chain.tick()
        cls.chain.run(50)

    @classmethod
    def on_status(cls, message):
        if not cls.states or cls.states[-1] != message.state:
            cls.states.append(message.state)

    def needle(self):
        return position(self.chain.seen["/needle/measured_cp"])

    def status(self):
        return self.chain.seen["/controller/injection_state"]

    def tick_until(self, condition, what, ticks=30000):
        for _ in range(ticks):
            if condition():
                return
            self.chain.tick()
        self.fail(f"{what}: not within {ticks} ticks; the injection is in {self.status()}")

    def send(self, **changes):
        type(self).states = []
        self.client.send_goal(InjectGoal(**{**GOAL, **changes}))

    def result(self):
        # The status may come before the result.
        self.tick_until(lambda: self.client.get_state() in ENDED and self.client.get_result(), "the result")
        return self.client.get_state(), self.client.get_result()

    def check_out(self, start):
        """The needle is where it set out, the controller ready for the next one."""
        np.testing.assert_allclose(self.needle(), start, atol=0.1e-6)
        self.tick_until(lambda: self.status().state == "idle", "idle", 200)  # its message may come after the result
        self.assertEqual(self.chain.seen["/controller/operating_state"].state, "ENABLED")

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
        for command in ("disable", "enable"):  # beside the hole
            self.commands.publish(StringStamped(string=command))
            wanted = "DISABLED" if command == "disable" else "ENABLED"
            self.tick_until(lambda: self.chain.seen["/controller/operating_state"].state == wanted, wanted)
            if command == "disable":
                aside = self.needle() + [8e-6, 0, 0]
                target = pose(*aside)
                target.header.stamp = self.chain.now
                self.moves.publish(target)
                self.tick_until(lambda: np.allclose(self.needle(), aside, atol=1e-8), "the move aside")
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


if __name__ == "__main__":
    rospy.init_node("asker")
    rostest.rosrun("cell_microinjection", "inject", InjectTest)
