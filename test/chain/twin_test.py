#!/usr/bin/python3
"""The cell under the needle is another one than the session believes: its force is found and felt while it is indented."""

import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import CellEstimate, CellParameters, CellState
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from messages import force, pose, position
from participant import INVALID, Participant

SCALE = 1e-3  # of the needle's motion over the hand's
SURFACE = 28e-6  # m, of the cell that the session believes in
HIGHER = 0.3e-6  # m, of the true one
PRIOR, TRUE = 17.9e3, 53.7e3  # Pa
FORCE_RATE_LIMIT = 100.0  # N/s, config/haptic_bridge.yaml
TICK = 1e-3  # s
LARGEST_STEP = 0.04  # of the force in a tick; a change of the cell by 28 % takes 20 of them


class TwinTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chain = Participant(
            {"/haptic/measured_cp": PoseStamped, "/haptic/clutch": Joy},
            {"/haptic/servo_cf": WrenchStamped, "/cell/predicted_cf": WrenchStamped, "/cell/estimate": CellEstimate,
             "/true_cell/predicted_cf": WrenchStamped, "/needle/measured_cp": PoseStamped, "/true_cell/state": CellState})
        changes = rospy.Publisher("/true_cell/set_parameters", CellParameters, queue_size=1, latch=True)
        cls.chain.await_links()
        changes.publish(CellParameters(name=["height"], value=[HIGHER]))
        cls.z = 0.0  # m, of the hand
        while cls.true_height() != HIGHER:
            cls.chain.tick(cls.hand())
        cls.chain.run(150, cls.hand)  # the loop closes and its ramp is over
        cls.rows = []  # depth, predicted, true and hand's force, modulus

    @classmethod
    def true_height(cls):
        state = cls.chain.seen.get("/true_cell/state")
        return state and dict(zip(state.parameter_names, state.parameter_values))["height"]

    @classmethod
    def hand(cls):
        return {"/haptic/measured_cp": pose(0, 0, cls.z, "haptic")}

    def needle(self):
        return position(self.chain.seen["/needle/measured_cp"])[2]

    def move(self, height, speed):
        """The needle to a height (m) at a speed (m/s)."""
        start = self.z
        goal = start + (height - self.needle()) / SCALE
        ticks = max(1, round(abs(goal - start) * SCALE / (speed * TICK)))
        for i in range(1, ticks + 1):
            type(self).z = start + (goal - start) * i / ticks
            self.chain.tick(self.hand())
            seen = self.chain.seen
            self.rows.append((SURFACE - self.needle(), force(seen["/cell/predicted_cf"])[2],
                              force(seen["/true_cell/predicted_cf"])[2], force(seen["/haptic/servo_cf"])[2],
                              seen["/cell/estimate"].modulus, seen["/cell/estimate"].served_modulus))

    def estimate(self):
        return self.chain.seen["/cell/estimate"]

    def test_1_knows_nothing_before_contact(self):
        self.move(SURFACE + 4e-6, 100e-6)
        self.chain.run(300, self.hand)
        self.assertEqual(self.estimate().verdict, "prior")
        self.assertAlmostEqual(self.estimate().served_modulus, PRIOR, delta=1)

    def test_2_the_felt_force_becomes_that_of_the_true_cell(self):
        self.rows.clear()
        self.move(SURFACE - 10e-6, 20e-6)
        depth, predicted, true, hand, modulus, _ = np.array(self.rows).T
        at_5 = depth >= 5e-6
        np.testing.assert_allclose(modulus[at_5] / TRUE, 1, atol=0.05)
        at_8 = depth >= 8e-6
        np.testing.assert_allclose(predicted[at_8] / true[at_8], 1, atol=0.03)
        self.assertGreater(true[at_8].min(), 2e-6)
        self.assertLess(np.abs(np.diff(hand)).max(), FORCE_RATE_LIMIT * TICK * 1.001)
        # The changes of the served cell are spread over the ticks: a step of the force is a small share of it.
        felt = predicted > 0.2e-6
        self.assertLess((np.abs(np.diff(predicted)) / np.maximum(predicted[:-1], 1e-9))[felt[:-1]].max(), LARGEST_STEP)
        self.assertEqual(self.estimate().verdict, "converged")
        self.assertTrue(self.estimate().modulus_low <= TRUE <= self.estimate().modulus_high)
        self.assertAlmostEqual(self.estimate().served_height, HIGHER, delta=0.05e-6)

    def test_3_a_hand_that_is_gone_teaches_nothing(self):
        modulus = self.estimate().modulus
        self.chain.run(50, lambda: {"/haptic/measured_cp": INVALID})
        self.assertAlmostEqual(self.estimate().modulus / modulus, 1, delta=0.02)
        self.chain.run(200, self.hand)

    def test_4_the_next_indentation_begins_with_the_cell_that_was_found(self):
        self.move(SURFACE + 12e-6, 50e-6)
        self.chain.run(300, self.hand)
        self.assertEqual(self.estimate().verdict, "prior")
        self.assertAlmostEqual(self.estimate().modulus / TRUE, 1, delta=0.03)
        self.assertAlmostEqual(self.estimate().served_modulus / TRUE, 1, delta=0.03)

    def test_5_a_cell_of_another_size_is_unknown(self):
        changes = rospy.Publisher("/cell/set_parameters", CellParameters, queue_size=1, latch=True)
        self.chain.await_links()
        changes.publish(CellParameters(name=["diameter"], value=[60e-6]))
        for _ in range(20000):
            self.chain.tick(self.hand())
            if self.estimate().modulus == PRIOR and self.estimate().verdict == "prior":
                break
        self.chain.run(200, self.hand)
        self.assertEqual(self.estimate().served_height, 0)  # the height was that of the cell before
        self.move(30e-6 - 6e-6, 20e-6)
        self.chain.run(100, self.hand)
        # Modelled 1.7 um too high: that is found, too, since the prior of the surface's height is wide enough.
        self.assertAlmostEqual(self.estimate().contact, SURFACE + HIGHER - 30e-6, delta=0.1e-6)
        self.assertAlmostEqual(self.estimate().modulus / TRUE, 1, delta=0.05)


if __name__ == "__main__":
    rospy.init_node("hand")
    rostest.rosrun("cell_microinjection", "twin", TwinTest)
