#!/usr/bin/python3
"""The force sensor has no reading of a force that it cannot trust, nor after an overload, and reads along and across
the pipette otherwise; it is tared and calibrated."""

import math
import pathlib
import unittest

import numpy as np
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, Vector3, WrenchStamped
from std_srvs.srv import Trigger

from cell_microinjection.msg import InjectionStatus, OperatingState
from cell_microinjection.srv import CalibrateForce, CalibrateForceRequest
from messages import force, pose, wrench
from participant import Participant


class TrustTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = Participant({"/needle/measured_cp": PoseStamped, "/cell/predicted_cf": WrenchStamped,
                                 "/controller/operating_state": OperatingState,
                                 "/controller/injection_state": InjectionStatus},
                                {"/force_sensor/measured_cf": WrenchStamped, "/force_sensor/raw_cf": WrenchStamped})

    def setUp(self):
        self.world.run(20, self.messages(wrench(0, 0, 0)))
        self.call(wrench(0, 0, 0), "reset", Trigger)
        self.world.run(20, self.messages(wrench(0, 0, 0)))

    def call(self, predicted, service, kind, *arguments):
        """Answer of one of its services, under a force."""
        return self.world.call("/force_sensor/" + service, kind, *arguments, messages=self.messages(predicted))

    def messages(self, predicted, tilt=0.0):
        needle = pose(0, 0, 25e-6)
        needle.pose.orientation.y, needle.pose.orientation.w = math.sin(tilt / 2), math.cos(tilt / 2)
        both = {"/needle/measured_cp": needle, "/cell/predicted_cf": predicted}
        return {topic: message for topic, message in both.items() if message is not None}

    def reading(self):
        return self.world.seen["/force_sensor/measured_cf"]

    def test_axes_turn_with_the_pipette(self):
        self.world.run(100, self.messages(wrench(0, 0, 100e-6), tilt=math.pi / 6))
        self.assertEqual(self.reading().header.frame_id, "needle_tip")
        axial, lateral = 100e-6 * math.cos(math.pi / 6), -100e-6 * math.sin(math.pi / 6)
        expected = [lateral + 0.02 * axial, 0, axial + 0.02 * lateral]  # with the cross-axis share of 2 %
        np.testing.assert_allclose(force(self.reading()), expected, atol=6 * 240e-9)

    def test_no_reading_of_what_it_cannot_trust(self):
        for bad in (None, wrench(0, 0, math.nan), wrench(0, 0, 1e-6, "camera")):
            self.world.run(100, self.messages(wrench(0, 0, 1e-6)))
            self.assertFalse(self.reading().header.stamp.is_zero())
            level, text = self.world.run_to_status("force_sensor: sensor", 300, self.messages(bad))
            self.assertTrue(self.reading().header.stamp.is_zero())
            self.assertNotEqual(level, 0)
            self.assertIn("no valid force", text)

    def test_in_contact_neither_tare_nor_gain_moves_the_force(self):
        """The force guard takes what is measured."""
        def led(state):
            return {**self.messages(wrench(0, 0, 10e-6)), "/controller/operating_state": OperatingState(state="ENABLED"),
                    "/controller/injection_state": InjectionStatus(state=state)}
        self.world.run(20, led("indent"))
        refused = self.world.call("/force_sensor/tare", Trigger, messages=led("indent"))
        self.assertFalse(refused.success)
        self.assertIn("led in contact", refused.message)
        request = CalibrateForceRequest(action=CalibrateForceRequest.CLEAR)
        self.assertFalse(self.world.call("/force_sensor/calibrate", CalibrateForce, request,
                                         messages=led("indent")).success)
        self.world.run(20, led("idle"))
        self.assertTrue(self.world.call("/force_sensor/tare", Trigger, messages=led("idle")).success)

    def mean(self, predicted, topic="/force_sensor/measured_cf", ticks=200):
        """(lateral, axial) under a force, averaged against the noise."""
        self.world.run(20, self.messages(predicted))
        total = np.zeros(3)
        for _ in range(ticks):
            self.world.tick(self.messages(predicted))
            total += force(self.world.seen[topic])
        return total[[0, 2]] / ticks

    def calibrate(self, predicted, action, known=(0.0, 0.0)):
        request = CalibrateForceRequest(action=action, force=Vector3(known[0], 0, known[1]))
        return self.call(predicted, "calibrate", CalibrateForce, request)

    def tare(self, predicted):
        self.world.run(20, self.messages(predicted))
        self.assertTrue(self.call(predicted, "tare", Trigger).success)
        self.world.run(600, self.messages(predicted))  # it averages over 0.5 s

    def test_tare_and_calibration(self):
        offset = wrench(30e-6, 0, 50e-6)  # something hangs on the sensor
        self.tare(offset)
        np.testing.assert_allclose(self.mean(offset), [0, 0], atol=100e-9)
        self.assertGreater(self.mean(offset, "/force_sensor/raw_cf")[1], 49e-6)  # raw stays raw
        for lateral, axial in ((100e-6, 0), (0, 100e-6)):
            loaded = wrench(30e-6 + lateral, 0, 50e-6 + axial)
            self.world.run(20, self.messages(loaded))
            self.assertTrue(self.calibrate(loaded, CalibrateForceRequest.ADD, (lateral, axial)).success)
            self.world.run(600, self.messages(loaded))
        answer = self.calibrate(offset, CalibrateForceRequest.SOLVE)
        self.assertTrue(answer.success, answer.message)
        np.testing.assert_allclose(np.reshape(answer.gain, (2, 2)), np.linalg.inv([[1, 0.02], [0.02, 1]]), atol=0.003)
        np.testing.assert_allclose(self.mean(wrench(110e-6, 0, 10e-6)), [80e-6, -40e-6], atol=300e-9)
        self.check_file(answer)
        self.assertEqual(self.calibrate(offset, CalibrateForceRequest.UNDO).gain, (1, 0, 0, 1))
        again = self.calibrate(offset, CalibrateForceRequest.SOLVE)
        self.assertEqual((again.gain, again.residual, again.points), (answer.gain, answer.residual, 2))
        self.assertFalse(self.calibrate(offset, 7).success)
        self.assertTrue(self.calibrate(offset, CalibrateForceRequest.CLEAR).success)
        self.tare(wrench(0, 0, 0))

    def test_an_average_is_reported_when_it_ends(self):
        """Not with the next of the reports that come once a second: the operator waits for it."""
        reports = []

        def receive(message):
            for status in message.status:
                outcome = next((v.value for v in status.values if v.key == "tare and calibration"), None)
                if status.name == "force_sensor: sensor" and outcome not in [text for _, text in reports[-1:]]:
                    reports.append((message.header.stamp.to_sec(), outcome))
        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, receive)
        self.addCleanup(subscriber.unregister)
        self.world.await_links()
        nothing = wrench(0, 0, 0)
        asked = self.world.now.to_sec()
        self.assertTrue(self.call(nothing, "tare", Trigger).success)
        began = self.world.now.to_sec()  # or earlier: the answer may be late
        for _ in range(3000):  # the reports come over another connection than the ticks
            self.world.run(1, self.messages(nothing))
            if reports and reports[-1][1].startswith("tared"):
                break
        (begin, averaging), (end, tared) = reports[-2:]
        self.assertEqual((averaging, tared[:5]), ("taring", "tared"))
        self.assertGreaterEqual(begin, asked)
        self.assertLess(begin, began + 0.02)
        self.assertAlmostEqual(end - begin, 0.5, delta=0.02)

    def check_file(self, answer):
        """A thread of the node's own writes it."""
        path = pathlib.Path(rospy.get_param("/force_sensor/file"))
        self.addCleanup(lambda: path.unlink(missing_ok=True))

        def has_gain():
            values = yaml.safe_load(path.read_text(encoding="utf-8")) if path.exists() else {}
            return values.get("points") == 2
        for _ in range(3000):
            if has_gain():
                break
            rospy.rostime.wallsleep(0.01)
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
        self.assertEqual((tuple(values["gain"]), values["residual"]), (answer.gain, answer.residual))
        np.testing.assert_allclose(values["tare"], [50e-6, 30e-6], atol=2e-6)  # with the cross-axis share of 2 %

    def test_calibrations_that_no_sensor_needs_are_refused(self):
        nothing = wrench(0, 0, 0)
        for known, why in (((0, 1e300), "the known axial force = 1e+300 N, allowed [-0.00049, 0.00049] N"),
                           ((1e-3, 0), "the known lateral force = 0.001 N, allowed [-0.0009, 0.0009] N"),
                           ((0, math.nan), "the known force is not finite"), ((0, 0), "the known force is zero")):
            answer = self.calibrate(nothing, CalibrateForceRequest.ADD, known)
            self.assertFalse(answer.success)
            self.assertIn(why, answer.message)
        # A force is announced that is not there.
        self.assertTrue(self.calibrate(nothing, CalibrateForceRequest.ADD, (0, 400e-6)).success)
        self.world.run(600, self.messages(nothing))
        answer = self.calibrate(nothing, CalibrateForceRequest.SOLVE)
        self.assertFalse(answer.success)
        self.assertIn("the gain that fits the points changes forces by factors", answer.message)
        self.assertEqual(list(answer.gain), [1, 0, 0, 1])
        self.assertTrue(self.calibrate(nothing, CalibrateForceRequest.CLEAR).success)

    def test_an_overload_is_a_fault_until_reset(self):
        self.world.run(20, self.messages(wrench(0, 0, 1e-3)))  # beyond the range, not yet the overload
        self.assertFalse(self.reading().header.stamp.is_zero())
        self.world.run(20, self.messages(wrench(0, 0, 3e-3)))
        self.assertTrue(self.reading().header.stamp.is_zero())
        status = self.world.run_to_status("force_sensor: sensor", 300, self.messages(wrench(0, 0, 0)))
        self.assertTrue(self.reading().header.stamp.is_zero())
        self.assertEqual(status, (2, "overloaded; call the service ~reset"))
        self.assertFalse(self.call(wrench(0, 0, 0), "tare", Trigger).success)
        self.assertTrue(self.call(wrench(0, 0, 0), "reset", Trigger).success)
        self.world.run(20, self.messages(wrench(0, 0, 0)))
        self.assertFalse(self.reading().header.stamp.is_zero())


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "trust_force_sensor", TrustTest)
