#!/usr/bin/python3
"""Any injector, as a session has it: its file has come through roslaunch and the parameter server, and the device at
the other end of the line is emulated as manuals have it, carriage returns and all."""

import rospy
import rostest
from std_srvs.srv import Trigger

from injector_world import PRESSURE, InjectorTest

DURATION = 0.5  # s
SERIAL = "/injector/serial"
ATMOSPHERE = 101300.0  # Pa


class InjectorContractTest(InjectorTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.real = rospy.get_param("/injector/source") == "serial"
        cls.number = 0

    def setUp(self):
        self.tick_until(lambda: "/injector/state" in self.world.seen)
        self.tick_until(lambda: not self.state().fault and not self.state().busy)
        self.world.run(200)  # forty times the regulator's time constant

    def ask(self, pressure=PRESSURE, duration=DURATION):
        InjectorContractTest.number += 1
        self.send(self.number, pressure, duration)
        return self.number

    def balances(self):
        """Whether its balance pressure can be set from here."""
        return not self.real or rospy.has_param(SERIAL + "/balance")

    def test_a_pulse_is_done_once(self):
        before = self.state().pulses
        number = self.ask()
        self.tick_until(lambda: self.state().pressure > 0.9 * PRESSURE)
        begun = self.world.now
        self.tick_until(lambda: self.state().last_id == number)
        self.assertAlmostEqual((self.world.now - begun).to_sec(), DURATION, delta=0.06)
        self.world.run(1000)
        self.assertEqual((self.state().pulses, self.state().fault), (before + 1, ""))

    def test_what_it_cannot_do_is_refused(self):
        before = self.state().pulses
        self.ask(pressure=1e9)
        self.tick_until(lambda: "pulse pressure = 1e+09 Pa" in self.state().refusal)
        self.world.run(1000)
        self.assertEqual(self.state().pulses, before)

    def test_the_balance_pressure_is_a_fluid_pressure(self):
        right = self.state().pressure
        other = right + 200
        self.set_balance(other)
        if not self.balances():
            self.tick_until(lambda: "set by hand" in self.state().refusal)
            return
        self.check_is_at(other)
        self.world.run(2000)
        self.assertEqual(self.state().fault, "")
        self.set_balance(right)
        self.check_is_at(right)

    def check_is_at(self, pressure):
        self.tick_until(lambda: abs(self.state().pressure - pressure) < 1e-3)

    def test_the_balance_pressure_is_gauge_and_has_limits(self):
        """The message is made for absolute pressures. One is beyond the limits of most; a FemtoJet's are wider."""
        right = self.state().pressure
        lowest, highest = map(float, rospy.get_param("/injector/pressure_range"))  # 600.0e3 is a text to YAML 1.1
        for beyond in (lowest - 100, highest + 1000, ATMOSPHERE + highest):
            self.set_balance(beyond)
            why = f"balance pressure = {beyond:g} Pa, allowed [{lowest:g}, {highest:g}] Pa"
            self.tick_until(lambda: why in self.state().refusal)
            self.world.run(500)
            self.assertAlmostEqual(self.state().pressure, right, delta=1e-3)
        if not self.balances():
            return
        absolute = ATMOSPHERE + round(right, -2)
        for pressure in (lowest, highest, absolute):
            self.set_balance(pressure)
            if pressure > highest:
                self.tick_until(lambda: f"balance pressure = {pressure:g} Pa, allowed" in self.state().refusal)
            else:
                self.check_is_at(pressure)  # the number as it is: nothing takes the atmosphere's off
                self.assertEqual(self.state().refusal, "")
        self.assertEqual(absolute > highest, rospy.get_param("/injector/emulated") != "femtojet")
        self.set_balance(right)
        self.check_is_at(right)
        self.assertEqual(self.state().fault, "")

    def test_it_is_as_good_after_a_reset(self):
        self.world.call("/injector/reset", Trigger)
        number = self.ask()
        self.tick_until(lambda: self.state().last_id == number)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "injector_contract", InjectorContractTest)
