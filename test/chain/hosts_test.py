#!/usr/bin/python3
"""The chain over three hosts and a network that is slow and loses frames: the needle rests while a part of it is away.
./dev bench hosts has all faults."""

import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "test/chain"), str(ROOT / "src/tools")]
sys.argv[0] = str(ROOT / "catkin_ws/install/lib/cell_microinjection/hosts")  # the chain's programs are beside it

import lossy_network  # noqa: E402


@unittest.skipUnless(lossy_network.possible(), "no network namespaces: needs root, /dev/net/tun and a system that allows them")
class HostsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        from three_hosts import ThreeHosts
        cls.session = ThreeHosts()

    @classmethod
    def tearDownClass(cls):
        cls.session.close()

    def check(self, how, who):
        from three_hosts import STILL
        self.assertLess(self.session.measure(how, who), STILL, f"{who} {how}")

    def test_the_needle_follows_and_frames_are_lost(self):
        self.session.chain.check_follows()
        self.assertGreater(self.session.switch.lost, 20)

    def test_the_bridge_is_frozen(self):
        self.check("frozen", "haptic_bridge")

    def test_the_simulator_is_killed(self):
        self.check("killed", "cell_simulator")

    def test_clocks_that_are_20_ms_apart(self):
        for ahead in (0.02, -0.02):
            self.session.chain.hand.set_clock(ahead)
            self.session.chain.check_follows()
            self.check("frozen", "hand")

    def test_the_cable_of_the_haptic_host_is_pulled(self):
        self.check("pulled", "haptic")

    def test_the_cable_of_the_solver_is_pulled(self):
        self.check("pulled", "solver")


if __name__ == "__main__":
    unittest.main()
