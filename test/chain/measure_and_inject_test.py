#!/usr/bin/python3
"""A cell of unknown size and place is measured in the image, served, and injected: the felt force is the true cell's."""

import csv
import pathlib
import sys

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from cell_microinjection.msg import (CellEstimate, CellInImage, CellState, CellParameters, InjectAction, InjectGoal,
                                     PunctureScore)
from cell_microinjection.srv import MeasureCell

from controlled_needle import PATIENCE, ControlledNeedle

PIXEL = 0.25e-6  # m
DIAMETER, BESIDE = 62e-6, 6e-6  # m, of the true cell; from the needle's axis
PUNCTURE = 1.5e-6  # N, of its zona
TWIN = "true" in sys.argv[1:]
TRUE_MODULUS = 30e3  # Pa, with the twin; the session believes in 17.9e3


class MeasureAndInjectTest(ControlledNeedle):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.see("/cell/estimate", CellEstimate)
        cls.see("/true_cell/state", CellState)
        cls.see("/cell/puncture_score", PunctureScore)
        cls.client = actionlib.SimpleActionClient("/controller/inject", InjectAction)
        assert cls.client.wait_for_server(rospy.Duration(PATIENCE))
        rospy.wait_for_service("/vision/measure_cell", PATIENCE)
        cls.measure = staticmethod(rospy.ServiceProxy("/vision/measure_cell", MeasureCell))

    def image(self):
        """Of the needle at rest: both are found in it."""
        since = rospy.Time.now()

        state = None

        def found():
            nonlocal state
            state = self.seen.get("/vision/state")
            return (state and state.header.stamp > since and state.cell.verdict == CellInImage.FOUND
                    and state.injection_pipette.verdict == state.injection_pipette.FOUND)
        self.until(found, "cell and tip")
        return state

    def measured(self):
        answer = None

        def enough():
            nonlocal answer
            answer = self.measure(serve=True, scene="")
            return answer.images >= 10 and answer.success
        self.until(enough, "ten images of the cell")
        return answer

    def test_measured_served_and_injected(self):
        self.until(lambda: {"/needle/measured_cp", "/needle/operating_state"} <= set(self.seen), "the rig")
        self.move_to(self.needle() + [BESIDE, 0, 0])
        # Place: by what the image shows, without knowing where the cell is.
        state = self.image()
        beside = PIXEL * (state.injection_pipette.x - state.cell.x)
        self.move_to(self.needle() - [beside, 0, 0])
        self.assertAlmostEqual(self.needle()[0], 0, delta=0.3e-6)
        # Size: measured and served.
        answer = self.measured()
        self.assertAlmostEqual(answer.diameter, DIAMETER, delta=3e-3 * DIAMETER)
        if TWIN:
            self.learn()
        for forces in self.forces.values():
            forces.clear()
        result = self.run_goal("injected", puncture=True, layers=1, depth=25e-6, margin=2e-6, pressure=20e3, duration=0.3)
        self.assertGreater(result.volume, 0)
        self.check_forces()
        if TWIN:
            self.check_score(result)
        self.check_notebook(result)

    def run_goal(self, outcome, **goal):
        self.client.send_goal(InjectGoal(**goal))
        self.assertTrue(self.client.wait_for_result(rospy.Duration(PATIENCE)))
        result = self.client.get_result()
        self.assertEqual((self.client.get_state(), result.outcome, result.reason), (GoalStatus.SUCCEEDED, outcome, ""))
        return result

    def learn(self):
        """A touch of 6 um, for half a second."""
        changes = rospy.Publisher("/true_cell/set_parameters", CellParameters, queue_size=1, latch=True)
        changes.publish(CellParameters(name=["young_modulus"], value=[TRUE_MODULUS]))
        self.until(lambda: self.true_modulus() == TRUE_MODULUS, "the stiffer cell")
        self.run_goal("indented", puncture=False, layers=1, depth=6e-6, hold_time=0.5)
        ended = rospy.Time.now()
        self.until(lambda: self.seen["/cell/estimate"].header.stamp > ended, "an estimate after the touch")
        self.assertAlmostEqual(self.seen["/cell/estimate"].served_modulus / TRUE_MODULUS, 1, delta=0.03)

    def true_modulus(self):
        state = self.seen.get("/true_cell/state")
        return state and dict(zip(state.parameter_names, state.parameter_values))["young_modulus"]

    def check_score(self, result):
        self.until(lambda: "/cell/puncture_score" in self.seen, "the score")
        score = self.seen["/cell/puncture_score"]
        self.assertAlmostEqual(score.force / result.puncture_force, 1, delta=0.1)
        self.assertLess(score.predicted.force_low, score.force)
        self.assertLess(score.force, score.predicted.force_high)
        self.assertAlmostEqual(score.predicted.depth / score.depth, 1, delta=0.2)

    def check_notebook(self, result):
        """A row for each cell that was touched; here twice the same one."""
        path = pathlib.Path(rospy.get_param("/notebook/file"))
        self.until(lambda: path.is_file() and len(path.read_text().splitlines()) == 2 + TWIN, "the notebook")
        *touch, row = csv.DictReader(path.read_text().splitlines())
        self.assertEqual([row["outcome"] for row in touch], ["indented"] * TWIN)
        self.assertEqual((row["outcome"], row["punctures"], row["cell"]), ("injected", "1", "mouse_oocyte_injection"))
        self.assertAlmostEqual(float(row["diameter_m"]), DIAMETER, delta=3e-3 * DIAMETER)
        self.assertAlmostEqual(float(row["volume_m3"]) / result.volume, 1, delta=0.1)
        if TWIN:
            self.assertAlmostEqual(float(touch[0]["modulus_Pa"]) / TRUE_MODULUS, 1, delta=0.03)
            self.assertAlmostEqual(float(row["puncture_force_N"]) / result.puncture_force, 1, delta=0.1)
            self.assertGreater(float(row["expected_force_high_N"]), float(row["puncture_force_N"]))

    def check_forces(self):
        """Up to the puncture, within 3 %."""
        felt, true = self.forces["/cell/predicted_cf"], self.forces["/true_cell/predicted_cf"]
        stamps = sorted(set(felt) & set(true))
        pairs = np.array([(felt[stamp], true[stamp]) for stamp in stamps])
        # The membrane fails behind the largest force: on a machine that stalls nothing may be heard of the last 2 %.
        pairs = pairs[:int(np.argmax(pairs[:, 1])) + 1]
        pairs = pairs[(pairs[:, 1] > 0.2 * PUNCTURE) & (pairs[:, 1] < 0.98 * PUNCTURE)]
        self.assertGreater(len(pairs), 10)
        np.testing.assert_allclose(pairs[:, 0] / pairs[:, 1], 1, atol=0.03)


if __name__ == "__main__":
    rospy.init_node("operator")
    rostest.rosrun("cell_microinjection", "measure_and_inject", MeasureAndInjectTest)
