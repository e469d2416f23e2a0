"""What the tests of an injector in lock step share: who asks for pulses and balance pressures, and what it says."""

import unittest

import rospy
from sensor_msgs.msg import FluidPressure

from cell_microinjection.msg import InjectionPulse, InjectorState, StringStamped
from participant import Participant

PRESSURE = 20e3  # Pa
TICK = 0.001  # s


class InjectorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/injector/pulse": InjectionPulse, "/injector/stop": StringStamped},
                                {"/injector/state": InjectorState})
        cls.pulses = rospy.Publisher("/injector/pulse", InjectionPulse, queue_size=10)
        cls.balance = rospy.Publisher("/injector/set_balance", FluidPressure, queue_size=10)
        cls.stops = rospy.Publisher("/injector/stop", StringStamped, queue_size=10)
        cls.world.await_links()

    def state(self):
        return self.world.seen["/injector/state"]

    def tick_until(self, condition, patience=20):
        for _ in range(round(patience / TICK)):
            self.world.tick()
            if condition():
                return
        self.fail(f"did not happen within {patience} s of ROS time; injector:\n{self.state()}")

    def set_balance(self, pressure):
        """Pa, gauge."""
        message = FluidPressure(fluid_pressure=pressure)
        message.header.stamp = self.world.now
        self.balance.publish(message)

    def send(self, number, pressure=PRESSURE, duration=0.05, age=0.0, held=False):
        message = InjectionPulse(id=number, pressure=pressure, duration=duration, held=held)
        if age == 0.0:  # in lock step: else it may be late, and refused as stale
            self.world.tick({"/injector/pulse": message})
            return
        message.header.stamp = self.world.now - rospy.Duration(age)
        self.pulses.publish(message)
