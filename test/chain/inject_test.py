#!/usr/bin/python3
"""The action Inject: approach, puncture, injection, withdrawal; and from wherever it is cancelled the needle comes out.
What cannot be meant is refused and costs no later goal."""

import threading

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from cell_microinjection.msg import (CellEstimate, InjectAction, InjectActionGoal, InjectActionResult, InjectGoal,
                                     PuncturePrediction)

from injection_chain import InjectionChainTest

PUNCTURE = 1.2e-6  # N, of the zona in injected_oocyte.yaml
GOAL = {"puncture": True, "layers": 1, "depth": 15e-6, "margin": 2e-6, "hold_time": 0.1, "pressure": 20e3,
        "duration": 0.3}
INDENTATION = {**GOAL, "puncture": False, "depth": 2e-6, "hold_time": 0.0}
LAST_TIME = rospy.Time(4294967295, 999999999)  # that a stamp can hold
ENDED = (GoalStatus.SUCCEEDED, GoalStatus.PREEMPTED, GoalStatus.ABORTED)


class InjectPulseTest(InjectionChainTest):
    """What the injector has a part in."""

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

    def test_3_a_whole_injection(self):
        start, before = self.resting(), self.chain.seen["/injector/state"]
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
        start, pulses = self.resting(), self.chain.seen["/injector/state"].pulses
        self.send(duration=30.0)
        self.tick_until(lambda: self.chain.seen["/injector/state"].busy, "a pulse")
        self.chain.run(100)
        self.assertEqual(self.status().state, "inject")
        self.client.cancel_goal()
        self.tick_until(lambda: self.status().state == "withdraw", "the withdrawal")
        # A device on a serial line answers two commands meanwhile.
        patience = 5 if rospy.get_param("/injector/source") == "simulated" else 150
        self.tick_until(lambda: not self.chain.seen["/injector/state"].busy, "the end of the pulse", patience)
        state, result = self.result()
        self.assertEqual((state, result.outcome, result.punctures), (GoalStatus.PREEMPTED, "preempted", 1))
        self.check_out(start)
        self.assertEqual(self.chain.seen["/injector/state"].pulses, pulses)


