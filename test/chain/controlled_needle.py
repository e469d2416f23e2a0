"""A session whose controller injects and whose needle can be moved past it; with the felt and the true cell's forces."""

import time
import unittest

import numpy as np
import rospy
from cell_microinjection.msg import OperatingState, StringStamped, VisionState
from geometry_msgs.msg import PoseStamped, WrenchStamped

from messages import force, pose, position

PATIENCE = 300  # s


class ControlledNeedle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.seen = {}  # the newest message of each topic
        cls.forces = {"/cell/predicted_cf": {}, "/true_cell/predicted_cf": {}}  # N along the needle, by stamp
        for topic, kind in (("/vision/state", VisionState), ("/needle/measured_cp", PoseStamped),
                            ("/needle/operating_state", OperatingState), ("/controller/operating_state", OperatingState)):
            cls.see(topic, kind)
        cls.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=1)
        cls.moves = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=1)
        for topic in cls.forces:
            rospy.Subscriber(topic, WrenchStamped, lambda message, topic=topic: cls.on_force(topic, message),
                             queue_size=2000, tcp_nodelay=True)

    @classmethod
    def on_force(cls, topic, message):
        """Both forces have the stamp of the needle's pose that they are of."""
        if not message.header.stamp.is_zero():
            cls.forces[topic][message.header.stamp.to_nsec()] = force(message)[2]

    @classmethod
    def see(cls, topic, kind):
        rospy.Subscriber(topic, kind, lambda message: cls.seen.update({topic: message}), queue_size=1)

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: not within {PATIENCE} s; vision: {self.vision()}")
            time.sleep(0.05)

    def vision(self):
        """What the last image showed, and how old it is; for a failure's message."""
        state = self.seen.get("/vision/state")
        if not state:
            return "no image"
        return (f"{(rospy.Time.now() - state.header.stamp).to_sec():.1f} s ago, cell: {state.cell.verdict} {state.cell.reason}, "
                f"tip: {state.injection_pipette.verdict} {state.injection_pipette.reason}")

    def needle(self):
        return position(self.seen["/needle/measured_cp"])

    def command(self, command, state):
        def reached():
            message = self.seen.get("/controller/operating_state")
            if message and message.state == state:
                return True
            self.commands.publish(StringStamped(string=command))
            time.sleep(0.2)
            return False
        self.until(reached, state)

    def has_ended(self, sent):
        """Whether the move that was sent then is over: an older state of the rig knows nothing of it."""
        state = self.seen.get("/needle/operating_state")
        return state and state.header.stamp >= sent and not state.is_busy

    def move_to(self, place):
        """With the controller disabled: two must not command the needle."""
        self.command("disable", "DISABLED")
        self.until(self.moves.get_num_connections, "the micromanipulator")
        disabled = rospy.Time.now()
        # The controller's last set-point grows stale, by the time of the micromanipulator, which may have stood still.
        self.until(lambda: "/needle/measured_cp" in self.seen and self.seen["/needle/measured_cp"].header.stamp >
                   disabled + rospy.Duration(0.5), "half a second of the needle at rest")
        target = pose(*place)
        target.header.stamp = rospy.Time.now()
        self.moves.publish(target)
        self.until(lambda: np.allclose(self.needle(), place, atol=5e-8), f"the needle at {place}")
        self.until(lambda: self.has_ended(target.header.stamp), "the end of the move")
        self.command("enable", "ENABLED")
