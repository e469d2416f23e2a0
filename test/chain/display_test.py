#!/usr/bin/python3
"""A tilted needle is shown where it is, at x 1e4, with the force on it in its own direction; the cell as it is asked for."""

import time
import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import CellState, DisplayView
from geometry_msgs.msg import Point, Point32, PointStamped, TransformStamped, WrenchStamped
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

PATIENCE = 30  # s
SCALE = 1e4
YOUNG, STRETCH = 10e3, 1.1  # Pa; 1
TIP, TILT = np.array([5e-6, -3e-6, 40e-6]), 0.4  # m; rad about y
AXIS = np.array([np.sin(TILT), 0, np.cos(TILT)])  # of the pipette, `world`


def transform(child, position=(0, 0, 0), tilt=0.0):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = "world", rospy.Time.now()
    t, q = message.transform.translation, message.transform.rotation
    t.x, t.y, t.z = position
    q.y, q.w = np.sin(tilt / 2), np.cos(tilt / 2)
    return message


def stretched(stretch):
    """A cell, an octahedron of 28 um, that is that much larger than at rest: a shell of it is without pressure."""
    state = CellState()
    state.header.frame_id, state.header.stamp = "cell", rospy.Time.now()
    corners = 28e-6 * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    state.rest_vertices = [Point32(*corner) for corner in corners]
    state.vertices = [Point32(*corner) for corner in stretch * corners]
    state.triangles = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5]
    state.displacement = [(stretch - 1) * 28e-6] * 6
    state.parameter_names, state.parameter_values = ["young_modulus", "poisson_ratio"], [YOUNG, 0.49]
    state.material, state.layer_radii, state.converged = "neo_hookean", [28e-6, 24e-6], True
    return state


class DisplayTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.frames, cls.markers, cls.texts, cls.view = {}, {}, {}, None
        cls.cell = rospy.Publisher("/cell/state", CellState, queue_size=1)
        cls.set_view = rospy.Publisher("/viz/set_view", DisplayView, queue_size=1)
        rospy.Subscriber("/viz/view", DisplayView, cls.on_view)
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        cls.force = rospy.Publisher("/force_sensor/measured_cf", WrenchStamped, queue_size=1)
        rospy.Subscriber("/tf", TFMessage, cls.on_frames)
        for topic in ("/viz/markers", "/viz/still"):
            rospy.Subscriber(topic, MarkerArray, cls.on_markers)

    @classmethod
    def on_frames(cls, message):
        cls.frames.update({t.child_frame_id: t for t in message.transforms})

    @classmethod
    def on_markers(cls, message):
        cls.markers.update({marker.ns: marker for marker in message.markers})
        cls.texts.update({(marker.ns, marker.id): marker.text for marker in message.markers})
        cls.markers.update({f"{marker.ns} {marker.id}": marker for marker in message.markers})

    @classmethod
    def on_view(cls, message):
        cls.view = message

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            self.tf.publish(TFMessage([transform("needle_tip", TIP, TILT), transform("holding_pipette"), transform("cell")]))
            force = WrenchStamped()
            force.header.frame_id, force.header.stamp = "needle_tip", rospy.Time.now()
            force.wrench.force.z = 2e-6
            self.force.publish(force)
            time.sleep(0.05)

    def test_needle(self):
        self.until(lambda: "viz/needle_tip" in self.frames, "the needle's frame")
        shown = self.frames["viz/needle_tip"]
        self.assertEqual(shown.header.frame_id, "viz/world")
        t, q = shown.transform.translation, shown.transform.rotation
        np.testing.assert_allclose([t.x, t.y, t.z], SCALE * TIP, atol=1e-9)
        np.testing.assert_allclose([q.x, q.y, q.z, q.w], [0, np.sin(TILT / 2), 0, np.cos(TILT / 2)], atol=1e-9)
        self.until(lambda: "injection_pipette" in self.markers, "the pipette")
        pipette = self.markers["injection_pipette"]
        self.assertEqual(pipette.header.frame_id, "viz/needle_tip")
        heights = np.array([point.z for point in pipette.points])
        self.assertAlmostEqual(heights.min(), 0, delta=0.1)  # it reaches from the tip out of the cell
        self.assertGreater(heights.max(), 1)

    def is_drawn(self, marker):
        return marker in self.markers and self.markers[marker].action == Marker.ADD

    def show(self, view, title):
        """Publishes a cell until the legend has this title."""
        def shown():
            self.cell.publish(stretched(STRETCH))
            self.set_view.publish(view)
            return title in self.texts.values()
        self.until(shown, f"the legend of {title}")
        self.until(lambda: self.view is not None and self.view.section == view.section and
                   self.view.colour == view.colour, "the view")

    def test_colour_is_that_of_the_stress(self):
        self.show(DisplayView(colour="von_mises_stress"), "von Mises stress")
        figures = [float(self.texts["legend_labels", i]) for i in range(5)]
        # A sheet stretched by a in both directions, nearly incompressible: mu (a^2 - 1/a^4).
        stress = YOUNG / 3 * (STRETCH**2 - STRETCH**-4) / 1e3
        self.assertEqual(figures[0], 0)
        self.assertGreater(figures[4], 0.97 * stress)
        self.assertLess(figures[4], 1.5 * stress)
        self.assertEqual(self.view.colour, "von_mises_stress")
        self.show(DisplayView(colour="pressure"), "pressure")
        self.assertLess(float(self.texts["legend_labels", 0]), 0)
        # What there is not changes nothing.
        self.set_view.publish(DisplayView(colour="temperature"))
        self.show(DisplayView(colour="displacement"), "displacement")

    def test_the_scale_begins_anew_with_another_cell(self):
        """It grows while the cell is the same, so that a colour keeps its meaning."""
        self.show(DisplayView(colour="displacement"), "displacement")

        def shows(cell, end):
            def shown():
                self.cell.publish(cell)
                return float(self.texts.get(("legend_labels", 4), "nan")) == end
            self.until(shown, f"a scale that ends at {end} um")
        shows(stretched(STRETCH), 3.2)
        less = stretched(1.05)
        for _ in range(20):
            self.cell.publish(less)
            time.sleep(0.05)
        shows(less, 3.2)
        less.parameter_values = [2 * YOUNG, 0.49]
        shows(less, 1.6)

    def test_cut(self):
        self.show(DisplayView(colour="displacement", section=True), "displacement")
        self.until(lambda: self.is_drawn("section 1"), "the cut face of the second layer")
        outer, inner = (np.array([[p.x, p.y, p.z] for p in self.markers[f"section {i}"].points]) for i in (0, 1))
        self.assertAlmostEqual(abs(outer).max(), SCALE * STRETCH * 28e-6, delta=0.06)
        self.assertLess(abs(inner).max(), abs(outer).max() - 0.01)  # a border of a facetted cell
        tilted = np.array([TIP[0], TIP[1], TIP[2]])
        for point in outer:  # in the plane through the tip that contains the pipette's axis and faces the viewer
            self.assertAlmostEqual(point[1], SCALE * tilted[1], delta=0.01)
        self.show(DisplayView(colour="displacement"), "displacement")
        self.until(lambda: not self.is_drawn("section 0"), "the whole cell")

    def test_a_proposed_place_is_a_cross_until_it_is_forgotten(self):
        places = rospy.Publisher("/visual_servo/proposed_point", PointStamped, queue_size=1)
        place = PointStamped()
        place.header.frame_id = "world"

        def cross(stamp):
            place.header.stamp = stamp
            place.point = Point(*TIP)
            places.publish(place)
            return self.is_drawn("proposed_place")
        self.until(lambda: cross(rospy.Time.now()), "a cross")
        marker = self.markers["proposed_place"]
        self.assertEqual(marker.header.frame_id, "viz/world")
        np.testing.assert_allclose(np.mean([[p.x, p.y, p.z] for p in marker.points], axis=0), SCALE * TIP, atol=1e-9)
        self.until(lambda: not cross(rospy.Time()), "no cross")

    def arrow(self):
        """One of a force that came when the needle's frame was known: before, it counts as along the world's axes."""
        begin = time.monotonic()
        self.until(lambda: time.monotonic() > begin + 1 and "measured_force" in self.markers, "the force's arrow")
        self.assertEqual(self.markers["measured_force"].action, Marker.ADD)
        return self.markers["measured_force"]

    def test_force(self):
        self.until(lambda: "viz/needle_tip" in self.frames, "the needle's frame")
        arrow = self.arrow()
        self.assertEqual(arrow.header.frame_id, "viz/world")
        tail, head = (np.array([point.x, point.y, point.z]) for point in arrow.points)
        np.testing.assert_allclose((head - tail) / np.linalg.norm(head - tail), AXIS, atol=1e-6)
        beside = tail - SCALE * TIP
        self.assertAlmostEqual(beside @ AXIS, SCALE * 20e-6, delta=1e-6)
        self.assertAlmostEqual(np.linalg.norm(beside - (beside @ AXIS) * AXIS), SCALE * 16e-6, delta=1e-6)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "display", DisplayTest)
