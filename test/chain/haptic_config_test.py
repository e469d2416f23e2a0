#!/usr/bin/python3
"""Bridge and device come alive with every file of config/haptic, which has a launch file of its name."""

import os
import pathlib
import pty
import subprocess
import sys
import unittest

import roslaunch.config
import rosnode
import rospkg
import rospy
import rostest
import yaml

from case import case

NODES = pathlib.Path(sys.argv[0]).parent  # this program is found beside them
PACKAGE = pathlib.Path(rospkg.RosPack().get_path("cell_microinjection"))


def merged(base, more):
    """As rosparam does it: a map's keys one by one."""
    for key, value in more.items():
        base[key] = merged(base.get(key, {}), value) if isinstance(value, dict) else value
    return base


class HapticConfigTest(unittest.TestCase):
    def check_alive(self, node, parameters):
        """@returns the exit status that it ends with when it is asked to."""
        rospy.set_param(f"/{node}", parameters)
        master, ours = pty.openpty()  # the keyboard wants a terminal
        process = subprocess.Popen([NODES / node], stdin=ours, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        os.close(ours)
        try:
            for _ in range(600):
                if f"/{node}" in rosnode.get_node_names() or process.poll() is not None:
                    break
                rospy.rostime.wallsleep(0.1)
            self.assertIsNone(process.poll(), process.stdout.read() if process.poll() is not None else "")
            process.terminate()
            return process.wait(60)
        finally:
            process.kill()
            process.communicate()
            os.close(master)
            rospy.delete_param(f"/{node}")

    def test_every_file(self):
        files = sorted((PACKAGE / "config/haptic").glob("*.yaml"))
        self.assertGreaterEqual(len(files), 10)
        for file in files:
            with case(file.name):
                self.assertTrue((PACKAGE / "launch/haptic" / file.with_suffix(".launch").name).exists())
                content = yaml.safe_load(file.read_text())
                self.assertLessEqual(set(content), {"haptic_bridge", "haptic_device", "keyboard_hand", "force_watchdog"})
                bridge = yaml.safe_load((PACKAGE / "config/haptic_bridge.yaml").read_text())
                self.check_alive("haptic_bridge", merged(bridge, content.pop("haptic_bridge")))
                for node, parameters in content.items():
                    self.assertEqual(self.check_alive(node, parameters), 0)  # it has had its last words

    def parameters(self, **arguments):
        """Of session.launch, as roslaunch would set them."""
        words = [f"{key}:={value}" for key, value in arguments.items()]
        session = roslaunch.config.load_config_default([(str(PACKAGE / "launch/session.launch"), words)], None,
                                                       assign_machines=False)
        return {name: parameter.value for name, parameter in session.params.items()}

    def test_the_hand_may_feel_another_force_than_the_controller(self):
        for arguments, hand, controller in (({}, "predicted", "predicted"),
                                            ({"hand_force": "blend"}, "blend", "predicted"),
                                            ({"force_source": "measured"}, "measured", "measured")):
            with case(arguments):
                set_ = self.parameters(**arguments)
                self.assertEqual(set_["/haptic_bridge/force_source"], hand)
                self.assertEqual(set_["/injection_controller/force_source"], controller)

    def test_a_hand_that_may_fall_needs_its_operator(self):
        for haptic in ("dvrk", "external", "falcon", "force_dimension", "geomagic", "joy", "keyboard", "marker", "omni",
                       "spacenav"):
            self.assertIs(self.parameters(haptic=haptic)["/haptic_bridge/require_operator"], True, haptic)
        for haptic in ("external", "force_dimension", "dvrk", "falcon"):
            self.assertIs(self.parameters(haptic=haptic, require_operator="false")["/haptic_bridge/require_operator"],
                          False)

    def test_each_known_driver_has_its_own_topics(self):
        for haptic, device, force in (("force_dimension", "/Falcon00", "body/servo_cf"),
                                      ("dvrk", "/MTMR", "body/servo_cf"), ("falcon", "/falcon", "servo_cf")):
            with case(haptic):
                set_ = self.parameters(haptic=haptic)
                self.assertEqual((set_["/haptic_device/kind"], set_["/haptic_device/device"]), ("crtk", device))
                self.assertEqual(set_["/haptic_device/force"], force)
                self.assertEqual(set_["/force_watchdog/device"], device)
                self.assertEqual(set_.get("/force_watchdog/force", "servo_cf"), force)

    def test_arguments_of_a_known_driver(self):
        set_ = self.parameters(haptic="dvrk", device="/MTML", device_present="/pedal", position_type="transform")
        self.assertEqual((set_["/haptic_device/device"], set_["/force_watchdog/device"]), ("/MTML", "/MTML"))
        self.assertEqual(set_["/haptic_device/operator_present/topic"], "/pedal")
        self.assertEqual(set_["/haptic_device/clutch/topic"], "/console/clutch")
        self.assertEqual(set_["/haptic_device/position_type"], "transform")


if __name__ == "__main__":
    rospy.init_node("haptic_config")
    rostest.rosrun("cell_microinjection", "haptic_config", HapticConfigTest)
