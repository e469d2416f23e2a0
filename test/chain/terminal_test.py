#!/usr/bin/python3
"""Each node of the loop writes to a terminal of its own that is stopped (Ctrl-S, a hung ssh): none waits for it."""

import os
import pty
import termios
import tty
import unittest

import rospy
import rostest
from cell_microinjection.msg import InjectionPulse, InjectorState, StringStamped
from geometry_msgs.msg import PoseStamped, WrenchStamped

from live_chain import LiveChain, Master, chain_parameters, until
from messages import pose

OUTPUTS = {"haptic_bridge": ("/haptic/servo_cf", WrenchStamped), "injection_controller": ("/needle/servo_cp", PoseStamped),
           "micromanipulator": ("/needle/measured_cp", PoseStamped), "injector": ("/injector/state", InjectorState),
           "cell_simulator": ("/cell/predicted_cf", WrenchStamped),
           "force_sensor": ("/force_sensor/measured_cf", WrenchStamped)}


class StoppedTerminal:
    """A write to it waits until it is resumed, which it never is."""

    def __init__(self):
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        termios.tcflow(self.slave, termios.TCOOFF)


class TerminalTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("watcher")
        cls.terminals = {node: StoppedTerminal() for node in chain_parameters()}
        cls.chain = LiveChain(outputs={node: terminal.slave for node, terminal in cls.terminals.items()})
        for topic, kind in OUTPUTS.values():
            cls.chain.follow(topic, kind)

    @classmethod
    def tearDownClass(cls):
        cls.chain.close()
        cls.master.kill()

    def test_1_the_loop_closes(self):
        self.chain.check_follows()

    def test_2_nobody_waits_in_a_warning(self):
        """Each is told something that it puts into its log."""
        self.chain.check_follows()
        commands = [("/controller/state_command", StringStamped(string="no command")),
                    ("/needle/state_command", StringStamped(string="no command")),
                    ("/needle/move_cp", self.ahead(pose(0, 0, 0))), ("/injector/pulse", InjectionPulse(id=1)),
                    ("/haptic/measured_cp", self.ahead(pose(0, 0, 0, "haptic"))),
                    ("/needle/true_cp", self.ahead(pose(0, 0, 0))), ("/cell/predicted_cf", self.ahead(WrenchStamped()))]
        publishers = [(rospy.Publisher(topic, type(message), queue_size=1), message) for topic, message in commands]
        for publisher, message in publishers:
            until(publisher.get_num_connections, publisher.name)
            publisher.publish(message)
        for node, (topic, _) in OUTPUTS.items():
            begin = self.chain.counts[topic]
            until(lambda: self.chain.counts[topic] > begin + 400, f"{node} goes on")
        self.chain.check_follows()

    @staticmethod
    def ahead(message):
        message.header.stamp = rospy.Time.now() + rospy.Duration(100)
        return message

    def test_3_nothing_of_it_is_on_the_terminals(self):
        """They are stopped, indeed."""
        for terminal in self.terminals.values():
            os.set_blocking(terminal.master, False)
            self.assertRaises(BlockingIOError, os.read, terminal.master, 1)


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "terminal", TerminalTest)
