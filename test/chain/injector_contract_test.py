#!/usr/bin/python3
"""Any injector, as a session has it: its file has come through roslaunch and the parameter server, and the device at
the other end of the line is emulated as manuals have it, carriage returns and all."""

import unittest

import rospy
import rostest
from sensor_msgs.msg import FluidPressure
from std_srvs.srv import Trigger

from cell_microinjection.msg import InjectionPulse, InjectorState, StringStamped
from participant import Participant

PRESSURE = 20e3  # Pa
DURATION = 0.5  # s
TICK = 0.001  # s
SERIAL = "/injector/serial"


class InjectorContractTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/injector/pulse": InjectionPulse, "/injector/stop": StringStamped},
                                {"/injector/state": InjectorState})
        cls.pulses = rospy.Publisher("/injector/pulse", InjectionPulse, queue_size=10)
        cls.balance = rospy.Publisher("/injector/set_balance", FluidPressure, queue_size=10)
        cls.world.await_links()
        cls.real = rospy.get_param("/injector/source") == "serial"
        cls.number = 0

    def state(self):
        return self.world.seen["/injector/state"]

    def tick_until(self, condition, patience=20):
        for _ in range(round(patience / TICK)):
            self.world.tick()
            if condition():
                return
        self.fail(f"did not happen within {patience} s of ROS time; injector:\n{self.state()}")

    def setUp(self):
        self.tick_until(lambda: "/injector/state" in self.world.seen)
        self.tick_until(lambda: not self.state().fault and not self.state().busy)
        self.world.run(200)  # forty times the regulator's time constant

    def stamp(self, message):
        message.header.stamp = self.world.now
        return message

    def ask(self, pressure=PRESSURE, duration=DURATION):
        InjectorContractTest.number += 1
        self.pulses.publish(self.stamp(InjectionPulse(id=self.number, pressure=pressure, duration=duration)))
        return self.number

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
        self.balance.publish(self.stamp(FluidPressure(fluid_pressure=other)))
        if self.real and not rospy.has_param(SERIAL + "/balance"):
            self.tick_until(lambda: "set by hand" in self.state().refusal)
            return
        self.tick_until(lambda: abs(self.state().pressure - other) < 1e-3)
        self.world.run(2000)
        self.assertEqual(self.state().fault, "")
        self.balance.publish(self.stamp(FluidPressure(fluid_pressure=right)))
        self.tick_until(lambda: abs(self.state().pressure - right) < 1e-3)

    def test_it_is_as_good_after_a_reset(self):
        self.world.call("/injector/reset", Trigger)
        number = self.ask()
        self.tick_until(lambda: self.state().last_id == number)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "injector_contract", InjectorContractTest)
