#!/usr/bin/python3
"""The needle of a session with an emulated rig, or a node of one's own, gets where it is sent, by the clock on the wall, however long that takes."""

import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped, WrenchStamped

from messages import pose, position

PATIENCE = 60  # s; only a session that hangs takes that long
WAY = np.array([3e-6, -2e-6, 5e-6])  # m
RESOLUTION = 0.1e-6  # m: two steps of the coarser rig


class RigLiveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.seen = {}
        cls.subscribers = [rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.seen.update({topic: message}))
                           for topic, kind in (("/needle/measured_cp", PoseStamped),
                                               ("/needle/operating_state", OperatingState),
                                               ("/controller/operating_state", OperatingState),
                                               ("/cell/predicted_cf", WrenchStamped))]
        cls.words = rospy.Publisher("/controller/state_command", StringStamped, queue_size=1)
        cls.enable = rospy.Publisher("/needle/state_command", StringStamped, queue_size=1)
        cls.moves = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=1)
        cls.recoveries = 0

    def until(self, condition, what, say=None):
        """`say` is called each second."""
        for i in range(100 * PATIENCE):
            if condition():
                return
            if say and i % 100 == 0:
                say()
            rospy.rostime.wallsleep(0.01)
        self.fail(f"{what}: not within {PATIENCE} s; seen {self.seen}")

    def says(self, topic, state):
        return topic in self.seen and self.seen[topic].state == state

    def recover(self):
        """From a fault that the machine caused, which it does seldom, or the DISABLED in which a rig starts."""
        fault = self.says("/needle/operating_state", "FAULT")
        if fault:
            type(self).recoveries += 1
            self.assertLessEqual(self.recoveries, 5, "the rig falls back to FAULT")
        if fault or self.says("/needle/operating_state", "DISABLED"):
            self.enable.publish(StringStamped(string="enable"))

    def send(self, goal):
        """Again and again: on a machine that stalls a driver ends a move in which the emulator was silent for long."""
        self.recover()
        message = pose(*goal)
        message.header.stamp = rospy.Time.now()
        self.moves.publish(message)

    def is_at(self, goal):
        needle = self.needle()
        return needle is not None and np.abs(needle - goal).max() <= RESOLUTION

    def needle(self):
        message = self.seen.get("/needle/measured_cp")
        return position(message) if message and not message.header.stamp.is_zero() else None

    def place(self):
        """The next that is valid: a rig that is silent for long has none."""
        seen = []

        def look():
            seen.append(self.needle())
            return seen[-1] is not None

        self.until(look, "a place of the needle", self.recover)
        return seen[-1]

    def test_it_gets_where_it_is_sent_and_the_cell_is_beside_it(self):
        self.until(self.moves.get_num_connections, "the micromanipulator")
        self.place()
        self.until(lambda: self.says("/needle/operating_state", "ENABLED"), "ENABLED", self.recover)
        # It holds the needle where it is.
        self.until(lambda: self.says("/controller/operating_state", "ENABLED"), "the controller")
        self.until(self.words.get_num_connections, "its ear for words")
        self.words.publish(StringStamped(string="disable"))
        self.until(lambda: self.says("/controller/operating_state", "DISABLED"), "a controller that lets go")
        goal = self.place() + WAY
        self.until(lambda: self.is_at(goal), f"the needle at {goal}", lambda: self.send(goal))
        self.until(lambda: "/cell/predicted_cf" in self.seen, "the cell's predicted force")


if __name__ == "__main__":
    rospy.init_node("mover")
    rostest.rosrun("cell_microinjection", "rig_live", RigLiveTest)
