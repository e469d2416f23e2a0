#!/usr/bin/python3
"""Parameters of the cell change under a pressed needle: the force follows without a jump, /cell/state says which
parameters are felt, and what is wrong changes nothing."""

import math
import unittest

import rospy
import rostest
from cell_microinjection.msg import CellParameters, CellState
from cell_microinjection.srv import SetCellParameters
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped

from case import case
from messages import force, pose
from participant import Participant

MODULUS, DIAMETER = 17.9e3, 56e-6  # Pa, m, of the scene
DEPTH = 8e-6                       # m, in which the zona holds
CHANGE = 30                        # ticks, within which a change is complete


class ChangeCellTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/needle/measured_cp": PoseStamped},
                                {"/cell/predicted_cf": WrenchStamped, "/cell/state": CellState})
        cls.topic = rospy.Publisher("/cell/set_parameters", CellParameters, queue_size=1, latch=False)
        cls.world.await_links()

    def needle(self, depth=DEPTH):
        return {"/needle/measured_cp": pose(0, 0, 0.5 * DIAMETER - depth)}

    def predicted(self):
        message = self.world.seen["/cell/predicted_cf"]
        self.assertFalse(message.header.stamp.is_zero())
        return force(message)[2]

    def felt(self, name):
        state = self.world.seen["/cell/state"]
        return dict(zip(state.parameter_names, state.parameter_values))[name]

    def setUp(self):
        self.world.run(50, self.needle(-5e-6))
        self.assertTrue(self.change(["young_modulus", "diameter", "height"], [MODULUS, DIAMETER, 0], self.needle(-5e-6)).success)
        for step in range(100):
            self.world.tick(self.needle(step * 0.01 * DEPTH))
        self.world.run(50, self.needle)
        self.assertGreater(self.predicted(), 0.2e-6)

    def change(self, names, values, messages=None):
        """A change may begin some ticks before its call returns: follow() gives their forces, too."""
        self.forces = []

        def pressed():
            self.forces.append(self.predicted())
            return self.needle()
        return self.world.call("/cell_simulator/set_cell_parameters", SetCellParameters, names, values,
                               messages=messages or pressed)

    def follow(self):
        """@returns the force in each tick of the last call and in the next ones, with a pressed needle."""
        forces = [*self.forces, self.predicted()]
        for _ in range(CHANGE):
            self.world.tick(self.needle())
            forces.append(self.predicted())
        self.world.run(30, self.needle)  # /cell/state has a rate of its own
        return forces

    def check_steady(self, before, forces):
        """The change takes 20 ms: no step is larger than an eighth of it."""
        steps = [abs(b - a) for a, b in zip([before, *forces], forces)]
        self.assertLess(max(steps), abs(forces[-1] - before) / 8 + 1e-12)

    def test_another_modulus(self):
        before = self.predicted()
        answer = self.change(["young_modulus"], [15e3])
        self.assertTrue(answer.success, answer.message)
        self.assertIn("family homogeneous", answer.message)
        forces = self.follow()
        self.assertAlmostEqual(forces[-1] / before, 15 / 17.9, delta=1e-3)
        self.check_steady(before, forces)
        self.assertEqual(self.felt("young_modulus"), 15e3)

    def test_by_topic(self):
        before = self.predicted()
        self.topic.publish(CellParameters(name=["young_modulus"], value=[20e3]))
        for _ in range(20000):  # it comes when it comes: it takes no part in the lock step
            self.world.tick(self.needle())
            if self.felt("young_modulus") == 20e3:
                break
        self.world.run(CHANGE, self.needle)
        self.assertAlmostEqual(self.predicted() / before, 20 / 17.9, delta=1e-3)

    def test_another_diameter_keeps_the_contact(self):
        before = self.predicted()
        answer = self.change(["diameter"], [62e-6])
        self.assertTrue(answer.success, answer.message)
        forces = self.follow()
        self.check_steady(before, forces)
        self.assertAlmostEqual(forces[-1] / before, 1, delta=0.2)  # the same depth in a cell that is a little larger
        self.assertEqual(self.felt("diameter"), 62e-6)
        self.world.run(50, self.needle(-20e-6))
        self.world.run(20, self.needle(-1e-6))  # below the surface that the larger cell has now
        self.assertGreater(self.predicted(), 10e-9)

    def test_another_height_is_another_depth(self):
        before = self.predicted()
        answer = self.change(["height"], [0.3e-6])
        self.assertTrue(answer.success, answer.message)
        forces = self.follow()
        self.check_steady(before, forces)
        self.assertEqual(self.felt("height"), 0.3e-6)
        higher = self.predicted()
        self.world.run(50, lambda: self.needle(DEPTH))
        self.assertTrue(self.change(["height"], [0.0]).success)
        self.follow()
        self.assertAlmostEqual(self.predicted() / before, 1, delta=1e-6)
        self.world.run(20, lambda: self.needle(DEPTH + 0.3e-6))
        self.assertAlmostEqual(self.predicted() / higher, 1, delta=1e-3)

    def test_what_is_wrong_changes_nothing(self):
        before = self.predicted()
        for names, values, reason in ((["young_modulus"], [0.0], "young_modulus = 0: must be"),
                                      (["young_modulus"], [math.nan], "young_modulus = nan: must be"),
                                      (["diameter"], [-math.inf], "diameter = -inf: must be"),
                                      (["poisson_ratio"], [0.3], "outside of family homogeneous: "),
                                      (["diameter"], [150e-6], "outside of family homogeneous: "),
                                      (["core_modulus"], [1e3], "core_modulus: is no parameter of this cell; these are: "),
                                      (["height"], [math.nan], "height = nan m: must be within"),
                                      (["young_modulus", "height"], [15e3, 20e-6], "height = 2e-05 m: must be within"),
                                      (["young_modulus"], [], "must have one for each of the 1 names"),
                                      ([], [], "must have at least one")):
            with case(names, values):
                answer = self.change(names, values)
                self.assertFalse(answer.success)
                self.assertIn(reason, answer.message)
        self.assertEqual(self.follow()[-1], before)
        self.assertEqual(self.felt("young_modulus"), MODULUS)
        self.assertEqual(self.felt("height"), 0)

    def test_a_message_that_is_wrong_is_reported(self):
        before = self.predicted()
        said = []  # each report, because only one has it
        heard = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: said.extend(
            status.message for status in message.status if status.name == "cell_simulator: inputs"))
        self.addCleanup(heard.unregister)
        self.topic.publish(CellParameters(name=["young_modulus"], value=[math.inf]))
        for _ in range(20000):
            if any("cell/set_parameters: refused" in text for text in said):
                break
            self.world.tick(self.needle())
        else:
            self.fail(f"nobody reports it; said: {set(said)}")
        self.assertEqual(self.predicted(), before)


if __name__ == "__main__":
    rospy.init_node("needle")
    rostest.rosrun("cell_microinjection", "change_cell", ChangeCellTest)
