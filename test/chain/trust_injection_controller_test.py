#!/usr/bin/python3
"""The controller holds the needle while target, needle or force is not valid, and says so."""

import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rosgraph_msgs.msg import Log

from cell_microinjection.msg import InjectionPulse, InjectionStatus, InjectorState, ManipulatorAbilities, StringStamped
from messages import pose, position, wrench
from participant import INVALID, Participant

START = 60e-6  # m
STATUS = "injection_controller: control"


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/teleop/servo_cp": PoseStamped, "/needle/measured_cp": PoseStamped,
                                 "/cell/predicted_cf": WrenchStamped, "/injector/state": InjectorState},
                                {"/needle/servo_cp": PoseStamped, "/injector/pulse": InjectionPulse,
                                 "/injector/stop": StringStamped, "/controller/injection_state": InjectionStatus})
        cls.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=10)
        cls.world.await_links()

    def setUp(self):
        self.target = self.setpoint() if "/needle/servo_cp" in self.world.seen else START
        self.assertEqual(self.world.run_to_status(STATUS, 300, self.good), (0, "the needle follows"))

    def good(self):
        """A target, a needle that is where it was sent, a force."""
        at = self.setpoint() if "/needle/servo_cp" in self.world.seen else START
        return {"/teleop/servo_cp": pose(0, 0, self.target), "/needle/measured_cp": pose(0, 0, at),
                "/cell/predicted_cf": wrench(0, 0, 0)}

    def setpoint(self):
        return position(self.world.seen["/needle/servo_cp"])[2]

    def check_held(self, bad, why):
        """`bad` replaces messages; None: silence."""
        def messages():
            merged = {**self.good(), **bad}
            return {topic: message for topic, message in merged.items() if message is not None}
        self.world.run(60, messages)  # past the time-out of 50 ms
        held = self.setpoint()
        self.target -= 10e-6
        level, text = self.world.run_to_status(STATUS, 300, messages)
        self.assertEqual(self.setpoint(), held)
        self.assertNotEqual(level, 0)
        self.assertIn(why, text)
        # Back again: what the target did meanwhile must not be caught up with, what it does now must be followed.
        self.world.run(300, self.good)
        self.assertAlmostEqual(self.setpoint(), held, delta=1e-12)
        self.target -= 2e-6
        self.world.run(300, self.good)
        self.assertAlmostEqual(self.setpoint(), held - 2e-6, delta=1e-12)

    def test_target(self):
        self.check_held({"/teleop/servo_cp": None}, "no valid target")
        self.check_held({"/teleop/servo_cp": INVALID}, "no valid target")
        self.check_held({"/teleop/servo_cp": pose(0, 0, math.nan)}, "no valid target")
        self.check_held({"/teleop/servo_cp": pose(0, 0, 0, "camera")}, "no valid target")

    def test_force(self):
        self.check_held({"/cell/predicted_cf": None}, "no valid force")
        self.check_held({"/cell/predicted_cf": wrench(0, 0, math.inf)}, "no valid force")

    def test_needle(self):
        self.check_held({"/needle/measured_cp": None}, "no valid needle position")
        self.check_held({"/needle/measured_cp": pose(math.nan, 0, 0)}, "no valid needle position")

    def test_through_the_membrane_the_word_inject_is_one_pulse_and_disable_stops_it(self):
        """A membrane of 0.2 N/m that fails 5 um deep."""
        surface, self.through, self.busy = self.setpoint() - 3e-6, False, False

        def world():
            depth = max(0.0, surface - self.setpoint())
            self.through = self.through or depth > 5e-6
            return {**self.good(), "/injector/state": InjectorState(busy=self.busy),
                    "/cell/predicted_cf": wrench(0, 0, 0.1e-6 if self.through else 0.2 * depth)}

        def run_until(condition, what):
            for _ in range(20000):
                if condition():
                    return
                self.target -= 5e-9 if what == "the puncture" else 0  # 5 um/s
                self.world.tick(world())
            self.fail(f"{what}: did not happen within 20 s; {self.world.seen['/controller/injection_state']}")

        seen = self.world.seen
        run_until(lambda: seen["/controller/injection_state"].state == "punctured", "the puncture")
        self.assertEqual(seen["/controller/injection_state"].punctures, 1)
        self.assertNotIn("/injector/pulse", seen)
        self.commands.publish(StringStamped(string="inject"))
        run_until(lambda: "/injector/pulse" in seen, "the pulse")
        pulse = seen["/injector/pulse"]
        goal = rospy.get_param("/injection_controller/goal/pulse")
        self.assertEqual((pulse.pressure, pulse.duration), (goal["pressure"], goal["duration"]))
        self.busy = True
        self.world.run(100, world)
        self.assertEqual(seen["/injector/pulse"].id, pulse.id)
        self.assertEqual(seen["/controller/injection_state"].state, "inject")
        self.assertNotIn("/injector/stop", seen)
        self.commands.publish(StringStamped(string="disable"))
        run_until(lambda: "/injector/stop" in seen, "the stop")
        self.assertEqual(seen["/controller/injection_state"].state, "idle")

    def test_abilities_that_no_rig_has_are_ignored(self):
        abilities = rospy.Publisher("/needle/abilities", ManipulatorAbilities, queue_size=10)
        log = []
        listener = rospy.Subscriber("/rosout", Log, lambda message: log.append(message.msg))
        self.addCleanup(listener.unregister)

        def await_log(device):
            for _ in range(20000):
                if any(device in text for text in log):
                    return
                self.world.tick(self.good())
            self.fail(f"nothing of {device} in the log within 20 s")
        self.world.await_links()
        devices = iter("test " + letter for letter in "abcdefghij")

        def limit(speed, latency, interval=0.0):
            """m/s that the needle may be moved at after this announcement, which the log tells of."""
            device = next(devices)
            abilities.publish(ManipulatorAbilities(device=device, speed=speed, latency=latency,
                                                   command_interval=interval))
            await_log(device)
            self.world.run_to_status(STATUS, 20, self.good)
            values = self.world.diagnostics[STATUS].values
            return next(float(pair.value) for pair in values if pair.key == "speed limit (m/s)")

        self.assertAlmostEqual(limit(44e-6, 0.0), 44e-6)
        for bad in ((math.inf, 0.0), (math.nan, 0.0), (1e300, 0.0), (100e-6, math.inf), (100e-6, math.nan),
                    (100e-6, 1e300), (100e-6, -5.0, 5.0), (100e-6, 5.0, -5.0)):
            self.assertAlmostEqual(limit(*bad), 44e-6, msg=str(bad))
        self.assertAlmostEqual(limit(1.0, 0.001), rospy.get_param("/injection_controller/speed_limit"))

    def test_target_that_leaps(self):
        held = self.setpoint()
        self.target -= 150e-6
        text = self.world.run_to_status(STATUS, 300, self.good)[1]
        self.assertEqual(self.setpoint(), held)
        self.assertIn("allowed 0.0001 m", text)
        self.target += 150e-6
        self.world.run(300, self.good)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_injection_controller", TrustTest)
