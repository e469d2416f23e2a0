"""A CRTK client that behaves as the released crtk_python_client (1.4.0) does on ROS 1. Written from its source
(src/crtk/utils.py, wait_move_handle.py, ral_ros1.py; MIT licence) without its code.

What counts of it: commands have stamp 0 and an empty frame; state_command is latched, motion commands are not; an
operating_state counts only when its stamp is later than that of the one before; wait() of a move needs is_busy true
with a stamp later than the command, and false after it; home() and unhome() wait for another operating_state than the
one at their begin; setpoint_cp() needs a stamp of the last 20 ms, or waits so long for another message.

Differences: it waits by wall time, here up to PATIENCE, since a test machine stalls."""

import threading

import rospy
from cell_microinjection.msg import OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped, TwistStamped

from live_chain import until
from messages import position

PATIENCE = 30.0  # s; only a wait that never ends takes that long
INTERVAL = 0.02  # s, expected_interval of the client


class MoveHandle:
    """What move_cp gives back."""

    def __init__(self, client):
        self._client, self._begun = client, rospy.Time.now()

    def wait(self, is_busy=False, timeout=PATIENCE):
        return self._client.wait_for_busy(is_busy, self._begun, timeout)


class CrtkClient:
    def __init__(self, namespace):
        self._changed = threading.Condition()
        self._state, self._setpoint = OperatingState(), PoseStamped()
        self._heard = 0  # messages of operating_state
        self._last_busy = rospy.Time.now()
        self.history = []  # (state, is_homed, is_busy) of each operating_state, also of those that do not count
        name = namespace + "/"
        self._ends = [rospy.Subscriber(name + "operating_state", OperatingState, self._on_state, queue_size=10),
                      rospy.Subscriber(name + "setpoint_cp", PoseStamped, self._on_setpoint, queue_size=10)]
        self._command = rospy.Publisher(name + "state_command", StringStamped, latch=True, queue_size=10)
        self._move = rospy.Publisher(name + "move_cp", PoseStamped, queue_size=10)
        self._servo = rospy.Publisher(name + "servo_cp", PoseStamped, queue_size=10)
        self._velocity = rospy.Publisher(name + "servo_cv", TwistStamped, queue_size=10)
        self._ends += [self._command, self._move, self._servo, self._velocity]

    def check_connections(self):
        """As its ral does: all topics have somebody at their other end."""
        until(lambda: all(each.get_num_connections() for each in self._ends), "connections of all its topics")

    # what it hears

    def _on_state(self, message):
        with self._changed:
            self.history.append((message.state, message.is_homed, message.is_busy))
            if message.is_busy and message.header.stamp > self._last_busy:
                self._last_busy = message.header.stamp
            if message.header.stamp > self._state.header.stamp:
                self._state = message
            self._heard += 1
            self._changed.notify_all()

    def _on_setpoint(self, message):
        with self._changed:
            self._setpoint = message
            self._changed.notify_all()

    def operating_state(self):
        return self._state.state

    def is_homed(self):
        return self._state.is_homed

    def is_busy(self):
        return self._state.is_busy

    def state_stamp(self):
        return self._state.header.stamp

    def has_setpoint_since(self, stamp):
        return self._setpoint.header.stamp >= stamp

    def setpoint_cp(self):
        """@returns position (m); raises RuntimeWarning where none comes."""
        with self._changed:
            old = self._setpoint
            if rospy.Time.now() - old.header.stamp > rospy.Duration(INTERVAL):
                self._changed.wait_for(lambda: self._setpoint is not old, PATIENCE)
            if self._setpoint is old and old.header.stamp.is_zero():
                raise RuntimeWarning("unable to get setpoint_cp")
            return position(self._setpoint)

    # what it says

    def state_command(self, command):
        self._command.publish(StringStamped(string=command))

    def _change(self, command, satisfied, timeout):
        """Says it, and waits for an operating_state that comes after it and satisfies."""
        with self._changed:
            heard = self._heard
            self.state_command(command)
            return self._changed.wait_for(lambda: self._heard > heard and satisfied(), timeout)

    def enable(self, timeout=PATIENCE):
        if self.operating_state() == "ENABLED":
            self.state_command("enable")
            return True
        return self._change("enable", lambda: self.operating_state() == "ENABLED", timeout)

    def disable(self, timeout=PATIENCE):
        if self.operating_state() == "DISABLED":
            self.state_command("disable")
            return True
        return self._change("disable", lambda: self.operating_state() == "DISABLED", timeout)

    def home(self, timeout=PATIENCE):
        if self.is_homed():
            self.state_command("home")
            return True
        return self._change("home", lambda: self.is_homed() and not self.is_busy(), timeout)

    def unhome(self, timeout=PATIENCE):
        if not self.is_homed():
            self.state_command("unhome")
            return True
        return self._change("unhome", lambda: not self.is_homed() and not self.is_busy(), timeout)

    def wait_for_state(self, state, timeout=PATIENCE):
        with self._changed:
            return self._changed.wait_for(lambda: self.operating_state() == state, timeout)

    def wait_for_busy(self, is_busy, begun, timeout):
        def satisfied():
            was_busy = self._last_busy > begun
            return was_busy if is_busy else was_busy and not self.is_busy()
        with self._changed:
            return self._changed.wait_for(satisfied, timeout)

    def move_cp(self, place):
        handle = MoveHandle(self)
        self._move.publish(unstamped(place))
        return handle

    def servo_cp(self, place):
        self._servo.publish(unstamped(place))

    def servo_cv(self, velocity):
        message = TwistStamped()
        message.twist.linear.x, message.twist.linear.y, message.twist.linear.z = velocity
        self._velocity.publish(message)


def unstamped(place):
    """A pose as the client sends it: without stamp and frame, upright as the pipette is."""
    message = PoseStamped()
    message.pose.position.x, message.pose.position.y, message.pose.position.z = place
    message.pose.orientation.w = 1.0
    return message
