#!/usr/bin/python3
"""Keys typed into a terminal move the hand for as long as they come, and letters are the operator's words."""

import os
import pathlib
import pty
import subprocess
import sys
import threading
import time

import numpy as np
import rospy
import rostest
from cell_microinjection.msg import OperatingState

from case import case
from haptic_driver import FORCE, HAND, PRESENT, HapticTest
from messages import wrench
from participant import PATIENCE

PROGRAM = pathlib.Path(sys.argv[0]).parent / "keyboard_hand"  # this test is found beside it


class KeyboardTest(HapticTest):
    @classmethod
    def setUpClass(cls):
        cls.terminal, ours = pty.openpty()
        cls.program = subprocess.Popen([PROGRAM], stdin=ours, stdout=ours)
        os.close(ours)
        super().setUpClass()

    @classmethod
    def tearDownClass(cls):
        cls.program.kill()
        cls.program.wait()

    def good(self):
        return {FORCE: wrench(0, 0, 1.25, "haptic")}

    def type(self, keys):
        os.write(self.terminal, keys)
        rospy.rostime.wallsleep(0.02)  # s; the session stands still while the kernel hands them over

    def wait_for_hand(self, stamp):
        """Until it is here what the hand did at `stamp`: a topic may be behind another."""
        end = time.monotonic() + PATIENCE
        while self.seen(HAND).header.stamp < stamp:
            self.assertLess(time.monotonic(), end, "no hand")
            rospy.rostime.wallsleep(0.001)

    def present(self):
        return PRESENT in self.world.seen and self.seen(PRESENT).buttons[0]

    def rest(self):
        self.type(b" ")
        self.world.run(20, self.good)
        self.until(lambda: not self.present(), self.good, "the operator stays")
        return self.hand()

    def test_1_a_key_is_a_step_at_limited_speed_and_then_the_operator_is_gone(self):
        for keys, way in ((b"\x1b[B", [0, 0, -1e-3]), (b"\x1b[C", [1e-3, 0, 0]), (b"\x1b[5~", [0, 1e-3, 0])):
            start = self.rest()
            self.type(keys)
            self.until(self.present, self.good, "the operator is not present")
            self.until(lambda: not np.array_equal(self.hand(), start), self.good, "the hand does not move")
            self.world.run(50, self.good)
            self.assertLess(np.linalg.norm(self.hand() - start), 0.7e-3)  # 0.01 m/s
            self.world.run(100, self.good)
            np.testing.assert_allclose(self.hand() - start, way, atol=1e-12)
            self.assertTrue(self.present())
            self.world.run(800, self.good)
            self.assertFalse(self.present())

    def test_2_any_other_key_stops_at_once(self):
        # Space, escape, enter, tab, backspace, delete, control and an arrow.
        for key in (b" ", b"\x1b", b"\r", b"\t", b"\x7f", b"\x1b[3~", b"\x1b[1;5B"):
            with case(key):
                start = self.rest()
                self.type(b"\x1b[A" * 3)
                self.until(lambda: not np.array_equal(self.hand(), start), self.good, "the hand does not move")
                self.type(key)
                # Without it the operator would be there for 0.75 s; how soon it is read is the terminal's affair.
                before = self.world.now
                self.until(lambda: not self.present(), self.good, "the operator stays")
                self.assertLess((self.world.now - before).to_sec(), 0.5)
                self.wait_for_hand(self.seen(PRESENT).header.stamp)
                stopped = self.hand()
                self.world.run(500, self.good)
                np.testing.assert_array_equal(self.hand(), stopped)

    def test_3_words(self):
        self.type(b"eiwd")
        self.until(lambda: len(self.commands) >= 4, self.good, "no command")
        self.assertEqual(self.commands, ["enable", "inject", "home", "disable"])

    def test_3_words_in_a_pause(self):
        """CRTK's enable does not end PAUSED; the operator has one key for both."""
        controller = rospy.Publisher("/controller/operating_state", OperatingState, queue_size=1, latch=True)
        controller.publish(OperatingState(state="PAUSED"))
        self.world.await_links()
        self.world.run(50, self.good)
        for _ in range(20):  # until it has heard of the state
            told = len(self.commands)
            self.type(b"e")
            self.until(lambda: len(self.commands) > told, self.good, "no command")
            if self.commands[-1] == "resume":
                break
        controller.publish(OperatingState(state="ENABLED"))
        self.assertEqual(self.commands[-1], "resume")

    def test_4_the_force_is_told(self):
        self.world.run(200, self.good)
        os.set_blocking(self.terminal, False)
        text = b""
        while b"1.25 N" not in text:
            self.world.run(10, self.good)
            try:
                text += os.read(self.terminal, 4096)
            except BlockingIOError:
                pass

    def test_5_q_ends_it(self):
        self.type(b"q")
        # Without it there is no next tick to wait for.
        threading.Thread(target=self.world.run, args=(1000, self.good), daemon=True).start()
        self.assertEqual(self.program.wait(PATIENCE), 0)


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "haptic_keyboard", KeyboardTest)
