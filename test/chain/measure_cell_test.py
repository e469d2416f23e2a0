#!/usr/bin/python3
"""A cell of unknown size is measured in the microscope's image and served: the felt force is that of the true cell."""

import os
import pathlib
import signal
import tempfile
import time
import unittest
import xmlrpc.client

import numpy as np
import rosgraph
import rospy
import rostest
import yaml
from cell_microinjection.msg import CellState, CellInImage, InjectionStatus, VisionState
from cell_microinjection.srv import MeasureCell
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Image
from tf2_msgs.msg import TFMessage

from specimen import transform

PATIENCE = 60  # s
PIXEL = 0.25e-6  # m
DIAMETER = 62e-6  # m, of the true cell
ORIGIN = np.array([695.5, 519.5])  # px, of the image, where the world's origin is seen
OFFSET = 2e-6  # m, of the cell from the holding pipette's axis
CLEAR, PRESSED = 60e-6, 0.5 * DIAMETER - 8e-6  # m, heights of the tip


class MeasureCellTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.seen, cls.height = {}, CLEAR
        cls.needle = rospy.Publisher("/needle/measured_cp", PoseStamped, queue_size=1)
        cls.injection = rospy.Publisher("/controller/injection_state", InjectionStatus, queue_size=5)
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        for topic, kind in (("/cell/predicted_cf", WrenchStamped), ("/truth/predicted_cf", WrenchStamped),
                            ("/cell/state", CellState), ("/vision/state", VisionState)):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.seen.update({topic: message}), queue_size=1)
        rospy.Subscriber("/vision/image_overlay", Image, lambda message: cls.seen.update(overlay=message),
                         queue_size=1, buff_size=1 << 24)
        rospy.Subscriber("/diagnostics", DiagnosticArray,
                         lambda message: cls.seen.update({status.name: status for status in message.status}))
        rospy.wait_for_service("/vision/measure_cell", PATIENCE)
        cls.measure = staticmethod(rospy.ServiceProxy("/vision/measure_cell", MeasureCell))
        cls.world = rospy.Timer(rospy.Duration(0.005), cls.publish)
        cls.addClassCleanup(cls.world.shutdown)

    @classmethod
    def publish(cls, _):
        pose = PoseStamped()
        pose.header.frame_id, pose.header.stamp = "world", rospy.Time.now()
        pose.pose.position.z, pose.pose.orientation.w = cls.height, 1
        cls.needle.publish(pose)
        holder = transform("holding_pipette", (-OFFSET, 0, -0.5 * DIAMETER))
        holder.transform.rotation.x, holder.transform.rotation.w = 1, 0  # its z points away from the cell
        cls.tf.publish(TFMessage([transform("cell", (0, 0, 0)), holder]))

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s")
            time.sleep(0.02)

    def drive(self, height):
        for place in np.linspace(self.height, height, 100):
            type(self).height = place
            time.sleep(0.01)

    def force(self, topic):
        """The force at rest, N along the needle: of ten messages, each of a pose from now on, whose stamp it has."""
        begin, forces = rospy.Time.now(), {}

        def steady():
            message = self.seen.get(topic)
            if message and message.header.stamp > begin:
                forces[message.header.stamp] = message.wrench.force.z
            last = list(forces.values())[-10:]
            return len(last) == 10 and last[-1] > 0 and max(last) - min(last) < 1e-3 * last[-1]
        self.until(steady, f"a steady force on {topic}")
        return list(forces.values())[-1]

    def found(self):
        state = self.seen.get("/vision/state")
        return state and state.cell.verdict == CellInImage.FOUND

    def measured(self, **request):
        answer = None

        def enough():
            nonlocal answer
            answer = self.measure(**{"serve": False, "scene": "", **request})
            return answer.images >= 10 or (answer.images > 0 and not answer.success)
        self.until(enough, "ten images of the cell")
        return answer

    def test_measured_and_served(self):
        state = None

        def both_found():  # there is no needle in an image that was begun while this node stood still
            nonlocal state
            state = self.seen.get("/vision/state")
            return (state and state.cell.verdict == CellInImage.FOUND
                    and state.injection_pipette.verdict == state.injection_pipette.FOUND)
        self.until(both_found, "cell and tip")
        tip = np.array([state.injection_pipette.x, state.injection_pipette.y])
        self.assertLess(np.hypot(*(tip - ORIGIN + [0, CLEAR / PIXEL])), 1)
        cell = state.cell
        self.assertLess(np.hypot(*(np.array([cell.x, cell.y]) - ORIGIN)), 0.5)
        scene = pathlib.Path(tempfile.mkdtemp()) / "measured.yaml"
        answer = self.measured(serve=True, scene=str(scene))
        self.assertTrue(answer.success, answer.message)
        self.assertAlmostEqual(answer.diameter, DIAMETER, delta=max(answer.diameter_interval, 3e-3 * DIAMETER))
        self.assertLess(answer.diameter_interval, 1e-2 * DIAMETER)
        self.assertTrue(np.isnan(answer.zona_thickness))
        self.assertAlmostEqual(answer.offset, OFFSET, delta=max(answer.offset_interval, 0.3e-6))
        self.assertLess(answer.offset_interval, 1e-6)
        self.assertIn("family homogeneous", answer.family)
        self.assertAlmostEqual(yaml.safe_load(scene.read_text())["cell"]["diameter"], answer.diameter, delta=1e-9)
        self.drive(PRESSED)
        felt, true = self.force("/cell/predicted_cf"), self.force("/truth/predicted_cf")
        self.assertAlmostEqual(felt / true, 1, delta=0.03)
        self.until(lambda: "overlay" in self.seen, "an overlay")
        self.drive(CLEAR)
        self.check_record()

    def check_record(self):
        folder = pathlib.Path(rospy.get_param("/image_recorder/output_dir"))
        self.until(self.injection.get_num_connections, "the recorder")
        for number, state in enumerate(("approach", "../approach"), 1):  # the second is no name of a file
            self.injection.publish(InjectionStatus(state=state))
            self.until(lambda: len(list(folder.glob("snapshot_*.png"))) == number, f"snapshot {number}")
        self.assertEqual([path.name for path in sorted(folder.glob("snapshot_*"))],
                         ["snapshot_000_approach.png", "snapshot_001_state.png"])
        rows = (folder / "overlay.avi.csv").read_text().splitlines()
        self.assertEqual(rows[0], "frame,stamp")
        stamps = [float(row.split(",")[1]) for row in rows[1:]]
        self.assertGreater(len(stamps), 10)
        self.assertTrue(all(before < after for before, after in zip(stamps, stamps[1:])))
        self.assertGreater((folder / "overlay.avi").stat().st_size, 1e4 * len(stamps))

    def test_an_impossible_scene_file_changes_nothing(self):
        self.until(lambda: self.found() and "/cell/state" in self.seen, "the cell")
        before = dict(zip(self.seen["/cell/state"].parameter_names, self.seen["/cell/state"].parameter_values))
        answer = self.measured(serve=True, scene="/proc/nowhere/scene.yaml")
        self.assertFalse(answer.success)
        self.assertIn("/proc/nowhere", answer.message)
        answered = rospy.Time.now()
        self.until(lambda: (self.seen["/cell/state"].header.stamp - answered).to_sec() > 0.2, "later states of the cell")
        self.assertEqual(before["diameter"], dict(zip(self.seen["/cell/state"].parameter_names,
                                                      self.seen["/cell/state"].parameter_values))["diameter"])

    def serving(self):
        """Level of the diagnostics; none before they have come."""
        status = self.seen.get("vision: served cell")
        return status and status.level

    def test_images_are_served_while_cell_simulator_hangs(self):
        self.until(self.found, "the cell")
        uri = rosgraph.Master("/needle").lookupNode("/cell_simulator")
        hung = xmlrpc.client.ServerProxy(uri).getPid("/needle")[2]
        os.kill(hung, signal.SIGSTOP)
        self.addCleanup(os.kill, hung, signal.SIGCONT)
        before = self.seen["/vision/state"].header.stamp
        answer = self.measured(serve=True)
        self.assertFalse(answer.success)
        self.assertIn("does not answer within", answer.message)
        after = self.seen["/vision/state"].header.stamp
        self.assertGreater((after - before).to_sec(), 0.5 * rospy.get_param("/vision/serve_timeout"))
        self.until(lambda: self.serving() == DiagnosticStatus.ERROR, "an error on diagnostics")
        self.assertIn("has not answered an earlier request", self.measured(serve=True).message)
        os.kill(hung, signal.SIGCONT)
        self.until(lambda: self.serving() == DiagnosticStatus.OK, "the end of the error")
        answer = self.measured(serve=True)
        self.assertTrue(answer.success, answer.message)


if __name__ == "__main__":
    rospy.init_node("needle")
    rostest.rosrun("cell_microinjection", "measure_cell", MeasureCellTest)
