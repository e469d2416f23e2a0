#!/usr/bin/python3
"""The online twin learns from no reading that it cannot trust, says why, and has nothing served that it has not learned."""

import math
import unittest

import rospy
import rostest
from cell_microinjection.msg import CellEstimate, CellParameters, InjectionStatus
from geometry_msgs.msg import PoseStamped, WrenchStamped

from messages import pose, wrench
from participant import INVALID, Participant

SURFACE = 28e-6  # m
STATUS = "cell_estimator: cell under the needle"


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant(
            {"/needle/measured_cp": PoseStamped, "/force_sensor/measured_cf": WrenchStamped,
             "/controller/injection_state": InjectionStatus},
            {"/cell/estimate": CellEstimate, "/cell/set_parameters": CellParameters})
        cls.changes = []
        rospy.Subscriber("/cell/set_parameters", CellParameters, cls.changes.append)
        cls.world.await_links()

    def setUp(self):
        self.height, self.punctures = SURFACE + 20e-6, 0
        self.world.run(200, self.messages)
        self.assertEqual(self.estimate().held, "")

    def messages(self, **others):
        """Of a cell that is a spring of 0.05 N/m. No two readings of a sensor are the same."""
        depth = max(0.0, SURFACE - self.height)
        noise = 1e-10 * math.sin(1e4 * self.world.now.to_sec())
        return {"/needle/measured_cp": pose(0, 0, self.height),
                "/force_sensor/measured_cf": wrench(0, 0, 0.05 * depth + noise, "needle_tip"),
                "/controller/injection_state": InjectionStatus(state="indent", punctures=self.punctures), **others}

    def estimate(self):
        return self.world.seen["/cell/estimate"]

    def lower(self, height, **others):
        while self.height > height:
            self.height -= 20e-9
            self.world.tick(self.messages(**others))

    def check_held(self, why, **others):
        """Nothing is learned from an indentation with this message."""
        self.height = SURFACE + 1e-6
        self.world.run(60, lambda: self.messages(**others))
        before = self.estimate().samples
        self.lower(SURFACE - 3e-6, **others)
        self.assertIn(why, self.estimate().held)
        self.assertEqual(self.estimate().samples, before)
        self.assertEqual(self.estimate().verdict, "prior")

    def test_learns_nothing_from_what_it_cannot_trust(self):
        tilted = pose(0, 0, SURFACE - 1e-6)
        tilted.pose.orientation.x, tilted.pose.orientation.w = math.sin(0.05), math.cos(0.05)
        for topic, message, why in (
                ("/needle/measured_cp", INVALID, "no valid needle pose"),
                ("/needle/measured_cp", pose(0, 0, math.nan), "no valid needle pose"),
                ("/needle/measured_cp", pose(0, 0, SURFACE, "camera"), "no valid needle pose"),
                ("/needle/measured_cp", tilted, "the needle is tilted"),
                ("/force_sensor/measured_cf", INVALID, "no valid force"),
                ("/force_sensor/measured_cf", wrench(0, 0, math.inf, "needle_tip"), "no valid force"),
                ("/force_sensor/measured_cf", wrench(0, 0, 1e-6, "camera"), "no valid force"),
                ("/force_sensor/measured_cf", wrench(0, 0, 480e-6, "needle_tip"), "saturated")):
            with self.subTest(why, topic=topic):
                self.setUp()
                self.changes.clear()
                self.check_held(why, **{topic: message})
                self.assertEqual(self.changes, [])

    def test_learns_nothing_once_a_message_is_old(self):
        for topic, why in (("/needle/measured_cp", "needle pose"), ("/force_sensor/measured_cf", "no valid force"),
                           ("/controller/injection_state", "nobody knows of a puncture")):
            with self.subTest(topic):
                self.setUp()
                others = self.messages()
                del others[topic]
                self.world.run(700, others)
                self.assertIn(why, self.estimate().held)

    def test_a_puncture_ends_the_lesson_until_the_needle_is_clear(self):
        self.lower(SURFACE - 3e-6)
        self.assertEqual(self.estimate().held, "")
        learned = self.estimate().samples
        self.assertGreater(learned, 10)
        self.punctures = 1
        self.lower(SURFACE - 5e-6)
        self.assertIn("punctured", self.estimate().held)
        self.assertLessEqual(self.estimate().samples, learned + 1)
        self.height = SURFACE + 20e-6  # the count stays until the needle starts anew
        self.world.run(100, self.messages)
        self.assertEqual(self.estimate().held, "")
        self.assertEqual(self.estimate().verdict, "prior")
        self.lower(SURFACE - 3e-6)
        self.assertGreater(self.estimate().samples, 10)

    def test_a_force_of_no_such_cell_is_inconsistent_and_the_prior_is_served(self):
        self.height = SURFACE + 1e-6
        while self.height > SURFACE - 8e-6:  # what is touched gives way
            self.height -= 20e-9
            depth = max(0.0, SURFACE - self.height)
            yields = 0.05 * min(depth, 4e-6 - 0.5 * min(depth, 4e-6)) + 1e-9 * math.sin(1e9 * depth)
            self.world.tick(self.messages(**{"/force_sensor/measured_cf": wrench(0, 0, yields, "needle_tip")}))
        self.assertEqual(self.estimate().verdict, "inconsistent")
        self.assertEqual(self.estimate().modulus, 17.9e3)
        self.world.run(3000, self.messages)
        self.assertAlmostEqual(self.estimate().served_modulus / 17.9e3, 1, delta=0.01)
        level, text = self.world.run_to_status(STATUS, 10, self.messages)
        self.assertNotEqual(level, 0)
        self.assertIn("inconsistent", text)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_cell_estimator", TrustTest)
