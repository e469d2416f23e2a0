#!/usr/bin/python3
"""The micromanipulator refuses what it cannot do, stays where it was, and stops when a velocity command grows old."""

import math
import pathlib
import subprocess
import sys
import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped, TwistStamped

from messages import pose, position
from participant import Participant

STATUS = "micromanipulator: commands"


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/needle/servo_cp": PoseStamped},
                                {"/needle/measured_cp": PoseStamped, "/needle/operating_state": OperatingState})
        cls.velocity = rospy.Publisher("/needle/servo_cv", TwistStamped, queue_size=10)
        cls.move = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=10)
        cls.command = rospy.Publisher("/needle/state_command", StringStamped, queue_size=10)
        cls.world.await_links()

    def setUp(self):
        self.world.run(700, lambda: {"/needle/servo_cp": pose(0, 0, 50e-6)})
        self.world.run(3)
        np.testing.assert_allclose(self.needle(), [0, 0, 50e-6], atol=1e-9)

    def needle(self):
        return position(self.world.seen["/needle/measured_cp"])

    def check_refused(self, command, why):
        level, text = self.world.run_to_status(STATUS, 300, {"/needle/servo_cp": command})
        np.testing.assert_allclose(self.needle(), [0, 0, 50e-6], atol=1e-9)
        self.assertNotEqual(level, 0)
        self.assertIn(why, text)

    def test_refuses_servo_cp(self):
        self.check_refused(pose(0, 0, math.nan), "not a valid pose in world")
        self.check_refused(pose(0, 0, 40e-6, "camera"), "not a valid pose in world")
        self.check_refused(pose(1, 0, 0), "manipulator_x = 1 m, allowed [-0.0125, 0.0125] m")
        tilted = pose(0, 0, 40e-6)
        tilted.pose.orientation.x, tilted.pose.orientation.w = 0.6, 0.8
        self.check_refused(tilted, "orientation differs")

    def tick_until(self, condition, messages=None):
        for _ in range(20000):
            self.world.tick(messages)
            if condition():
                return
        self.fail("did not happen within 20 s of ROS time")

    def tick_commanding(self, publisher, command, condition):
        """Commands again in each tick: they are no part of the lock step, and some may be late."""
        for _ in range(20000):
            command.header.stamp = self.world.now
            publisher.publish(command)
            self.world.tick()
            if condition():
                return
        self.fail("did not happen within 20 s of ROS time")

    def test_stale_velocity_stops(self):
        command = TwistStamped()
        command.twist.linear.x = 50e-6
        self.tick_commanding(self.velocity, command, lambda: self.needle()[0] > 1e-6)
        self.world.run(300)
        held = self.needle()
        self.world.run(300)
        np.testing.assert_array_equal(self.needle(), held)
        self.assertLess(held[0], 50e-6 * 0.2)  # 0.1 s of command, and its braking

    def told(self, name=STATUS):
        """What the newest diagnostics say; nothing before they have come."""
        status = self.world.diagnostics.get(name)
        return status.message if status else ""

    def tick_until_refused(self, why):
        self.tick_until(lambda: why in self.told())
        np.testing.assert_allclose(self.needle(), [0, 0, 50e-6], atol=1e-9)

    def forget_the_refusal(self):
        """Until none is reported: the next one could be taken for it, and two commands arrive in any order."""
        self.tick_until(lambda: "refused" not in self.told(),
                        {"/needle/servo_cp": pose(0, 0, 50e-6)})

    def test_refuses_what_is_not_finite_or_in_another_frame(self):
        self.move.publish(pose(20e-6, -10e-6, 70e-6, "camera"))
        self.tick_until_refused("move_cp refused: not a valid pose")
        self.forget_the_refusal()
        self.move.publish(pose(20e-6, math.nan, 70e-6))
        self.tick_until_refused("move_cp refused: not a valid pose")
        self.forget_the_refusal()
        command = TwistStamped()
        command.twist.linear.x = math.inf
        self.velocity.publish(command)
        self.tick_until_refused("servo_cv refused: not a valid velocity")
        self.forget_the_refusal()
        command.twist.linear.x = 50e-6
        command.header.frame_id = "camera"
        self.velocity.publish(command)
        self.tick_until_refused("servo_cv refused: not a valid velocity")

    def test_takes_what_has_no_stamp_as_of_its_arrival(self):
        """CRTK: a command's stamp and frame may be empty."""
        command = TwistStamped()
        command.twist.linear.x = 50e-6
        self.velocity.publish(command)
        self.tick_until(lambda: self.needle()[0] > 1e-6)
        self.world.run(300)
        self.move.publish(pose(20e-6, -10e-6, 70e-6, ""))
        self.tick_until(lambda: np.allclose(self.needle(), [20e-6, -10e-6, 70e-6], atol=1e-9))

    def test_refuses_stamps_that_are_ahead(self):
        """Of a second and more, up to the last one that there is; it used to end the node."""
        self.world.run(200)
        for seconds in (30, 3600, 2 ** 31 + 1, 2 ** 32 - 2):
            move, velocity = pose(20e-6, -10e-6, 70e-6), TwistStamped()
            velocity.twist.linear.x = 50e-6
            for publisher, message in ((self.move, move), (self.velocity, velocity)):
                # Of this message's time: the diagnostics of the one before take up to a second.
                message.header.stamp = rospy.Time(int(min(self.world.now.to_sec() + seconds, 2 ** 32 - 1)), 999999999)
                publisher.publish(message)
                topic = publisher.name[1:]
                self.tick_until(lambda: f"{topic}: refused, its stamp is" in self.told("micromanipulator: inputs"))
            np.testing.assert_allclose(self.needle(), [0, 0, 50e-6], atol=1e-9)

    def test_servo_keeps_the_speed_limit(self):
        """Of config/micromanipulator.yaml, whoever commands and however far the target leaps."""
        heights = {}
        for _ in range(300):
            self.world.tick({"/needle/servo_cp": pose(0, 0, 150e-6)})
            told = self.world.seen["/needle/measured_cp"]
            heights[told.header.stamp.to_sec()] = told.pose.position.z
        fastest = np.abs(np.diff(list(heights.values())) / np.diff(list(heights))).max()
        self.assertLess(fastest, 200e-6 * 1.001)
        self.assertGreater(fastest, 200e-6 * 0.9)
        command = TwistStamped()
        command.twist.linear.x = 250e-6
        self.world.run(200)
        self.tick_commanding(self.velocity, command, lambda: "allowed at most servo_speed_limit" in self.told())

    def test_second_publisher_is_a_fault_until_enable(self):
        """It is another node, since this one may publish on as many topics as it likes."""
        holding = {"/needle/servo_cp": pose(0, 0, 50e-6)}
        stranger = subprocess.Popen([pathlib.Path(sys.argv[0]).parent / "second_master.py"])
        try:
            for _ in range(60000):
                self.world.tick(holding)
                if self.state() == "FAULT":
                    break
            self.assertEqual(self.state(), "FAULT")
            moved = self.needle()[2] - 50e-6
            self.assertLess(moved, 1e-6)
            level, text = self.world.run_to_status(STATUS, 300, holding)
            self.assertEqual(level, 2)
            self.assertRegex(text, "two nodes command the needle: (/world and /stranger|/stranger and /world)")
            np.testing.assert_allclose(self.needle()[2], 50e-6 + moved, atol=1e-6)
        finally:
            stranger.kill()
            stranger.wait()
        self.world.run(200)
        self.command.publish(StringStamped(string="enable"))
        self.tick_until(lambda: self.state() == "ENABLED")

    def state(self):
        said = self.world.seen.get("/needle/operating_state")
        return said.state if said else None

    def test_move_arrives(self):
        command = pose(20e-6, -10e-6, 70e-6)
        self.tick_commanding(self.move, command, lambda: self.world.seen["/needle/operating_state"].is_busy)
        self.tick_until(lambda: np.allclose(self.needle(), [20e-6, -10e-6, 70e-6], atol=1e-9))


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_micromanipulator", TrustTest)
