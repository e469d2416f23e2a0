#!/usr/bin/python3
"""Microscope, vision and cell_simulator as processes: images of the cell are measured on while cell_simulator hangs in a
request of vision. What is measured is in test/nodes/imaging."""

import os
import signal
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from cell_microinjection.msg import CellInImage, VisionState
from cell_microinjection.srv import MeasureCell
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from tf2_msgs.msg import TFMessage

from live_chain import until
from messages import pose, transform

PATIENCE = 60  # s
DIAMETER = 62e-6  # m, of the true cell
OFFSET = 2e-6  # m, of the cell from the holding pipette's axis
CLEAR = 60e-6  # m, height of the tip
IMAGES = 3  # of a measurement


class ImagesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.state, cls.serving = None, None
        cls.needle = rospy.Publisher("/needle/measured_cp", PoseStamped, queue_size=1)
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        rospy.Subscriber("/vision/state", VisionState, lambda message: setattr(cls, "state", message), queue_size=1)
        rospy.Subscriber("/diagnostics", DiagnosticArray, cls.on_diagnostics)
        rospy.wait_for_service("/vision/measure_cell", PATIENCE)
        rospy.wait_for_service("/cell_simulator/set_cell_parameters", PATIENCE)
        cls.measure = staticmethod(rospy.ServiceProxy("/vision/measure_cell", MeasureCell))
        cls.world = rospy.Timer(rospy.Duration(0.005), cls.publish)
        cls.addClassCleanup(cls.world.shutdown)

    @classmethod
    def publish(cls, _):
        needle = pose(0, 0, CLEAR)
        needle.header.stamp = rospy.Time.now()
        cls.needle.publish(needle)
        cell, holder = transform(0, 0, 0), transform(-OFFSET, 0, -0.5 * DIAMETER)
        cell.child_frame_id, holder.child_frame_id = "cell", "holding_pipette"
        holder.transform.rotation.x, holder.transform.rotation.w = 1, 0  # its z points away from the cell
        cell.header.stamp = holder.header.stamp = needle.header.stamp
        cls.tf.publish(TFMessage([cell, holder]))

    @classmethod
    def on_diagnostics(cls, message):
        for status in message.status:
            if status.name == "vision: served cell":
                cls.serving = status.level

    def found(self):
        return self.state and self.state.cell.verdict == CellInImage.FOUND

    def measured(self):
        """The answer to a request that the cell be measured and served."""
        answer = None

        def enough():
            nonlocal answer
            answer = self.measure(serve=True, scene="")
            return answer.images >= IMAGES or (answer.images > 0 and not answer.success)
        until(enough, f"{IMAGES} images of the cell")
        return answer

    def test_images_are_served_while_cell_simulator_hangs(self):
        until(self.found, "the cell")
        uri = rosgraph.Master("/needle").lookupNode("/cell_simulator")
        hung = xmlrpc.client.ServerProxy(uri).getPid("/needle")[2]
        os.kill(hung, signal.SIGSTOP)
        self.addCleanup(os.kill, hung, signal.SIGCONT)
        before = self.state.header.stamp
        answer = self.measured()
        self.assertFalse(answer.success)
        self.assertIn("does not answer within", answer.message)
        # It waited for that long, and measured images meanwhile.
        self.assertGreater((self.state.header.stamp - before).to_sec(), 0.5 * rospy.get_param("/vision/serve_timeout"))
        until(lambda: self.serving == DiagnosticStatus.ERROR, "an error on diagnostics")
        self.assertIn("has not answered an earlier request", self.measured().message)
        os.kill(hung, signal.SIGCONT)
        until(lambda: self.serving == DiagnosticStatus.OK, "the end of the error")
        answer = self.measured()
        self.assertTrue(answer.success, answer.message)


if __name__ == "__main__":
    rospy.init_node("needle")
    rostest.rosrun("cell_microinjection", "images", ImagesTest)
