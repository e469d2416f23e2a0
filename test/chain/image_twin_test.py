#!/usr/bin/python3
"""Without a force sensor, images of the gap move the served cell to where the true one is; its modulus stays."""

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from cell_microinjection.msg import CellEstimate, CellParameters, CellState, InjectAction, InjectGoal

from controlled_needle import PATIENCE, ControlledNeedle

RADIUS = 31e-6  # m, of both cells
HEIGHT = 1.2e-6  # m, of the true cell above where the session believes it
MODULUS = 17.9e3  # Pa, of both
GAP, DEPTH = 10e-6, 8e-6  # m
EXACT = 0.3e-6  # m, of the height that images show


class ImageTwinTest(ControlledNeedle):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.see("/cell/estimate", CellEstimate)
        cls.see("/true_cell/state", CellState)
        cls.client = actionlib.SimpleActionClient("/controller/inject", InjectAction)
        assert cls.client.wait_for_server(rospy.Duration(PATIENCE))

    def errors(self):
        """Relative, of the felt force where the true one is large, in the order of time."""
        felt, true = self.forces["/cell/predicted_cf"], self.forces["/true_cell/predicted_cf"]
        stamps = sorted(set(felt) & set(true))
        largest = max((true[stamp] for stamp in stamps), default=0)
        return [felt[stamp] / true[stamp] - 1 for stamp in stamps if true[stamp] > 0.3 * largest > 0]

    def true_height(self):
        state = self.seen.get("/true_cell/state")
        return state and dict(zip(state.parameter_names, state.parameter_values))["height"]

    def served_height(self):
        estimate = self.seen.get("/cell/estimate")
        return estimate.served_height if estimate else 0

    def test_the_image_moves_the_served_cell(self):
        changes = rospy.Publisher("/true_cell/set_parameters", CellParameters, queue_size=1, latch=True)
        changes.publish(CellParameters(name=["height"], value=[HEIGHT]))
        self.until(lambda: self.true_height() == HEIGHT, "the higher cell")
        # The gap shows it before the touch.
        self.move_to((0, 0, RADIUS + HEIGHT + GAP))
        self.until(lambda: abs(self.served_height() - HEIGHT) < EXACT, "the place of the cell")
        self.client.send_goal(InjectGoal(puncture=False, layers=1, depth=DEPTH, hold_time=0.5))
        self.assertTrue(self.client.wait_for_result(rospy.Duration(PATIENCE)))
        ended = rospy.Time.now()
        self.until(lambda: self.seen["/cell/estimate"].header.stamp > ended, "an estimate after the indentation")
        result, estimate = self.client.get_result(), self.seen["/cell/estimate"]
        self.assertEqual((self.client.get_state(), result.outcome, result.reason), (GoalStatus.SUCCEEDED, "indented", ""))
        self.assertAlmostEqual(estimate.served_height, HEIGHT, delta=EXACT)
        # An image does not show the modulus. With the true one, the force is read from the image.
        self.assertEqual((estimate.verdict, estimate.served_modulus), ("prior", MODULUS))
        self.assertIn("no valid force of the sensor", estimate.held)
        errors = self.errors()
        self.assertGreater(len(errors), 10)
        self.assertLess(max(map(abs, errors)), 0.1)


if __name__ == "__main__":
    rospy.init_node("operator")
    rostest.rosrun("cell_microinjection", "image_twin", ImageTwinTest)
