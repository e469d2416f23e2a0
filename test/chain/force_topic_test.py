#!/usr/bin/python3
"""A wrench from elsewhere arrives at the tip, in its axes and about its centre; what tf cannot place is not valid."""

import math
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from std_srvs.srv import Trigger

from links import await_publishers
from messages import force, wrench
from participant import PATIENCE, Participant

DEVICE = "/force_sensor/device_cf"


class ForceTopicTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        await_publishers("/tf_static", ["/force_sensor_frame", "/transducer_frame"], PATIENCE)
        cls.world = Participant({DEVICE: WrenchStamped}, {"/force_sensor/measured_cf": WrenchStamped})
        for _ in range(20000):  # until the node's tf has taken them up
            cls.world.tick({DEVICE: wrench(0, 0, 1e-6, "transducer")})
            seen = cls.world.seen.get("/force_sensor/measured_cf")
            if seen and not seen.header.stamp.is_zero():
                return
        raise AssertionError("no wrench at the tip within 20 s of ROS time")

    def measured(self):
        return self.world.seen["/force_sensor/measured_cf"]

    def test_force_and_torque_are_those_at_the_tip(self):
        message = wrench(1e-6, 2e-6, 3e-6, "transducer")
        message.wrench.torque.y = 5e-8
        self.world.run(5, {DEVICE: message})
        self.assertEqual(self.measured().header.frame_id, "needle_tip")
        # The transducer's x is the tip's -z, its y the tip's y, its z the tip's x.
        np.testing.assert_allclose(force(self.measured()), [3e-6, 2e-6, -1e-6], atol=1e-15)
        torque = self.measured().wrench.torque
        # It sits at (0, 0, 10 mm): arm x force = (-0.01 x 2e-6, 0.01 x 3e-6, 0).
        np.testing.assert_allclose([torque.x, torque.y, torque.z], [-2e-8, 5e-8 + 3e-8, 0], atol=1e-15)

    def test_tare_takes_off_force_and_torque(self):
        message = wrench(1e-6, 2e-6, 3e-6, "transducer")
        answer = self.world.call("/force_sensor/tare", Trigger, messages={DEVICE: message})
        self.assertTrue(answer.success, answer.message)
        self.world.run(600, {DEVICE: message})
        np.testing.assert_allclose(force(self.measured()), np.zeros(3), atol=1e-12)
        zero = wrench(0, 0, 0, "transducer")
        self.world.call("/force_sensor/tare", Trigger, messages={DEVICE: zero})
        self.world.run(600, {DEVICE: zero})

    def test_what_cannot_be_placed_or_read_is_not_trusted(self):
        for bad, why in ((wrench(1e-6, 0, 0, "nowhere"), "no transform from frame 'nowhere'"),
                         (wrench(math.nan, 0, 0, "transducer"), "no valid wrench"),
                         (None, "no valid wrench")):
            self.world.run(20, {DEVICE: wrench(0, 0, 0, "transducer")})
            self.assertFalse(self.measured().header.stamp.is_zero())
            _, text = self.world.run_to_status("force_sensor: sensor", 1200, {DEVICE: bad} if bad else None)
            self.assertIn(why, text)
            self.assertTrue(self.measured().header.stamp.is_zero())


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "force_topic", ForceTopicTest)
