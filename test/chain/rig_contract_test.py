#!/usr/bin/python3
"""What any rig behind the /needle topics must keep to. All times are those of the lock step, none is of a wall clock."""

import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import ManipulatorAbilities, OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped, TwistStamped

from case import case
from messages import pose, position
from participant import Participant

TICK = 1e-3          # s
START = [0, 0, 60e-6]  # m
STALE = 0.1          # s, command_timeout and velocity_command_timeout of config/micromanipulator.yaml
PATIENCE = 20000     # ticks


class RigContract(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/needle/servo_cp": PoseStamped}, {
            "/needle/measured_cp": PoseStamped, "/needle/abilities": ManipulatorAbilities,
            "/needle/operating_state": OperatingState})
        cls.move = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=10)
        cls.velocity = rospy.Publisher("/needle/servo_cv", TwistStamped, queue_size=10)
        cls.command = rospy.Publisher("/needle/state_command", StringStamped, queue_size=10)
        cls.fault = rospy.Publisher("/needle/emulated_fault", StringStamped, queue_size=10)
        cls.world.await_links()

    def setUp(self):
        self.until(lambda: "/needle/abilities" in self.world.seen, "tells its abilities")
        self.until(lambda: self.state() == "ENABLED", "is ready")
        self.abilities = self.world.seen["/needle/abilities"]  # a slow line has been measured now
        # A rig counts to its resolution; its axes meet at an angle at the worst, and half a count is rounding.
        self.near = 1.5 * max(self.abilities.resolution, 1e-9) + 1e-9
        self.go_to(START)

    # what the rig says

    def needle(self):
        return position(self.world.seen["/needle/measured_cp"])

    def state(self):
        return self.world.seen["/needle/operating_state"].state if "/needle/operating_state" in self.world.seen else ""

    def busy(self):
        return self.world.seen["/needle/operating_state"].is_busy

    def refusal(self):
        status = self.world.diagnostics.get("micromanipulator: commands")
        return status.message if status else ""

    # what it is told

    def until(self, condition, what, messages=None):
        for tick in range(PATIENCE):
            if condition():
                return tick
            self.world.tick(messages() if messages else None)
        self.fail(f"the rig never {what}, is at {self.needle()}: {self.world.diagnostics.get('micromanipulator: commands')}")

    def send(self, publisher, message):
        message.header.stamp = self.world.now
        publisher.publish(message)

    def say(self, publisher, text, messages=None):
        """Until it was heard: from then on ticks count."""
        self.world.run(3, messages)  # what it has to say of its own accord
        sent = self.world.now
        before = self.world.seen["/needle/operating_state"]
        self.send(publisher, StringStamped(string=text))
        self.until(lambda: self.world.seen["/needle/operating_state"] is not before and self.told_state() >= sent,
                   f"heard {text}", messages)

    def is_at(self, target):
        return np.linalg.norm(self.needle() - target) <= self.near * np.sqrt(3)

    def go_to(self, target):
        sent = self.world.now
        self.send(self.move, pose(*target))
        # The state comes over a connection of its own: an older one knows nothing of this move.
        self.until(lambda: self.is_at(target) and not self.busy() and self.told_state() > sent, f"arrived at {target}")

    def told_state(self):
        """The time of the newest operating state."""
        return self.world.seen["/needle/operating_state"].header.stamp

    def check_stands(self, ticks=500):
        """Two readings of a place may be off by a count each, in either direction."""
        held = self.needle()
        for _ in range(ticks):
            self.world.tick()
            self.assertLessEqual(np.abs(self.needle() - held).max(), 2 * self.near)

    # the contract

    def test_moves_arrive_and_stay(self):
        for target in ([20e-6, 0, 60e-6], [20e-6, -15e-6, 90e-6], [-3e-6, 4e-6, 50e-6], [200e-6, 100e-6, 300e-6], START):
            self.go_to(target)
            self.check_stands(300)
            self.assertTrue(self.is_at(target))

    def test_newest_move_wins(self):
        for x in range(1, 8):
            self.send(self.move, pose(x * 10e-6, 0, 60e-6))
            self.world.run(3)
        self.until(lambda: self.is_at([70e-6, 0, 60e-6]) and not self.busy(), "obeyed the last of many moves")
        self.check_stands()
        self.assertTrue(self.is_at([70e-6, 0, 60e-6]))

    def test_follows_set_points(self):
        """20 um/s down, as in an indentation: never ahead, never farther behind than its abilities say, never lost."""
        speed, z = 20e-6, START[2]
        behind = speed * (2 * self.abilities.command_interval + self.abilities.reading_interval + self.abilities.latency +
                          0.02) + 2 * self.near
        for _ in range(1500):
            z -= speed * TICK
            self.world.tick({"/needle/servo_cp": pose(0, 0, z)})
            self.assertLessEqual(self.needle()[2] - z, behind)
            self.assertGreaterEqual(self.needle()[2] - z, -2 * self.near - speed * 0.02)
        self.until(lambda: self.is_at([0, 0, z]), "arrived at the last set-point",
                   lambda: {"/needle/servo_cp": pose(0, 0, z)})
        self.world.run(500, lambda: {"/needle/servo_cp": pose(0, 0, z)})  # what was carried on becomes a true reading
        self.assertTrue(self.is_at([0, 0, z]))
        self.until(lambda: not self.busy(), "came to rest")
        self.check_stands()
        self.assertTrue(self.is_at([0, 0, z]))

    def test_limits(self):
        held = self.needle()
        for target, why in (([1, 0, 0], "manipulator_x = 1 m, allowed"), ([0, 0, -1e-3], "manipulator_z"),
                            ([float("nan"), 0, 0], "not a valid pose")):
            self.send(self.move, pose(*target))
            self.until(lambda: why in self.refusal(), f"refused a move to {target}")
            self.world.run(200, {"/needle/servo_cp": pose(*target)})
            np.testing.assert_allclose(self.needle(), held, atol=self.near)
        too_fast = TwistStamped()
        too_fast.twist.linear.x = 1.0
        # Again and again: the lock step does not wait for it, and one that comes late is refused as stale.
        self.until(lambda: "velocity = 1" in self.refusal(), "refused 1 m/s", lambda: self.send(self.velocity, too_fast))
        np.testing.assert_allclose(self.needle(), held, atol=self.near)

    def test_stop(self):
        """Within 50 ms and what the wire takes, wherever in its exchange the stop finds it."""
        way = self.abilities.speed * (0.05 + self.abilities.stop_time)  # m, the farthest it may still go
        for ticks in (137, 211, 333):
            self.go_to(START)
            self.send(self.move, pose(2e-3, 0, 60e-6))
            self.until(lambda: self.needle()[0] > 5e-6, "set off")
            self.world.run(ticks)
            self.assertLess(self.needle()[0], 1.9e-3)
            self.say(self.command, "stop")
            told = self.needle()
            # The first reading after it stands is a true one.
            self.world.run(int(round((0.05 + self.abilities.stop_time + self.abilities.reading_interval) / TICK)) + 1)
            rested = self.world.now
            self.until(lambda: not self.busy(), "said that it stands")  # the message may be late, its stamp is not
            self.assertLess(self.told_state(), rested)
            self.assertLessEqual(np.linalg.norm(self.needle() - told), way)
            self.check_stands()

    def test_stale_commands_hold(self):
        z = START[2]
        for _ in range(700):
            z += 20e-6 * TICK
            self.world.tick({"/needle/servo_cp": pose(0, 0, z)})
        self.check_holds_after_silence()
        self.go_to(START)
        command = TwistStamped()
        command.twist.linear.x = 20e-6
        for _ in range(70):
            self.send(self.velocity, command)
            self.world.run(10)
        # They are no part of the lock step, and some may be too late.
        self.until(lambda: self.needle()[0] > 2e-6, "followed a velocity", lambda: self.send(self.velocity, command))
        self.check_holds_after_silence()

    def check_holds_after_silence(self):
        """The end is a true reading: what was carried on until then may be a little beside it."""
        told = self.needle()
        self.world.run(int(round((STALE + 0.05 + self.abilities.stop_time + self.abilities.reading_interval) / TICK)) + 1)
        farthest = 20e-6 * (STALE + 0.05 + self.abilities.stop_time + self.abilities.command_interval) + 2 * self.near
        self.assertLessEqual(np.linalg.norm(self.needle() - told), farthest)
        self.check_stands()

    def test_stop_outlasts_a_stream(self):
        """Who goes on streaming after a stop moves nothing; after a pause it is a new stream."""
        z = START[2]

        def stream():
            nonlocal z
            z += 20e-6 * TICK
            return {"/needle/servo_cp": pose(0, 0, z)}

        for _ in range(700):
            self.world.tick(stream())
        self.assertGreater(self.needle()[2], START[2] + 2e-6)
        self.say(self.command, "stop", stream)
        for _ in range(1500):  # to come to rest
            self.world.tick(stream())
        held = self.needle()
        for _ in range(1000):
            self.world.tick(stream())
            self.assertLessEqual(np.abs(self.needle() - held).max(), 2 * self.near)
        self.world.run(int(STALE / TICK) + 50)
        self.until(lambda: self.is_at([0, 0, z]), "obeyed a new stream", lambda: {"/needle/servo_cp": pose(0, 0, z)})

    def faults(self):
        """Of this rig, and whether it must be a fault that waits for enable; it may get over the others by itself."""
        if self.abilities.device == "simulated":
            return {"error:4": True}
        if "Zaber" in self.abilities.device:
            return {"silence:1.5": False, "silence:4": True, "error:BADDATA": True, "error:FS": True}
        return {"silence:1.5": False, "silence:4": True, "error:4": False}

    def test_fault_and_recovery(self):
        for fault, stays in self.faults().items():
            with case(fault):
                self.go_to(START)
                self.say(self.fault, fault)
                self.send(self.move, pose(30e-6, 0, 60e-6))
                self.until(lambda: self.state() != "ENABLED" or (self.is_at([30e-6, 0, 60e-6]) and not self.busy()),
                           "noticed, or got over it")
                if stays:  # a device that is silent is DISABLED first
                    self.until(lambda: self.state() != "ENABLED" and self.state() != "DISABLED", "told of the fault")
                    self.assertEqual(self.state(), "FAULT")
                if self.state() != "ENABLED":
                    self.send(self.move, pose(60e-6, 0, 60e-6))
                    self.until(lambda: "move_cp refused" in self.refusal(), "refused a move while it was at fault")
                    self.world.run(5000)  # longer than any silence
                    self.say(self.command, "enable")
                    self.until(lambda: self.state() == "ENABLED", "recovered")
                self.check_stands()
                self.go_to([10e-6, 0, 70e-6])

    def test_pulled_cable(self):
        if self.abilities.device == "simulated":
            self.skipTest("the simulated rig has no cable")
        self.send(self.move, pose(500e-6, 0, 60e-6))
        self.until(lambda: self.needle()[0] > 5e-6, "set off")
        self.say(self.fault, "pull:2.0")
        self.until(lambda: self.state() == "DISABLED", "said that its device is gone")
        self.until(lambda: self.state() == "ENABLED", "connected again")
        self.check_stands(1000)  # nothing is begun again by itself
        self.go_to([10e-6, 0, 70e-6])


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "rig_contract", RigContract)
