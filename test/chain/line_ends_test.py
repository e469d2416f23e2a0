#!/usr/bin/python3
"""Line protocols that came through roslaunch's parameter server: line ends that are names arrive, characters are
refused, and without a command's number that its maker has not published there is no injector. The devices' lines are
pseudo-terminals."""

import os
import pathlib
import pty
import select
import subprocess
import sys
import time
import tty
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped

from cell_microinjection.msg import InjectionPulse, InjectorState

NODES = pathlib.Path(sys.argv[0]).parent  # this program is found beside them
PATIENCE = 60  # s of wall time; only what hangs takes that long


class Line:
    """A pseudo-terminal whose other end a node opens, byte by byte as it is sent."""

    def __init__(self):
        self.ours, theirs = pty.openpty()
        tty.setraw(theirs)
        self.path = os.ttyname(theirs)
        self._theirs = theirs  # so that the node's closing is no hang-up

    def read_until(self, condition):
        heard = b""
        end = time.monotonic() + PATIENCE
        while not condition(heard) and time.monotonic() < end:
            if select.select([self.ours], [], [], 0.1)[0]:
                heard += os.read(self.ours, 4096)
        return heard

    def close(self):
        os.close(self.ours)
        os.close(self._theirs)


class LineEndsTest(unittest.TestCase):
    def start(self, node, name, parameters):
        if rospy.has_param("/" + name):
            rospy.delete_param("/" + name)
        for key, value in parameters.items():
            rospy.set_param(f"/{name}/{key}", value)
        return subprocess.Popen([str(NODES / node), f"__name:={name}"], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def check_refused(self, node, parameters, words):
        process = self.start(node, f"refused_{node}", parameters)
        try:
            output, _ = process.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            self.fail(f"{node} came alive with {parameters}")
        self.assertEqual(process.returncode, 1, output)
        for word in words:
            self.assertIn(word, output)

    def test_characters_are_refused_by_name(self):
        self.assertEqual(rospy.get_param("/raw/injector/serial/terminator"), "\n", "the server keeps \\r\\n now")
        self.check_refused("injector", rospy.get_param("/raw/injector"),
                           ["serial/terminator", "must be one of the names CR, LF, CRLF", "serial/pulse/0/send",
                            "has a line feed (0x0A)"])
        self.check_refused("force_sensor", rospy.get_param("/raw/force_sensor"),
                           ["serial/terminator", "must be one of the names CR, LF, CRLF", "serial/separator",
                            "has a tabulator (0x09)"])

    def test_an_injector_sends_the_line_end_that_was_named(self):
        line = Line()
        parameters = rospy.get_param("/named/injector")
        parameters["serial"].update(path=line.path, balance=[{"send": "C{pressure_Pa}", "expect": "OK"}])
        process = self.start("injector", "named_injector", parameters)
        try:
            # Nobody answers: when this test stands still, the injector sends it again.
            self.assertEqual(line.read_until(lambda heard: len(heard) >= 5)[:5], b"C545\r")
        finally:
            process.terminate()
            process.communicate()
            line.close()

    def test_a_force_sensor_hears_the_line_end_that_was_named(self):
        """Of a line that ends with CR LF the last column would have a carriage return behind it, and be no number."""
        line = Line()
        parameters = rospy.get_param("/named/force_sensor")
        parameters["serial"]["path"] = line.path
        frames = subprocess.Popen(["rosrun", "tf2_ros", "static_transform_publisher", *"0 0 0.04 0 0 0".split(),
                                   "needle_tip", "force_sensor"], stdout=subprocess.DEVNULL)
        process = self.start("force_sensor", "named_force_sensor", parameters)
        try:
            heard = []
            subscriber = rospy.Subscriber("/force_sensor/raw_cf", WrenchStamped, heard.append)
            end = time.monotonic() + PATIENCE
            while not any(abs(wrench.wrench.force.z - 1e-4) < 1e-9 for wrench in heard) and time.monotonic() < end:
                os.write(line.ours, b"1.0000\t0.5000\r\n")
                time.sleep(0.01)
            self.assertTrue(any(abs(wrench.wrench.force.z - 1e-4) < 1e-9 for wrench in heard), f"{len(heard)} readings")
            subscriber.unregister()
        finally:
            for each in (process, frames):
                each.terminate()
                each.communicate()
            line.close()

    def test_a_femtojet_injects_once(self):
        """With the patterns of its file as the parameter server keeps them, and an emulated device."""
        parameters = {"source": "serial", "emulated": "femtojet", **rospy.get_param("/femtojet")}
        parameters["serial"]["codes"]["inject"] = "901"
        process = self.start("injector", "emulated_femtojet", parameters)
        try:
            states = []
            subscriber = rospy.Subscriber("/injector/state", InjectorState, states.append)
            publisher = rospy.Publisher("/injector/pulse", InjectionPulse, queue_size=1)
            end = time.monotonic() + PATIENCE
            while not (states and states[-1].last_id == 5) and time.monotonic() < end:
                # Again and again: one that comes late is refused as stale, and one that was obeyed is known.
                pulse = InjectionPulse(id=5, pressure=20e3, duration=0.5)
                pulse.header.stamp = rospy.Time.now()
                if states and not states[-1].fault:
                    publisher.publish(pulse)
                time.sleep(0.1)
            self.assertTrue(states, "no state of the injector")
            self.assertEqual((states[-1].last_id, states[-1].pulses, states[-1].fault), (5, 1, ""))
            subscriber.unregister()
        finally:
            process.terminate()
            process.communicate()

    def test_a_femtojet_needs_the_number_that_is_not_published(self):
        parameters = {"source": "serial", **rospy.get_param("/femtojet")}
        self.check_refused("injector", parameters, ["serial/codes/inject = ", "must be 3 letters or digits"])
        parameters["serial"]["codes"]["inject"] = 10  # what YAML makes of 012 without quotes
        self.check_refused("injector", parameters, ["serial/codes/inject = 10: must be 3 letters or digits"])
        parameters["serial"]["codes"]["inject"] = "901"
        self.check_refused("injector", {**parameters, "pressure_range": [0.0, 1e5], "balance": 40.0},
                           ["balance = 40", "the digits of the device's line make it 0 Pa"])
        del parameters["serial"]["codes"]["inject"]
        self.check_refused("injector", parameters, ["codes/inject is missing"])


if __name__ == "__main__":
    rospy.init_node("line_ends")
    rostest.rosrun("cell_microinjection", "line_ends", LineEndsTest)
