#!/usr/bin/python3
"""Nodes whose master is gone for good end by themselves."""

import unittest

import rospy
import rostest

from live_chain import LiveChain, Master, until

EXIT_STATUS = 0


class OrphanTest(unittest.TestCase):
    def test_all_end(self):
        master = Master()
        rospy.init_node("watcher")
        rospy.set_param("/orphan_timeout", 1.0)
        chain = LiveChain({"display": {}, "force_watchdog": {}})
        chain.check_follows()
        nodes = chain.nodes.names()
        self.assertEqual(chain.nodes.dead(), [])
        master.kill()
        until(lambda: set(chain.nodes.dead()) == nodes, f"the end of {nodes}")
        statuses = {node: chain.nodes.status(node) for node in nodes}
        self.assertEqual(statuses, {node: EXIT_STATUS for node in nodes}, chain.nodes.report())
        chain.hand.end()


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "orphan", OrphanTest)
