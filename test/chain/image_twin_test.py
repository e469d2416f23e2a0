#!/usr/bin/python3
"""Without a force sensor, images of the dimple move the served cell to where the true one is; its modulus stays."""

import time
import unittest

import actionlib
import rospy
import rostest
from cell_microinjection.msg import CellEstimate, CellParameters, CellState, InjectAction, InjectGoal
from geometry_msgs.msg import WrenchStamped

from messages import force

PATIENCE = 200  # s
HEIGHT = 1.2e-6  # m, of the true cell above where the session believes it
MODULUS = 17.9e3  # Pa, of both
DEPTH = 8e-6  # m
EXACT = 0.3e-6  # m, of the height that images show


class ImageTwinTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.estimates, cls.true_cell = [], None
        cls.forces = {"/cell/predicted_cf": {}, "/true_cell/predicted_cf": {}}
        for topic in cls.forces:
            rospy.Subscriber(topic, WrenchStamped, lambda message, topic=topic: cls.on_force(topic, message),
                             queue_size=2000, tcp_nodelay=True)
        rospy.Subscriber("/cell/estimate", CellEstimate, cls.estimates.append)
        rospy.Subscriber("/true_cell/state", CellState, cls.on_true_cell)
        cls.client = actionlib.SimpleActionClient("/controller/inject", InjectAction)
        assert cls.client.wait_for_server(rospy.Duration(PATIENCE))

    @classmethod
    def on_true_cell(cls, message):
        cls.true_cell = dict(zip(message.parameter_names, message.parameter_values))

    @classmethod
    def on_force(cls, topic, message):
        """Both forces have the stamp of the needle's pose that they are of."""
        if not message.header.stamp.is_zero():
            cls.forces[topic][message.header.stamp.to_nsec()] = force(message)[2]

    def errors(self):
        """Relative, of the felt force where the true one is large, in the order of time."""
        felt, true = self.forces["/cell/predicted_cf"], self.forces["/true_cell/predicted_cf"]
        stamps = sorted(set(felt) & set(true))
        largest = max((true[stamp] for stamp in stamps), default=0)
        return [felt[stamp] / true[stamp] - 1 for stamp in stamps if true[stamp] > 0.2 * largest > 0]

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            time.sleep(0.05)

    def test_the_image_moves_the_served_cell(self):
        changes = rospy.Publisher("/true_cell/set_parameters", CellParameters, queue_size=1, latch=True)
        changes.publish(CellParameters(name=["height"], value=[HEIGHT]))
        self.until(lambda: self.true_cell and self.true_cell["height"] == HEIGHT, "the higher cell")
        self.client.send_goal(InjectGoal(puncture=False, layers=1, depth=DEPTH, hold_time=10 * PATIENCE))
        self.until(lambda: self.estimates and abs(self.estimates[-1].served_height - HEIGHT) < EXACT, "the place of the cell")
        seen = len(self.estimates)
        self.until(lambda: len(self.estimates) > seen + 50, "more images")
        newest, errors = self.estimates[-1], self.errors()
        self.client.cancel_goal()
        self.assertTrue(self.client.wait_for_result(rospy.Duration(PATIENCE)))
        self.assertAlmostEqual(newest.contact, HEIGHT, delta=EXACT)
        self.assertAlmostEqual(newest.served_height, HEIGHT, delta=EXACT)
        # An image does not show the modulus.
        self.assertEqual((newest.verdict, newest.served_modulus), ("prior", MODULUS))
        self.assertIn("no valid force of the sensor", newest.held)
        # Before, the felt force was that of a cell 1.2 um lower; the true modulus was known.
        self.assertLess(min(errors), -0.2)
        self.assertLess(abs(errors[-1]), 0.1)


if __name__ == "__main__":
    rospy.init_node("operator")
    rostest.rosrun("cell_microinjection", "image_twin", ImageTwinTest)
