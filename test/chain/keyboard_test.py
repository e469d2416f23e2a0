#!/usr/bin/python3
"""Keys typed into a terminal move the hand for as long as they come, and letters are the operator's words. Times are those
of the messages' stamps."""

import os
import pty
import subprocess
import threading
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from case import case
from cell_microinjection.msg import OperatingState, StringStamped
from killable_nodes import PATIENCE, PROGRAMS
from live_chain import until
from messages import position, wrench

SPEED = 0.01  # m/s
PRESENT = 0.75  # s after the last key
LONGEST_STEP = 0.05  # s, of the node, however long the machine stood still
TRIES = 10  # of what a machine that stalls may spoil
ARROW = b"\x1b[A"


class Heard:
    """What a topic's messages have told: [(stamp in s, value)]."""

    def __init__(self, topic, kind, value):
        self.all = []
        self._subscriber = rospy.Subscriber(topic, kind, lambda message: self._hear(message, value), queue_size=100)

    def _hear(self, message, value):
        if not message.header.stamp.is_zero():
            self.all.append((message.header.stamp.to_sec(), value(message)))

    def newest(self):
        return self.all[-1][1] if self.all else None

    def since(self, stamp):
        return [(at, value) for at, value in list(self.all) if at >= stamp]

    def until_after(self, stamp):
        until(lambda: self.all and self.all[-1][0] > stamp, f"messages of after {stamp}")


class KeyboardTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.words = []
        cls.hand = Heard("/haptic/measured_cp", PoseStamped, position)
        cls.present = Heard("/haptic/operator_present", Joy, lambda message: bool(message.buttons[0]))
        words = rospy.Subscriber("/controller/state_command", StringStamped, lambda message: cls.words.append(message.string))
        cls.ended = threading.Event()
        cls.bridge = threading.Thread(target=cls.render, daemon=True)
        cls.bridge.start()
        cls.terminal, theirs = pty.openpty()
        cls.program = subprocess.Popen([PROGRAMS / "keyboard_hand"], stdin=theirs, stdout=theirs)
        os.close(theirs)
        until(lambda: words.get_num_connections() and cls.hand.all and cls.present.all, "the keyboard's hand")

    @classmethod
    def tearDownClass(cls):
        cls.program.kill()
        cls.program.wait()
        cls.ended.set()
        cls.bridge.join()

    @classmethod
    def render(cls):
        publisher = rospy.Publisher("/haptic/servo_cf", WrenchStamped, queue_size=1)
        while not cls.ended.wait(0.01):
            message = wrench(0, 0, 1.25, "haptic")
            message.header.stamp = rospy.Time.now()
            publisher.publish(message)

    def type(self, keys):
        os.write(self.terminal, keys)

    def rest(self):
        """@returns where the hand is without an operator."""
        self.type(b" ")
        until(lambda: self.present.newest() is False, "an operator who is gone")
        self.hand.until_after(self.present.all[-1][0])
        return self.hand.newest()

    def until_present(self):
        """@returns the stamp of the first message that says so."""
        begin = self.present.all[-1][0]
        until(self.present.newest, "an operator")
        return next(at for at, present in self.present.since(begin) if present)

    def until_absent(self, begin):
        """@returns how long (s) the operator who was there at `begin` stayed."""
        until(lambda: not self.present.newest(), "the operator's end")
        return next(at for at, present in self.present.since(begin) if not present) - begin

    def until_rests(self, stamp):
        """@returns where the hand has been from this stamp on, for half a second."""
        self.hand.until_after(stamp + 0.5)
        places = [place for _, place in self.hand.since(stamp)]
        np.testing.assert_array_equal(places, np.broadcast_to(places[0], np.shape(places)))
        return places[0]

    def check_speed(self, begin):
        moves = self.hand.since(begin)
        for (before, here), (after, there) in zip(moves, moves[1:]):
            self.assertLessEqual(np.linalg.norm(there - here), SPEED * (after - before) + 1e-8)  # a stamp in s is rounded

    def test_1_a_key_is_a_step_at_limited_speed_and_then_the_operator_is_gone(self):
        for keys, way in ((b"\x1b[B", [0, 0, -1e-3]), (b"\x1b[C", [1e-3, 0, 0]), (b"\x1b[5~", [0, 1e-3, 0])):
            with case(keys):
                start = self.rest()
                self.type(keys)
                begin = self.until_present()
                stayed = self.until_absent(begin)
                self.assertGreater(stayed, PRESENT - 2 * LONGEST_STEP)
                np.testing.assert_allclose(self.until_rests(begin + stayed) - start, way, atol=1e-12)
                self.check_speed(begin)

    def stops(self, key):
        """Whether the key ended the motion before it had ended by itself."""
        start = self.rest()
        self.type(3 * ARROW)
        begin = self.until_present()
        until(lambda: not np.array_equal(self.hand.newest(), start), "a hand that moves")
        self.type(key)
        stayed = self.until_absent(begin)
        way = np.linalg.norm(self.until_rests(begin + stayed) - start)
        return stayed < PRESENT - 2 * LONGEST_STEP and way < 2.9e-3

    def test_2_any_other_key_stops_at_once(self):
        # Space, escape, control and an arrow.
        for key in (b" ", b"\x1b", b"\x1b[1;5B"):
            with case(key):
                self.assertTrue(any(self.stops(key) for _ in range(TRIES)), f"in none of {TRIES} tries")

    def test_3_words(self):
        self.words.clear()
        self.type(b"eiwd")
        until(lambda: len(self.words) >= 4, "4 words")
        self.assertEqual(self.words, ["enable", "inject", "home", "disable"])

    def test_3_words_in_a_pause(self):
        """CRTK's enable does not end PAUSED; the operator has one key for both."""
        controller = rospy.Publisher("/controller/operating_state", OperatingState, queue_size=1, latch=True)
        for state, word in (("PAUSED", "resume"), ("ENABLED", "enable")):
            controller.publish(OperatingState(state=state))
            for _ in range(200):  # until it has heard of the state
                told = len(self.words)
                self.type(b"e")
                until(lambda: len(self.words) > told, "a word")
                if self.words[-1] == word:
                    break
            self.assertEqual(self.words[-1], word)

    def test_4_the_force_is_told(self):
        os.set_blocking(self.terminal, False)
        text = b""

        def told():
            nonlocal text
            try:
                text += os.read(self.terminal, 4096)
            except BlockingIOError:
                pass
            return b"1.25 N" in text
        until(told, "the force on the terminal")

    def test_5_q_ends_it(self):
        self.type(b"q")
        self.assertEqual(self.program.wait(PATIENCE), 0)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "keyboard", KeyboardTest)
