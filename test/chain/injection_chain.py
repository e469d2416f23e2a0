"""What the tests of an injection by the controller itself share: the whole chain in lock step, see inject.test."""

import unittest

import numpy as np
import rospy
from cell_microinjection.msg import CellState, InjectionStatus, InjectorState, OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped

from messages import pose, position
from participant import Participant


class InjectionChainTest(unittest.TestCase):
    """Words and moves for the chain of inject.test, and what it does, tick by tick."""

    @classmethod
    def setUpClass(cls):
        cls.chain = Participant({}, {"/needle/measured_cp": PoseStamped, "/injector/state": InjectorState,
                                     "/cell/state": CellState, "/controller/injection_state": InjectionStatus,
                                     "/controller/operating_state": OperatingState,
                                     "/needle/operating_state": OperatingState})
        cls.states, cls.waited = [], set()
        cls.listener = rospy.Subscriber("/controller/injection_state", InjectionStatus, cls.on_status)
        cls.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=10)
        cls.moves = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=10)
        cls.chain.await_links()
        while "/needle/measured_cp" not in cls.chain.seen or cls.chain.seen["/needle/measured_cp"].header.stamp.is_zero():
            cls.chain.tick()  # a real rig is asked first
        cls.chain.run(50)

    @classmethod
    def on_status(cls, message):
        if not cls.states or cls.states[-1] != message.state:
            cls.states.append(message.state)
        if message.waits:
            cls.waited.add(message.state)

    def needle(self):
        return position(self.chain.seen["/needle/measured_cp"])

    def status(self):
        return self.chain.seen["/controller/injection_state"]

    def rig(self):
        return self.chain.seen["/needle/operating_state"]

    def tick_until(self, condition, what, ticks=30000):
        for _ in range(ticks):
            if condition():
                return
            self.chain.tick()
        self.fail(f"{what}: not within {ticks} ticks; the injection is in {self.status()}")

    def resting(self):
        """@returns where the needle rests, once it does: the injection before may have ended when its set-point did."""
        for _ in range(1000):
            before = self.needle()
            self.chain.run(30)  # some of the rig's time constants, and of its reports
            if np.allclose(self.needle(), before, rtol=0, atol=0.02e-6):
                return self.needle()
        return self.fail(f"the needle does not rest: {before}, {self.needle()}")

    def say(self, word):
        self.commands.publish(StringStamped(string=word))

    def check_out(self, start):
        """The needle is where it set out, the controller ready for the next one."""
        # The set-point is there first: the needle follows within a few of the rig's time constants.
        self.tick_until(lambda: np.allclose(self.needle(), start, rtol=0, atol=0.1e-6), f"the needle at {start}", 30)
        self.tick_until(lambda: self.status().state == "idle", "idle", 200)  # its message may come after the result
        self.assertEqual(self.chain.seen["/controller/operating_state"].state, "ENABLED")

    def move_aside(self, way):
        """Moves the needle by `way` (m) along x with the controller disabled: to where there is no hole."""
        for command in ("disable", "enable"):
            self.say(command)
            wanted = "DISABLED" if command == "disable" else "ENABLED"
            self.tick_until(lambda: self.chain.seen["/controller/operating_state"].state == wanted, wanted)
            if command == "disable":
                self.chain.run(200)  # its last set-point grows stale, and the needle rests: nobody commands it any more
                aside = self.needle() + [way, 0, 0]
                target = pose(*aside)
                target.header.stamp = self.chain.now
                self.moves.publish(target)
                self.tick_until(lambda: np.allclose(self.needle(), aside, atol=1e-8), "the move aside")
                # Enabled while it still moves, the controller would be a second node that commands it.
                # An older state knows nothing of this move.
                self.tick_until(lambda: self.rig().header.stamp > target.header.stamp and not self.rig().is_busy,
                                "the end of the move")
