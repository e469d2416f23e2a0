#!/usr/bin/python3
"""Each node of a live chain is frozen (SIGSTOP) while the needle follows the hand: the needle rests within what it can do
in the time-outs, and follows again when the node wakes up. The rig is simulated; freeze_rig_test.py has real drivers."""

import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped

from case import case
from live_chain import TIMEOUT, Hand, LiveChain, Master, until
from messages import position

NODES = ("haptic_bridge", "injection_controller", "micromanipulator", "cell_simulator")
FASTEST = 1e-3 * Hand.SPEED  # m/s, of the needle: a thousandth of the hand's
STILL = 2e-9  # m
AT_REST = 50  # readings in a row, 20 ms apart


class FreezeChainTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("freezer")
        cls.chain = LiveChain()
        cls.chain.follow("/needle/true_cp", PoseStamped)

    @classmethod
    def tearDownClass(cls):
        cls.chain.close()
        cls.master.kill()

    def place(self):
        return position(self.chain.newest["/needle/true_cp"])[2]

    def check_rests(self):
        """@returns how far it has gone until then (m)."""
        way, last, same = 0.0, self.place(), 0
        while same < AT_REST:
            rospy.rostime.wallsleep(0.02)
            now = self.place()
            same = same + 1 if abs(now - last) < STILL else 0
            way, last = way + abs(now - last), now
            self.assertLess(way, 100e-6, "it does not rest")
        return way

    def test_each_node(self):
        until(lambda: "/needle/true_cp" in self.chain.newest, "a true place of the needle")
        for node in NODES:
            with case(node):
                self.chain.check_follows()
                self.chain.nodes.freeze(node)
                self.assertLess(self.check_rests(), 2 * TIMEOUT * FASTEST)
                self.chain.nodes.thaw(node)
                self.chain.check_follows()
                self.assertEqual(self.chain.nodes.dead(), [])

    def test_frozen_for_longer_than_an_orphan_may_live(self):
        """The master was there all the time."""
        rospy.set_param("/orphan_timeout", 1.0)
        self.chain.nodes.begin({"display": {}})
        until(lambda: self.chain.diagnostics.get("display: drawing"), "the display")
        self.chain.nodes.freeze("display")
        rospy.rostime.wallsleep(3)
        self.chain.nodes.thaw("display")
        self.chain.diagnostics.pop("display: drawing")
        until(lambda: "display: drawing" in self.chain.diagnostics, "what it says after it has woken up")


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "freeze_chain", FreezeChainTest)
