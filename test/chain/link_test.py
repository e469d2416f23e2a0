#!/usr/bin/python3
"""A hand behind a network with delay and loss: the needle goes after it, the force arrives and stays, and a dead link holds the
needle and leaves the hand without force."""

import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import CellState, LinkPacket
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy
from std_msgs.msg import Bool

from messages import force, pose, position
from participant import Participant

GAIN = 2e5  # config/haptic_bridge.yaml
SCALE = 1e-3
GAP = 32e-6  # m, from where the needle starts to the cell
TOLERANCE = 1e-3  # J, passivity/reserve
TIMEOUT = 300  # ticks, config/link.yaml
DELAY = 75  # ticks, one way at the most


class LinkTest(unittest.TestCase):
    """The test is the hand, and pulls the emulated network's plug."""

    @classmethod
    def setUpClass(cls):
        cls.chain = Participant(
            {"/haptic/measured_cp": PoseStamped, "/haptic/clutch": Joy},
            {"/haptic/servo_cf": WrenchStamped, "/cell/predicted_cf": WrenchStamped, "/cell/state": CellState,
             "/needle/measured_cp": PoseStamped, "/link/hand/received": LinkPacket})
        cls.plug = rospy.Publisher("/link/plugged", Bool, queue_size=1, latch=True)
        cls.chain.await_links()
        cls.z = 0.0  # m, of the hand
        cls.energy = cls.lowest = 0.0  # J, taken from the hand
        cls.run_hand(3 * DELAY)

    @classmethod
    def tick(cls, more=None):
        """One tick with the hand at z; what it does against the device's held force is counted."""
        cls.chain.tick({"/haptic/measured_cp": pose(0, 0, cls.z, "haptic"), **(more or {})})

    @classmethod
    def run_hand(cls, ticks):
        for _ in range(ticks):
            cls.tick()

    @classmethod
    def move(cls, goal, speed=0.03, rest=700):
        start, ticks = cls.z, max(1, int(abs(goal - cls.z) / speed * 1000))
        for i in range(1, ticks + 1):
            z = start + (goal - start) * i / ticks
            if "/haptic/servo_cf" in cls.chain.seen:
                cls.energy -= force(cls.chain.seen["/haptic/servo_cf"])[2] * (z - cls.z)
                cls.lowest = min(cls.lowest, cls.energy)
            cls.z = z
            cls.tick()
        cls.run_hand(rest)

    def hand_force(self):
        return force(self.chain.seen["/haptic/servo_cf"])

    def needle(self):
        return position(self.chain.seen["/needle/measured_cp"])

    def test_1_the_needle_goes_after_the_hand(self):
        self.move(-10e-3)
        np.testing.assert_allclose(self.needle(), [0, 0, 50e-6], atol=0.1e-6)
        self.assertLess(np.linalg.norm(self.hand_force()), 0.02)

    def test_2_the_force_arrives_and_stays(self):
        self.move(-(GAP + 4e-6) / SCALE, rest=1500)
        self.assertTrue(self.chain.seen["/cell/state"].in_contact)
        felt = self.hand_force()[2]
        self.assertGreater(felt, 0.05)
        # The force of the cell, not what is left of it.
        self.assertAlmostEqual(felt / (GAIN * force(self.chain.seen["/cell/predicted_cf"])[2]), 1, delta=0.03)
        self.run_hand(1000)
        self.assertAlmostEqual(self.hand_force()[2] / felt, 1, delta=0.03)

    def test_3_a_dead_link_holds_the_needle_and_renders_nothing(self):
        self.plug.publish(False)
        for _ in range(5000):
            self.tick()
            if not np.any(self.hand_force()):
                break
        np.testing.assert_array_equal(self.hand_force(), 0)
        silent = (self.chain.now - self.chain.seen["/link/hand/received"].header.stamp).to_sec()
        self.assertGreater(silent, 0.9e-3 * TIMEOUT)
        self.assertLess(silent, 1e-3 * (TIMEOUT + 40))
        self.run_hand(2 * DELAY)
        held = self.needle()
        self.move(self.z - 5e-3)
        np.testing.assert_allclose(self.needle(), held, atol=1e-9)
        np.testing.assert_array_equal(self.hand_force(), 0)
        # The diagnostics come once a second, and over a connection of their own.
        _, said = self.chain.run_to_status("teleoperation_follower: link", 1,
                                           lambda: {"/haptic/measured_cp": pose(0, 0, self.z, "haptic")})
        self.assertIn("needle held", said)

    def test_4_it_is_taken_up_where_the_needle_is(self):
        held = self.needle()
        self.plug.publish(True)
        lowest = held[2]
        for _ in range(2000):
            self.tick()
            lowest = min(lowest, self.needle()[2])
        self.assertGreater(lowest, held[2] - 0.1e-6)  # what the hand did meanwhile pushes nothing
        self.assertGreater(self.hand_force()[2], 0.02)

    def test_5_the_clutch_moves_the_hand_alone(self):
        self.move(self.z + 12e-3)
        self.tick({"/haptic/clutch": Joy(buttons=[1])})
        self.run_hand(3 * DELAY)
        before = self.needle()
        self.move(self.z - 20e-3, rest=100)
        np.testing.assert_allclose(self.needle(), before, atol=1e-9)
        np.testing.assert_array_equal(self.hand_force(), 0)
        self.tick({"/haptic/clutch": Joy(buttons=[0])})
        self.run_hand(3 * DELAY)
        self.move(self.z + 10e-3)
        np.testing.assert_allclose(self.needle(), before + [0, 0, 10e-6], atol=0.1e-6)

    def test_6_no_energy_was_given(self):
        self.assertGreater(self.energy, 0)
        self.assertGreater(self.lowest, -TOLERANCE)


if __name__ == "__main__":
    rospy.init_node("hand")
    rostest.rosrun("cell_microinjection", "link", LinkTest)
