#!/usr/bin/python3
"""Nodes whose master is gone for good end by themselves: those that run, and one that still waits for it."""

import os
import subprocess
import threading
import unittest
import xmlrpc.client
import xmlrpc.server

import rosgraph
import rospy
import rostest

from killable_nodes import PROGRAMS, parameters
from live_chain import LiveChain, Master, until

EXIT_STATUS = 0


class MasterThatGoes(xmlrpc.server.SimpleXMLRPCServer):
    """Passes everything on to the test's master. It is gone as soon as a node asks for its first topic."""

    def __init__(self):
        super().__init__(("127.0.0.1", 0), logRequests=False, allow_none=True)
        self.gone = False
        self._master = xmlrpc.client.ServerProxy(rosgraph.get_master_uri())
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def uri(self):
        return f"http://127.0.0.1:{self.server_address[1]}"

    def _run(self):
        while not self.gone:
            self.handle_request()

    def _dispatch(self, method, params):
        if method == "registerSubscriber":
            self.gone = True
            self.server_close()
        return getattr(self._master, method)(*params)


class OrphanTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("watcher")
        rospy.set_param("/orphan_timeout", 1.0)

    def test_1_one_that_still_waits_for_it_ends(self):
        rospy.set_param("/injector", parameters("injector"))
        master = MasterThatGoes()
        node = subprocess.Popen([PROGRAMS / "injector"], env={**os.environ, "ROS_MASTER_URI": master.uri()})
        self.addCleanup(node.kill)
        until(lambda: node.poll() is not None, "the end of a node that waits for its master")
        self.assertTrue(master.gone)

    def test_2_all_that_run_end(self):
        chain = LiveChain({"display": {}, "force_watchdog": {}})
        self.addCleanup(chain.end_processes)
        chain.check_follows()
        nodes = chain.nodes.names()
        # Who tells diagnostics is past its constructor; the watchdog tells none.
        until(lambda: nodes <= {name.split(":")[0] for name in chain.diagnostics} | {"force_watchdog"}, "all diagnostics")
        self.assertEqual(chain.nodes.dead(), [])
        self.master.kill()
        until(lambda: set(chain.nodes.dead()) == nodes, f"the end of {nodes}")
        statuses = {node: chain.nodes.status(node) for node in nodes}
        self.assertEqual(statuses, {node: EXIT_STATUS for node in nodes}, chain.nodes.report())


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "orphan", OrphanTest)