class InjectTest(InjectPulseTest):
    """And what it has none in."""

    def test_1_a_goal_that_cannot_be_is_aborted_with_the_reason(self):
        start = self.resting()
        for changes, why in (({"layers": 0}, "layers = 0"), ({"depth": 200e-6}, "allowed up to depth_limit = "),
                             ({"depth": float("nan")}, "depth = nan"),
                             ({"depth": 1.0}, "depth = 1 m, allowed (0, 0.001] m"),
                             ({"margin": 1e9}, "margin = 1e+09 m, allowed [0, 0.001] m"),
                             ({"hold_time": 1e300}, "hold_time = 1e+300 s, allowed [0, 600] s"),
                             ({"pressure": 1e300}, "pulse/pressure = 1e+300 Pa, allowed [0, 1e+06] Pa"),
                             ({"pressure": -1.0}, "pulse/pressure = -1 Pa"),
                             ({"duration": 61.0}, "pulse/duration = 61 s"),
                             ({"volume": float("inf")}, "pulse/volume = inf m^3")):
            self.send(**changes)
            state, result = self.result()
            self.assertEqual((state, result.outcome), (GoalStatus.ABORTED, "refused"))
            self.assertIn(why, result.reason)
        np.testing.assert_array_equal(self.needle(), start)

    def test_1_stamps_ahead_of_the_time_cost_their_own_message_only(self):
        start, results, known = self.resting(), {}, set()
        listeners = [rospy.Subscriber("/controller/inject/result", InjectActionResult,
                                      lambda message: results.update({message.status.goal_id.id: message})),
                     rospy.Subscriber("/controller/inject/status", GoalStatusArray,
                                      lambda message: known.update(one.goal_id.id for one in message.status_list))]
        goals = rospy.Publisher("/controller/inject/goal", InjectActionGoal, queue_size=10)
        cancels = rospy.Publisher("/controller/inject/cancel", GoalID, queue_size=10)
        self.tick_until(lambda: goals.get_num_connections() and cancels.get_num_connections() and
                        all(listener.get_num_connections() for listener in listeners), "the connections")

        def check_refused(name, stamp):
            goals.publish(InjectActionGoal(goal_id=GoalID(stamp, name), goal=InjectGoal(**INDENTATION)))
            self.tick_until(lambda: name in results, "the refusal")
            status, result = results[name].status.status, results[name].result
            self.assertEqual((status, result.outcome), (GoalStatus.ABORTED, "refused"))
            self.assertIn("s ahead of the time, allowed 1 s", result.reason)

        def check_served():
            self.send(**INDENTATION)
            state, result = self.result()
            self.assertEqual((state, result.outcome), (GoalStatus.SUCCEEDED, "indented"))
            self.check_out(start)

        check_refused("last", LAST_TIME)
        check_refused("later", self.chain.now + rospy.Duration(3600))
        check_served()
        # The goal that runs goes on beside one that is refused.
        self.send(**INDENTATION)
        self.tick_until(lambda: self.status().state == "approach", "the approach")
        check_refused("beside", LAST_TIME)
        self.assertEqual(self.status().state, "approach")
        # A cancel of all is for all that are known.
        cancels.publish(GoalID(LAST_TIME, ""))
        state, result = self.result()
        self.assertEqual((state, result.outcome), (GoalStatus.PREEMPTED, "preempted"))
        self.check_out(start)
        check_served()
        # That of a goal that nobody knows is remembered for some seconds.
        cancels.publish(GoalID(LAST_TIME, "nobody"))
        cancels.publish(GoalID(rospy.Time(), "nobody else"))
        self.tick_until(lambda: {"nobody", "nobody else"} <= known, "the cancels")
        self.chain.run(5500)
        known.clear()
        self.chain.run(300)
        self.assertFalse({"nobody", "nobody else"} & known)
        check_served()

    def test_2_a_newer_goal_replaces_the_one_that_runs(self):
        start, results = self.resting(), []
        listener = rospy.Subscriber("/controller/inject/result", InjectActionResult, results.append)
        self.tick_until(listener.get_num_connections, "the connection")
        self.send()
        self.tick_until(lambda: self.status().state == "indent", "an indentation")
        self.send(**INDENTATION)
        self.tick_until(lambda: self.status().state == "withdraw", "the withdrawal")
        self.assertEqual(results, [])
        state, result = self.result()
        self.assertEqual((state, result.outcome), (GoalStatus.SUCCEEDED, "indented"))
        self.tick_until(lambda: len(results) == 2, "both results")
        self.assertEqual([one.result.outcome for one in results], ["preempted", "indented"])
        self.check_out(start)

    def test_2_cancelled_while_it_indents_it_withdraws(self):
        start = self.resting()
        self.send()
        self.tick_until(lambda: self.status().state == "indent" and self.status().depth > 1e-6, "an indentation")
        self.assertGreater(self.chain.seen["/cell/state"].force.z, 0)
        self.client.cancel_goal()
        # How many ticks the word is under way depends on the machine; seconds it is not.
        self.tick_until(lambda: self.status().state == "withdraw", "the withdrawal", ticks=5000)
        lowest = at = self.needle()[2]
        for _ in range(200):
            self.chain.tick()
            lowest = min(lowest, self.needle()[2])
        self.assertGreater(lowest, at - 0.5e-6, "it goes no deeper")
        self.assertEqual(self.status().state, "withdraw")
        state, result = self.result()
        self.assertEqual((state, result.outcome, result.punctures), (GoalStatus.PREEMPTED, "preempted", 0))
        self.check_out(start)
        self.assertFalse(self.chain.seen["/cell/state"].punctured)

    def test_2_a_puncture_that_the_twin_expects_beyond_the_limits_is_not_tried(self):
        start, limit = self.resting(), rospy.get_param("/injection_controller/force_limit")
        beyond = PuncturePrediction(force_low=1.1 * limit, force=1.2 * limit, force_high=1.3 * limit,
                                    depth_low=1e-6, depth=2e-6, depth_high=3e-6)
        estimates = rospy.Publisher("/cell/estimate", CellEstimate, queue_size=10)
        self.tick_until(estimates.get_num_connections, "the connection")

        def run_until(condition, what, verdict, age):
            def told():
                message = CellEstimate(verdict=verdict, puncture=beyond)
                message.header.stamp = self.chain.now - rospy.Duration(age)
                estimates.publish(message)
                return condition()
            self.tick_until(told, what)

        def ended():
            return self.client.get_state() in ENDED and self.client.get_result()

        # A twin that is contradicted by the force, or has died, expects nothing.
        for verdict, age in (("inconsistent", 0), ("converged", 1), ("converged", -1)):
            self.send()
            run_until(lambda: self.status().state == "indent" and self.status().depth > 1e-6, "an indentation",
                      verdict, age)
            self.client.cancel_goal()
            self.assertEqual(self.result()[1].outcome, "preempted")
            self.check_out(start)
        self.send()
        run_until(ended, "the result", "learning", 0)
        result = self.client.get_result()
        self.assertEqual((result.outcome, result.punctures), ("guard", 0))
        self.assertIn("the puncture is expected above", result.reason)
        self.assertLess(result.max_depth, 1e-6)
        self.say("withdraw")
        self.tick_until(lambda: self.status().state == "withdraw", "the withdrawal")
        self.tick_until(lambda: self.status().state == "idle", "the end of the withdrawal")
        self.check_out(start)
        self.assertFalse(self.chain.seen["/cell/state"].punctured)

    def test_5_through_two_membranes(self):
        """States and feedback tell of each; the injector works behind the last."""
        self.move_aside(-16e-6)  # where no hole is
        start, pulses = self.resting(), self.chain.seen["/injector/state"].pulses
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
    # What the controller does besides does not depend on the rig, nor on the injector.
    rig, injector = rospy.myargv()[1:3]
    chosen = InjectTest if injector == "simulated" else InjectPulseTest
    rostest.rosrun("cell_microinjection", "inject",
                   chosen if rig == "sim" else "__main__.InjectPulseTest.test_3_a_whole_injection")
