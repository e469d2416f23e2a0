#!/usr/bin/python3
"""Semi-automatic: every step waits for its word on /controller/state_command, and takes no other."""

import numpy as np
import rospy
import rostest

from injection_chain import InjectionChainTest


class InjectSemiAutomaticTest(InjectionChainTest):
    def setUp(self):
        type(self).states = ["idle"]
        self.start = self.resting()

    def await_word_in(self, state):
        """It goes on to `state` and waits there, with the needle at rest."""
        self.tick_until(lambda: self.status().state == state and self.status().waits, f"waiting in {state}")
        self.chain.run(100)
        at = self.needle()
        self.chain.run(200)
        np.testing.assert_allclose(self.needle(), at, atol=0.02e-6)
        self.assertEqual((self.status().state, self.status().waits), (state, True))

    def check_refused(self, *words):
        before = list(self.states)
        for word in words:
            self.say(word)
            self.chain.run(50)
        self.assertEqual(self.states, before)

    def test_1_given_up_at_the_touch(self):
        self.check_refused("indent", "inject", "withdraw")
        self.say("approach")
        self.await_word_in("contact")
        self.say("withdraw")
        self.tick_until(lambda: self.status().outcome == "preempted", "the outcome")
        self.check_out(self.start)
        self.assertFalse(self.chain.seen["/cell/state"].punctured)

    def test_2_a_whole_injection(self):
        before = self.chain.seen["/injector/state"]
        self.say("approach")
        self.await_word_in("contact")
        self.check_refused("approach", "inject")
        self.say("indent")
        self.await_word_in("punctured")
        self.assertTrue(self.chain.seen["/cell/state"].punctured)
        self.assertEqual(self.chain.seen["/injector/state"].pulses, before.pulses)
        self.check_refused("approach", "indent")
        self.say("inject")
        self.tick_until(lambda: self.status().state == "inject", "the injection")
        self.await_word_in("punctured")
        after = self.chain.seen["/injector/state"]
        self.assertEqual(after.pulses, before.pulses + 1)
        pulse = 0.3 * 2.46e3 / 1.546e17  # m^3: 0.3 s of 3 kPa past the capillary pressure, over the resistance
        self.assertAlmostEqual(self.status().volume / pulse, 1, delta=0.05)
        self.check_refused("inject")
        self.say("withdraw")
        self.tick_until(lambda: self.status().outcome == "injected", "the outcome")
        self.check_out(self.start)
        self.assertEqual(self.waited, {"contact", "punctured"})
        passed = [name for name in self.states if name != "idle"]
        self.assertEqual(passed, ["approach", "contact", "indent", "punctured", "inject", "punctured", "withdraw"])


if __name__ == "__main__":
    rospy.init_node("asker")
    rostest.rosrun("cell_microinjection", "inject_semi_automatic", InjectSemiAutomaticTest)
