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
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped

from case import case
from crtk_client import CrtkClient
from killable_nodes import KillableNodes, rig
from live_chain import Master, until
from messages import position

START = np.array([0, 0, 60e-6])  # m, of the tip with all joints at 0
OLDEST_MOVE = rospy.Duration(3)  # that it may be obeyed
FAR = np.array([8e-3, 0, 60e-6])  # m, 4 s away: a machine that stalls must not miss the move


class CrtkTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("client")
        cls.places, cls.placed, cls.said, cls.commands = [], rospy.Time(), set(), None
        cls.subscribers = [
            rospy.Subscriber("/needle/measured_cp", PoseStamped, cls.on_pose),
            rospy.Subscriber("/diagnostics", DiagnosticArray, cls.on_diagnostics)]
        cls.fault = rospy.Publisher("/needle/emulated_fault", StringStamped, queue_size=10)
        cls.client = CrtkClient("/needle")
        cls.nodes = KillableNodes({"micromanipulator": {**rig(), "command_timeout": 1.0,
                                                        "velocity_command_timeout": 1.0,
                                                        "diagnostic_period": 0.1}})
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
    def on_pose(cls, message):
        cls.places.append(position(message))
        cls.placed = message.header.stamp

    @classmethod
    def on_diagnostics(cls, message):
        ours = [status for status in message.status if status.name.startswith("micromanipulator")]
        cls.said |= {status.message for status in ours}
        cls.commands = next((status for status in ours if status.name.endswith("commands")), cls.commands)

    def publisher(self, topic, kind, **options):
        publisher = rospy.Publisher(topic, kind, queue_size=10, **options)
        self.addCleanup(publisher.unregister)
        return publisher

    def needle(self):
        """Where it is since the client's newest state, which comes through another connection than the poses."""
        until(lambda: self.placed >= self.client.state_stamp(), "a pose of the needle since the newest state")
        return self.places[-1]

    def setpoint(self):
        """The client's, since its newest state."""
        until(lambda: self.client.has_setpoint_since(self.client.state_stamp()), "a set-point since the newest state")
        return self.client.setpoint_cp()

    def await_poses(self, number):
        """@returns the next poses (m), one a millisecond of the node's."""
        first = len(self.places)
        until(lambda: len(self.places) >= first + number, f"{number} poses of the needle")
        return np.array(self.places[first:first + number])

    def until_said(self, text):
        try:
            until(lambda: any(text in each for each in list(self.said)), f"diagnostics that say {text!r}")
        except AssertionError as error:
            raise AssertionError(f"{error}, but {self.said}; {self.nodes.report()}") from None

    def is_at(self, place):
        return np.allclose(self.needle(), place, atol=0.1e-6)

    def set_off(self):
        """A move of 8 mm that is under way."""
        handle = self.client.move_cp(FAR)
        self.assertTrue(handle.wait(is_busy=True), "is_busy")
        until(lambda: self.needle()[0] > 20e-6, "a needle that moves")
        return handle

    def check_rests(self):
        """At rest soon: all of 200 poses in turn are the same."""
        until(lambda: np.ptp(self.await_poses(200), axis=0).max() <= 1e-9, "a needle at rest")

    def busy_changes(self, since):
        """What is_busy said, each change of it."""
        said = [False, *(busy for _, _, busy in self.client.history[since:])]
        return [now for before, now in zip(said, said[1:]) if now != before]

    # the client's own example: moves from the set-point, and waits for each

    def test_moves_from_its_set_point_and_waits(self):
        start = self.setpoint()
        np.testing.assert_allclose(start, self.needle(), atol=0.1e-6)
        for way in ([0.1e-3, 0.1e-3, 0], [-0.1e-3, -0.1e-3, 0], [0, 0, 0]):
            self.assertTrue(self.client.move_cp(start + way).wait(), f"a move by {way}")
            self.assertTrue(self.is_at(start + way))
            np.testing.assert_allclose(self.setpoint(), start + way, atol=0.1e-6)

    def test_each_move_is_busy_once(self):
        for target in (START + [0.2e-3, 0, 0], START + [0.2e-3, 0, 0], START):  # the second one has no length
            since = len(self.client.history)
            self.assertTrue(self.client.move_cp(target).wait())
            self.await_poses(100)
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
            self.await_poses(5)
        until(lambda: self.is_at(START + [0, 0, 99e-6]), "the last set-point")
        self.assertEqual(self.busy_changes(since), [])

    def test_unstamped_velocities(self):
        for _ in range(40):
            self.client.servo_cv([50e-6, 0, 0])
            self.await_poses(10)
        until(lambda: self.needle()[0] > 5e-6, "a needle that has moved")  # its poses may be behind
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
        self.assertLess(paused[0], FAR[0] - 0.1e-3)
        self.until_said("move_cp of /client overridden: by pause of /client")
        self.client.move_cp(START)
        self.until_said("move_cp refused: PAUSED; allowed after resume")
        # The convention's table of transitions: enable is invalid in PAUSED, which it does not end.
        heard = len(self.client.history)
        self.client.state_command("enable")
        self.until_said("state is PAUSED, enable is allowed in DISABLED, ENABLED, FAULT")
        until(lambda: len(self.client.history) > heard, "the answer to a state command")
        self.assertEqual({state for state, _, _ in self.client.history[heard:]}, {"PAUSED"})
        self.client.state_command("resume")
        self.assertTrue(self.client.wait_for_state("ENABLED"))
        self.check_rests()
        self.assertTrue(self.is_at(paused), "what was paused does not go on by itself")
        self.assertTrue(self.client.move_cp(START).wait())
        self.assertTrue(self.is_at(START))

    def test_a_refused_command_is_on_diagnostics(self):
        def refused():
            return next(int(pair.value) for pair in self.commands.values if pair.key == "commands refused")

        until(lambda: self.commands, "diagnostics of the commands")
        for refuse, why in ((lambda: self.client.state_command("resume"),
                             "state_command resume refused: state is ENABLED, resume is allowed in PAUSED"),
                            (lambda: self.client.state_command("dance"), 'state_command dance refused: "dance" is'),
                            (lambda: self.client.move_cp([1.0, 0, 0]), "move_cp refused: manipulator_x = 1 m, allowed")):
            with case(why):
                before = refused()
                refuse()
                until(lambda: why in self.commands.message, "the refusal")
                self.assertEqual((self.commands.level, refused()), (DiagnosticStatus.WARN, before + 1))
        self.assertTrue(self.client.move_cp(START).wait())
        until(lambda: self.commands.level == DiagnosticStatus.OK, "what is obeyed takes the warning away")

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
            sent = rospy.Time.now()
            until(lambda: rospy.Time.now() > sent + OLDEST_MOVE, "a move that is too old")
        finally:
            process.send_signal(signal.SIGCONT)
        self.until_said("move_cp refused: it is stale")
        self.await_poses(300)  # for 0.2 s all that has no stamp may have waited
        self.assertTrue(self.is_at(START))

    def test_a_second_node_that_commands_is_a_fault(self):
        """As with stamps: an unstamped command has a sender, too."""
        stranger = subprocess.Popen([pathlib.Path(sys.argv[0]).parent / "second_master.py"])
        try:
            until(self.servoes_into_a_fault, "a fault")
        finally:
            stranger.kill()
            stranger.wait()
        self.until_said("two nodes command the needle")

    def servoes_into_a_fault(self):
        self.client.servo_cp(START)
        return self.client.operating_state() == "FAULT"

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
