#!/usr/bin/python3
"""Each process of a live chain is killed or frozen while the needle follows the hand: the needle rests within what it can
do in the time-outs, or follows on where the loop does not need that process; and it follows again when the process is
started anew or thawed. The rig is simulated; freeze_rig_test.py has real drivers. Usage: kill or freeze"""

import signal
import sys
import unittest

import rospy
import rostest
from cell_microinjection.msg import HolderState, InjectorState
from geometry_msgs.msg import PoseStamped, WrenchStamped

from case import case
from killable_nodes import parameters
from live_chain import TIMEOUT, Hand, HandProcess, LiveChain, Master, until
from messages import position

FOLLOWED = ("hand", "haptic_bridge", "injection_controller", "micromanipulator", "cell_simulator")  # each is needed
OTHERS = {"force_sensor": ("/force_sensor/measured_cf", WrenchStamped), "injector": ("/injector/state", InjectorState),
          "holder": ("/holder/state", HolderState)}
FASTEST = 1e-3 * Hand.SPEED  # m/s, of the needle: a thousandth of the hand's
STILL = 2e-9  # m
AT_REST = 50  # readings in a row, 20 ms apart


class FaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("faults")
        cls.chain = LiveChain(hand=HandProcess, changes={"holder": parameters("holder")})
        for topic, kind in (("/needle/true_cp", PoseStamped), *OTHERS.values()):
            cls.chain.follow(topic, kind)

    @classmethod
    def tearDownClass(cls):
        cls.chain.close()
        cls.master.kill()

    def setUp(self):
        until(lambda: "/needle/true_cp" in self.chain.newest, "a true place of the needle")

    def fail_(self, who):
        raise NotImplementedError

    def recover(self, who):
        raise NotImplementedError

    def place(self):
        return position(self.chain.newest["/needle/true_cp"])[2]

    def check_rests(self):
        """@returns how far the needle has gone until then (m)."""
        way, last, same = 0.0, self.place(), 0
        while same < AT_REST:
            rospy.rostime.wallsleep(0.02)
            now = self.place()
            same = same + 1 if abs(now - last) < STILL else 0
            way, last = way + abs(now - last), now
            self.assertLess(way, 100e-6, "it does not rest")
        return way

    def check_goes_on(self, who):
        self.chain.check_follows()
        self.assertEqual(self.chain.nodes.dead(), [], f"after {who}: {self.chain.nodes.report()}")

    def test_the_needle_rests_without_each_process_that_leads_it(self):
        for who in FOLLOWED:
            with case(who):
                self.chain.check_follows()
                self.fail_(who)
                self.assertLess(self.check_rests(), 2 * TIMEOUT * FASTEST)
                self.recover(who)
                self.check_goes_on(who)

    def test_the_needle_follows_without_each_process_that_does_not_lead_it(self):
        for who, (topic, _) in OTHERS.items():
            with case(who):
                self.chain.check_follows()
                self.fail_(who)
                self.check_goes_on(who)
                before = self.chain.counts[topic]
                self.recover(who)
                until(lambda: self.chain.counts[topic] > before + 20, f"messages of {who}")
                self.check_goes_on(who)


class KillTest(FaultsTest):
    def fail_(self, who):
        if who == "hand":
            self.chain.hand.fail("killed")
        else:
            self.assertEqual(self.chain.nodes.kill(who), -signal.SIGKILL)

    def recover(self, who):
        self.chain.hand.recover("killed") if who == "hand" else self.chain.nodes.start(who)


class FreezeTest(FaultsTest):
    def fail_(self, who):
        self.chain.hand.fail("frozen") if who == "hand" else self.chain.nodes.freeze(who)

    def recover(self, who):
        self.chain.hand.recover("frozen") if who == "hand" else self.chain.nodes.thaw(who)

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


FAULTS = {"kill": KillTest, "freeze": FreezeTest}

if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", f"faults_{sys.argv[1]}", FAULTS[sys.argv[1]])
