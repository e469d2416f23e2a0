#!/usr/bin/python3
"""The released CRTK client drives a live needle: unstamped commands, states, is_busy, set-point; nothing old counts."""

import pathlib
import signal
import subprocess
import sys
import unittest

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import StringStamped
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped

from crtk_client import CrtkClient, unstamped
from killable_nodes import KillableNodes, rig
from live_chain import Master, until
from messages import position

START = np.array([0, 0, 60e-6])  # m, of the tip with all joints at 0
FAR = np.array([3e-3, 0, 60e-6])  # m, 1.5 s away


class CrtkTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("client")
        cls.newest, cls.said = {}, set()
        cls.subscribers = [
            rospy.Subscriber("/needle/measured_cp", PoseStamped, lambda message: cls.newest.update(needle=message)),
            rospy.Subscriber("/diagnostics", DiagnosticArray, cls.on_diagnostics)]
        cls.fault = rospy.Publisher("/needle/emulated_fault", StringStamped, queue_size=10)
        cls.client = CrtkClient("/needle")
        cls.nodes = KillableNodes({"micromanipulator": {**rig(), "command_timeout": 1.0,
                                                        "velocity_command_timeout": 1.0}})
        cls.client.check_connections()
        until(cls.fault.get_num_connections, "a rig that can be at fault")

    @classmethod
    def tearDownClass(cls):
        cls.nodes.stop()
        cls.master.kill()

    def setUp(self):
        self.client.disable()
        self.assertTrue(self.client.enable())
        since = len(self.client.history)
        self.client.home()  # a wait for the move would be over with it
        until(lambda: self.busy_changes(since) == [True, False], "home, which is busy once")
        self.assertTrue(self.client.move_cp(START).wait(), self.nodes.report())
        self.said.clear()

    @classmethod
    def on_diagnostics(cls, message):
        cls.said |= {status.message for status in message.status if status.name.startswith("micromanipulator")}

    def publisher(self, topic, kind, **options):
        publisher = rospy.Publisher(topic, kind, queue_size=10, **options)
        self.addCleanup(publisher.unregister)
        return publisher

    def needle(self):
        return position(self.newest["needle"])

    def until_said(self, text):
        try:
            until(lambda: any(text in each for each in self.said), f"diagnostics that say {text!r}")
        except AssertionError as error:
            raise AssertionError(f"{error}, but {self.said}; {self.nodes.report()}") from None

    def is_at(self, place):
        return np.allclose(self.needle(), place, atol=0.1e-6)

    def set_off(self):
        """A move of 3 mm that is under way."""
        handle = self.client.move_cp(FAR)
        self.assertTrue(handle.wait(is_busy=True), "is_busy")
        until(lambda: self.needle()[0] > 20e-6, "a needle that moves")
        return handle

    def check_rests(self):
        """At rest soon: each of ten poses, of the second after, is the same."""
        until(lambda: self.stands(), "a needle at rest")

    def stands(self):
        held = self.needle()
        for _ in range(20):
            rospy.rostime.wallsleep(0.01)
            if np.abs(self.needle() - held).max() > 1e-9:
                return False
        return True

    def busy_changes(self, since):
        """What is_busy said, each change of it."""
        said = [False, *(busy for _, _, busy in self.client.history[since:])]
        return [now for before, now in zip(said, said[1:]) if now != before]

    # the client's own example: moves from the set-point, and waits for each

    def test_moves_from_its_set_point_and_waits(self):
        start = self.client.setpoint_cp()
        np.testing.assert_allclose(start, self.needle(), atol=0.1e-6)
        for way in ([0.1e-3, 0.1e-3, 0], [-0.1e-3, -0.1e-3, 0], [0, 0, 0]):
            self.assertTrue(self.client.move_cp(start + way).wait(), f"a move by {way}")
            self.assertTrue(self.is_at(start + way))
            np.testing.assert_allclose(self.client.setpoint_cp(), start + way, atol=0.1e-6)

    def test_each_move_is_busy_once(self):
        for target in (START + [0.2e-3, 0, 0], START + [0.2e-3, 0, 0], START):  # the second one has no length
            since = len(self.client.history)
            self.assertTrue(self.client.move_cp(target).wait())
            rospy.rostime.wallsleep(0.1)
            self.assertEqual(self.busy_changes(since), [True, False])

    def test_a_move_that_takes_over_is_busy_again(self):
        since = len(self.client.history)
        first = self.set_off()
        second = self.client.move_cp(START)
        self.assertTrue(second.wait())
        self.assertTrue(first.wait())
        self.assertTrue(self.is_at(START))
        self.assertEqual(self.busy_changes(since), [True, False, True, False])
        self.until_said("move_cp of /client overridden: by move_cp of /client")

    def test_is_not_busy_while_it_servoes(self):
        since = len(self.client.history)
        for step in range(100):
            self.client.servo_cp(START + [0, 0, 1e-6 * step])
            rospy.rostime.wallsleep(0.005)
        until(lambda: self.is_at(START + [0, 0, 99e-6]), "the last set-point")
        self.assertEqual(self.busy_changes(since), [])

    def test_unstamped_velocities(self):
        for _ in range(40):
            self.client.servo_cv([50e-6, 0, 0])
            rospy.rostime.wallsleep(0.01)
        self.assertGreater(self.needle()[0], 5e-6)
        self.check_rests()  # when they have become old
        self.assertFalse(self.client.is_busy())

    # states

    def test_pause_in_a_move_and_resume(self):
        handle = self.set_off()
        self.client.state_command("pause")
        self.assertTrue(self.client.wait_for_state("PAUSED"))
        self.assertTrue(handle.wait())
        self.check_rests()
        paused = self.needle()
        self.assertLess(paused[0], 2.9e-3)
        self.until_said("move_cp of /client overridden: by pause of /client")
        self.client.move_cp(START)
        self.until_said("move_cp refused: PAUSED; allowed after resume")
        self.assertFalse(self.client.enable(timeout=0.5), "the convention: enable is invalid in PAUSED")
        self.until_said("state is PAUSED, enable is allowed in DISABLED, ENABLED, FAULT")
        self.client.state_command("resume")
        self.assertTrue(self.client.wait_for_state("ENABLED"))
        self.check_rests()
        self.assertTrue(self.is_at(paused), "what was paused does not go on by itself")
        self.assertTrue(self.client.move_cp(START).wait())
        self.assertTrue(self.is_at(START))

    def test_disable_in_a_move_and_enable(self):
        self.set_off()
        self.assertTrue(self.client.disable())
        self.check_rests()
        held = self.needle()
        self.client.move_cp(START)
        self.until_said("move_cp refused: DISABLED; allowed after enable")
        self.client.state_command("resume")
        self.until_said("state is DISABLED, resume is allowed in PAUSED")
        self.assertTrue(self.client.enable())
        self.assertTrue(self.is_at(held))

    def test_unhome_and_home(self):
        self.assertTrue(self.client.is_homed())
        self.set_off()
        self.assertTrue(self.client.unhome())
        self.check_rests()
        self.client.move_cp(START)
        self.until_said("move_cp refused: the needle is not homed; allowed after home")
        since = len(self.client.history)
        self.assertTrue(self.client.home())
        self.assertEqual(self.busy_changes(since), [True, False])
        self.assertTrue(self.client.move_cp(START).wait())

    def test_enable_ends_a_fault(self):
        handle = self.set_off()
        self.fault.publish(StringStamped(string="error:4"))
        self.assertTrue(self.client.wait_for_state("FAULT"))
        self.assertTrue(handle.wait())
        for command in ("pause", "resume", "home"):
            self.client.state_command(command)
            self.until_said(f"state is FAULT, {command} is allowed in")
        self.assertEqual(self.client.operating_state(), "FAULT")
        self.assertTrue(self.client.enable())
        self.assertTrue(self.client.move_cp(START).wait())
        self.fault.publish(StringStamped(string="error:4"))
        self.assertTrue(self.client.wait_for_state("FAULT"))
        self.assertTrue(self.client.disable())

    # nothing old

    def test_refuses_unstamped_moves_of_a_publisher_that_latches(self):
        """As those of rostopic pub -1, and of the client until 1.1."""
        held = self.needle()
        for topic, said in (("move_cp", "move_cp refused:"), ("servo_cp", "needle/servo_cp: refused,")):
            far = f"{{pose: {{position: {{x: {FAR[0]:f}, z: {FAR[2]:f}}}, orientation: {{w: 1.0}}}}}}"
            subprocess.run(["rostopic", "pub", "-1", f"/needle/{topic}", "geometry_msgs/PoseStamped", far], check=True,
                           stdout=subprocess.DEVNULL)
            self.until_said(f"{said} it has no stamp and its publisher latches")
            np.testing.assert_allclose(self.needle(), held, atol=0.1e-6)

    def test_a_node_that_was_frozen_obeys_nothing_old(self):
        process = self.nodes.process("micromanipulator")
        process.send_signal(signal.SIGSTOP)
        try:
            self.client.move_cp(FAR)
            rospy.rostime.wallsleep(3.5)  # longer than a move may be old
        finally:
            process.send_signal(signal.SIGCONT)
        self.until_said("move_cp refused: it is stale")
        self.assertTrue(self.is_at(START))

    def test_a_second_node_that_commands_is_a_fault(self):
        """As with stamps: an unstamped command has a sender, too."""
        stranger = subprocess.Popen([pathlib.Path(sys.argv[0]).parent / "second_master.py"])
        try:
            for _ in range(2000):
                self.client.servo_cp(START)
                if self.client.operating_state() == "FAULT":
                    break
                rospy.rostime.wallsleep(0.01)
            self.assertEqual(self.client.operating_state(), "FAULT")
        finally:
            stranger.kill()
            stranger.wait()
        self.until_said("two nodes command the needle")

    def test_when_the_node_starts_anew_it_obeys_nothing_old(self):
        """The client's last state command is latched and comes again. Last by its name: its node is another."""
        self.assertTrue(self.client.unhome())
        self.assertTrue(self.client.home())
        self.nodes.kill("micromanipulator")
        self.said.clear()
        self.nodes.start("micromanipulator")
        self.until_said("state_command home refused: it has no stamp and its publisher latches")
        since = len(self.client.history)
        self.client.home()  # said again it is obeyed
        until(lambda: self.busy_changes(since) == [True, False], "home, which is busy once")


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "crtk", CrtkTest)
