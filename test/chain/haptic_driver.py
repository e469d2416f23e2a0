"""What the tests of the haptic adapters share: a driver's topics, which take no part in the lock step."""

import time
import unittest

import genpy.dynamic
import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from cell_microinjection.msg import StringStamped
from messages import position
from participant import PATIENCE, Participant

HAND, FORCE = "/haptic/measured_cp", "/haptic/servo_cf"
CLUTCH, PRESENT, COMMAND = "/haptic/clutch", "/haptic/operator_present", "/controller/state_command"


class HapticTest(unittest.TestCase):
    """The world of a device: the bridge's force and the driver's topics (`driver`: topic -> class, in lock step;
    `inputs`: the same of what the driver hears)."""

    driver = {}
    inputs = {}

    @classmethod
    def setUpClass(cls):
        cls.commands = []
        rospy.Subscriber(COMMAND, StringStamped, lambda message: cls.commands.append(message.string))
        cls.world = Participant({FORCE: WrenchStamped, **cls.driver},
                                {HAND: PoseStamped, CLUTCH: Joy, PRESENT: Joy, **cls.inputs})

    def until(self, condition, messages, what):
        """Ticks with `messages` until condition(): a message outside of the lock step comes when it comes."""
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            self.world.tick(messages() if callable(messages) else messages)

    def seen(self, topic):
        return self.world.seen[topic]

    def hand(self):
        return position(self.seen(HAND))

    def check_silent(self):
        self.assertTrue(self.seen(HAND).header.stamp.is_zero())
        self.assertEqual(self.seen(PRESENT).buttons[0], 0)


class Received:
    """Every message of a topic of a driver."""

    def __init__(self, topic, kind):
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append)

    def forces(self):
        return np.array([[m.force.x, m.force.y, m.force.z] for m in list(self.messages)]).reshape(-1, 3)

    def check_type(self, test, kind):
        """The publisher's own words: type, md5 sum, and a definition with that md5 sum."""
        header = self.messages[-1]._connection_header
        test.assertEqual(header["type"], kind._type)
        test.assertEqual(header["md5sum"], kind._md5sum)
        told = genpy.dynamic.generate_dynamic(header["type"], header["message_definition"])[kind._type]
        test.assertEqual(told._md5sum, kind._md5sum)
