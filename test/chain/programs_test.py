#!/usr/bin/python3
"""Each program of a node: with good parameters it comes alive and ends with status 0 when it is asked to; with a key that it
does not know it ends with status 1 and says why. Which values a node refuses is in
test/nodes/session/node_parameters_test.cpp."""

import concurrent.futures
import os
import pty
import subprocess
import tempfile
import unittest

import rosnode
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray

from case import case
from killable_nodes import PACKAGE, PATIENCE, PROGRAMS
from live_chain import until

CELL = {"scene": PACKAGE / "config/cells/mouse_oocyte_pipette.yaml", "families": PACKAGE / "config/families"}
FOLDER = tempfile.TemporaryDirectory()
GOOD = {  # what each node cannot do without
    "calibration": {}, "camera": {"source": "folder", "path": FOLDER.name}, "cell_estimator": CELL, "cell_simulator": CELL,
    "display": {}, "focus": {}, "force_sensor": {}, "force_watchdog": {}, "haptic_bridge": {}, "haptic_device": {"kind": "joy"},
    "holder": {},
    "image_recorder": {"output_dir": f"{FOLDER.name}/images"}, "injection_controller": {}, "injector": {}, "keyboard_hand": {},
    "link_emulator": {}, "micromanipulator": {}, "microscope": {}, "notebook": {"file": f"{FOLDER.name}/notebook.csv"},
    "virtual_hand": {"motion": PACKAGE / "config/hand_motions/indent_and_retract.yaml"},
    "readiness": {}, "session_recorder": {"output_dir": f"{FOLDER.name}/record"}, "teleoperation_follower": {}, "touch": {}, "vision": {},
    "visual_servo": {}}
SILENT = {"force_watchdog"}  # has no diagnostics
AT_A_TIME = 2


class Program:
    """A node that is started with these parameters, under a name of its own, with a terminal unless `terminal` is false."""

    def __init__(self, node, name, parameters, terminal=True):
        self.name = name
        arguments = [f"_{key}:={value}" for key, value in parameters.items()]
        self._terminal, theirs = pty.openpty()
        self._process = subprocess.Popen(
            [PROGRAMS / node, *arguments, f"__name:={name}"], stdin=theirs if terminal else subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env={**os.environ, "XDG_CACHE_HOME": FOLDER.name})
        os.close(theirs)

    def ended(self):
        return self._process.poll() is not None

    def end(self):
        """@returns (exit status, what it said) after SIGTERM."""
        self._process.terminate()
        return self.result()

    def result(self):
        """@returns (exit status, what it said); status None when it goes on."""
        try:
            said, _ = self._process.communicate(timeout=PATIENCE)
            status = self._process.returncode
        except subprocess.TimeoutExpired:
            self._process.kill()
            said, _ = self._process.communicate()
            status = None
        os.close(self._terminal)
        return status, said


class ProgramsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # The force sensor waits for it in its constructor.
        cls.frame = subprocess.Popen(
            ["rosrun", "tf2_ros", "static_transform_publisher", *"0 0 0.04 0 0 0 needle_tip force_sensor".split()],
            stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.frame.terminate()
        cls.frame.wait()
        FOLDER.cleanup()

    def for_each(self, check):
        """Of all nodes, a few at a time."""
        def named(node):
            with case(node):
                check(node)
        with concurrent.futures.ThreadPoolExecutor(AT_A_TIME) as pool:
            for result in [pool.submit(named, node) for node in GOOD]:
                result.result()

    def check_refused(self, node, name, parameters, words, **terminal):
        status, said = Program(node, name, parameters, **terminal).result()
        self.assertEqual(status, 1, said)
        for word in words:
            self.assertIn(word, said)
        self.assertNotIn(f"/{name}", rosnode.get_node_names())

    def test_these_are_all(self):
        """A node without a line above would be started by no test."""
        sources = (PACKAGE / "test/chain/programs.txt").read_text().split()  # of src/nodes/programs
        self.assertEqual({name.partition(".")[0] for name in sources}, {*GOOD, "simulate"})

    def test_an_unknown_key_is_refused(self):
        self.for_each(lambda node: self.check_refused(node, f"refused_{node}", {**GOOD[node], "forse_limit": 3},
                                                      ["forse_limit", "unknown key"]))

    def test_a_second_one_of_a_name_is_refused_and_the_first_goes_on(self):
        first = Program("display", "twice", {})
        until(lambda: first.ended() or "/twice" in rosnode.get_node_names(), "a node that the master knows")
        status, said = Program("display", "twice", {}).result()
        self.assertEqual(status, 1, said)
        self.assertIn("a node of this name runs already", said)
        self.assertFalse(first.ended(), "the first one was ended")
        self.assertEqual(first.end()[0], 0)

    def test_a_clock_that_was_left_on_is_refused(self):
        rospy.set_param("/use_sim_time", True)
        self.addCleanup(rospy.set_param, "/use_sim_time", False)
        self.check_refused("display", "without_time", {}, ["/use_sim_time is true", "rosparam set /use_sim_time false"])

    def test_a_relative_path_is_refused(self):
        self.check_refused("image_recorder", "without_folder", {"output_dir": "today"},
                           ["output_dir = today: must be an absolute path"])

    def test_keys_need_a_terminal(self):
        self.check_refused("keyboard_hand", "refused_without_terminal", {}, ["needs a terminal"], terminal=False)

    def test_good_ones_come_alive_and_end_in_good_order(self):
        """Without this the tests above would pass for a node that never starts."""
        alive = set()  # names in diagnostics
        # Not before: a node that ends at once leaves rospy a connection for good, and another one that gets its port later
        # passes for connected.
        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: alive.update(
            status.name.partition(":")[0] for status in message.status))
        self.addCleanup(subscriber.unregister)

        def check(node):
            name = f"good_{node}"
            program = Program(node, name, {**GOOD[node], "diagnostic_period": 0.1})

            def known():
                return f"/{name}" in rosnode.get_node_names()
            try:
                until(lambda: program.ended() or known(), "a node that the master knows")
                until(lambda: program.ended() or node in SILENT or name in alive, "its diagnostics")
                self.assertFalse(program.ended(), "ended by itself")
            finally:
                status, said = program.end()
            self.assertEqual(status, 0, said)
        self.for_each(check)


if __name__ == "__main__":
    rospy.init_node("programs")
    rostest.rosrun("cell_microinjection", "programs", ProgramsTest)
