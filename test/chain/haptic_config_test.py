#!/usr/bin/python3
"""Bridge and device come alive with every file of config/haptic."""

import os
import pathlib
import pty
import subprocess
import sys
import unittest

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
                content = yaml.safe_load(file.read_text())
                self.assertLessEqual(set(content), {"haptic_bridge", "haptic_device", "keyboard_hand", "force_watchdog"})
                bridge = yaml.safe_load((PACKAGE / "config/haptic_bridge.yaml").read_text())
                self.check_alive("haptic_bridge", merged(bridge, content.pop("haptic_bridge")))
                for node, parameters in content.items():
                    self.assertEqual(self.check_alive(node, parameters), 0)  # it has had its last words


if __name__ == "__main__":
    rospy.init_node("haptic_config")
    rostest.rosrun("cell_microinjection", "haptic_config", HapticConfigTest)
