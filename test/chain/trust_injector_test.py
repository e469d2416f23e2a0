#!/usr/bin/python3
"""The injector does a pulse once, refuses what is old, repeated or out of its range, and shows what flows back."""

import math

import rospy
import rostest
from std_srvs.srv import SetBool, Trigger

from cell_microinjection.msg import InjectionPulse, StringStamped
from injector_world import PRESSURE, InjectorTest


class TrustTest(InjectorTest):
    def setUp(self):
        self.world.call("/injector/clog", SetBool, False)
        self.world.call("/injector/reset", Trigger)
        self.world.run(2)  # so that the state that was seen last is one of after it

    def inject(self, number):
        """Volume (m^3) of a pulse."""
        before = self.state().volume
        self.send(number)
        self.tick_until(lambda: self.state().last_id == number)
        self.world.run(100)
        return self.state().volume - before

    def test_a_pulse_is_done_once(self):
        before = self.state().pulses
        self.assertGreater(self.inject(11), 0)
        for _ in range(3):
            self.send(11)
        self.send(12)
        self.tick_until(lambda: self.state().last_id == 12)
        self.world.run(500)
        self.assertEqual(self.state().pulses, before + 2)

    def check_refused(self, why, **pulse):
        before = self.state().pulses
        self.send(**pulse)
        self.tick_until(lambda: why in self.state().refusal)
        level, text = self.world.run_to_status("injector: injector", 300)
        self.assertEqual(self.state().pulses, before)
        self.assertNotEqual(level, 0)
        self.assertIn(why, text)

    def test_refuses_with_the_reason(self):
        self.check_refused("it is stale", number=21, age=1.0)
        self.check_refused("allowed [-50000, 50000] Pa", number=22, pressure=1e6)
        self.check_refused("allowed [-50000, 50000] Pa", number=23, pressure=math.nan)
        self.check_refused("allowed [0.001, 60] s", number=24, duration=-1.0)
        self.check_refused("id is 0", number=0)

    def test_refuses_a_pulse_during_a_pulse(self):
        self.send(31, duration=0.5)
        self.tick_until(lambda: self.state().busy)
        self.send(32)
        self.tick_until(lambda: "a pulse is under way" in self.state().refusal)
        self.tick_until(lambda: not self.state().busy)
        self.world.run(500)
        self.assertEqual(self.state().last_id, 31)

    def test_a_stop_ends_the_pulse_however_old_it_is(self):
        right, before = self.state().pressure, self.state().pulses
        self.send(51, duration=30.0)
        self.tick_until(lambda: self.state().busy)
        self.world.run(50)
        self.assertGreater(self.state().pressure, 0.9 * PRESSURE)
        stop = StringStamped(string="the test says so")
        stop.header.stamp = self.world.now - rospy.Duration(0.03)
        self.stops.publish(stop)
        self.tick_until(lambda: not self.state().busy)
        self.world.run(100)  # twenty times the regulator's time constant
        self.assertAlmostEqual(self.state().pressure, right, delta=1e-3)
        self.assertEqual(self.state().pulses, before)
        self.assertNotEqual(self.state().last_id, 51)
        self.inject(52)

    def test_a_held_pulse_lasts_while_it_is_said_again(self):
        timeout = rospy.get_param("/injector/pulse_timeout")
        ticks = round(1e3 * timeout)
        before = self.state().pulses
        held = {"/injector/pulse": InjectionPulse(id=61, pressure=PRESSURE, duration=10 * timeout, held=True)}
        for _ in range(4):  # each with the stamp of its tick
            self.world.tick(held)
            said = self.world.now - rospy.Duration(0.001)
            self.world.run(ticks - 20)
            self.assertTrue(self.state().busy)
        while self.state().busy:
            self.world.tick()
        # Silence ends it at the first tick past the time-out.
        silent = (self.state().header.stamp - said).to_sec()
        self.assertAlmostEqual(silent, timeout + 0.001, delta=0.0011)
        self.world.run(100)
        self.assertEqual((self.state().pulses, self.state().refusal), (before, ""))
        # One that is not held is done whoever is silent.
        self.send(62, duration=2 * timeout)
        self.tick_until(lambda: self.state().last_id == 62)

    def test_a_wrong_balance_flows_back(self):
        right = self.state().pressure
        for pressure, sign in ((0.0, -1), (2 * right, 1)):
            self.set_balance(pressure)
            self.tick_until(lambda: abs(self.state().pressure - pressure) < 1)
            self.assertGreater(sign * self.state().flow, 0)
        self.set_balance(right)
        self.tick_until(lambda: abs(self.state().pressure - right) < 1e-3)

    def test_a_clogged_tip_lets_less_through(self):
        clean = self.inject(41)
        self.world.call("/injector/clog", SetBool, True)
        self.assertAlmostEqual(self.inject(42) / clean, 0.01, delta=0.001)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_injector", TrustTest)
