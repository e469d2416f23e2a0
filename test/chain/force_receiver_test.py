#!/usr/bin/python3
"""A hand is followed only while the node that tells its position subscribes to the force on it: a watchdog, a recorder or
`rostopic echo` that does so renders nothing."""

import threading
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped
from std_msgs.msg import Bool

from cell_microinjection.msg import InjectionStatus, OperatingState
from foreign_messages import DeviceFeedback, OmniFeedback, OmniState
from live_chain import until
from messages import pose, wrench

# What the device tells and where it takes its force, and what shows that it is followed.
DEVICES = {
    "external": ("/haptic/measured_cp", PoseStamped, "/haptic/servo_cf", WrenchStamped, "/teleop/servo_cp"),
    "omni": ("/phantom/state", OmniState, "/phantom/force_feedback", OmniFeedback, "/haptic/measured_cp"),
    "geomagic": ("/Geomagic/pose", PoseStamped, "/Geomagic/force_feedback", DeviceFeedback, "/haptic/measured_cp"),
    "force_dimension": ("/Falcon00/measured_cp", PoseStamped, "/Falcon00/body/servo_cf", WrenchStamped,
                        "/haptic/measured_cp"),
    "dvrk": ("/MTMR/measured_cp", PoseStamped, "/MTMR/body/servo_cf", WrenchStamped, "/haptic/measured_cp")}
SETTINGS = ("/MTMR/body/set_cf_orientation_absolute", "/MTMR/use_gravity_compensation")
RATE = 100  # Hz


class ForceReceiverTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.haptic = rospy.myargv()[1]
        cls.position, cls.kind, cls.force, cls.force_kind, shown = DEVICES[cls.haptic]
        cls.shown, cls.diagnostics, cls.set_, cls.forces = [], {}, {}, []
        cls.subscribers = [rospy.Subscriber(shown, PoseStamped, lambda message: cls.shown.append(message)),
                           rospy.Subscriber("/diagnostics", DiagnosticArray, cls.on_diagnostics)]
        cls.ended = threading.Event()
        cls.thread = threading.Thread(target=cls.tell, daemon=True)
        cls.thread.start()

    @classmethod
    def tearDownClass(cls):
        cls.ended.set()
        cls.thread.join()

    @classmethod
    def on_diagnostics(cls, message):
        cls.diagnostics.update({status.name: status for status in message.status})

    @classmethod
    def tell(cls):
        """The device, and what the bridge needs besides."""
        kinds = {cls.position: cls.kind}
        if cls.haptic == "external":
            kinds.update({"/needle/measured_cp": PoseStamped, "/cell/predicted_cf": WrenchStamped,
                          "/controller/injection_state": InjectionStatus})
        if cls.haptic == "dvrk":
            kinds["/MTMR/operating_state"] = OperatingState
        publishers = {topic: rospy.Publisher(topic, kind, queue_size=1) for topic, kind in kinds.items()}
        messages = {topic: kind() for topic, kind in kinds.items()}
        messages.update({topic: pose(0, 0, 0) for topic, kind in kinds.items() if kind is PoseStamped})
        if cls.haptic == "external":
            messages["/cell/predicted_cf"] = wrench(0, 0, 0)
        if cls.haptic == "dvrk":
            messages["/MTMR/operating_state"] = OperatingState(state="ENABLED", is_homed=True)
        while not cls.ended.is_set() and not rospy.is_shutdown():
            for topic, publisher in publishers.items():
                messages[topic].header.stamp = rospy.Time.now()
                publisher.publish(messages[topic])
            rospy.rostime.wallsleep(1 / RATE)

    def newest_followed(self):
        return bool(self.shown) and not self.shown[-1].header.stamp.is_zero()

    def why(self):
        name = "haptic_bridge: loop" if self.haptic == "external" else "haptic_device: device"
        status = self.diagnostics.get(name)
        return (status.level, status.message) if status else (None, "")

    def listen(self):
        return rospy.Subscriber(self.force, self.force_kind, self.forces.append)

    def check_held(self, what):
        """Held, and the reason is on the diagnostics; and so it stays."""
        self.diagnostics.clear()
        until(lambda: what in self.why()[1], f"diagnostics that say {what}; they say {self.why()}")
        self.assertEqual(self.why()[0], 1)
        until(lambda: self.shown and not self.newest_followed(), "a hand that is not followed")
        count = len(self.shown)
        until(lambda: len(self.shown) > count + 10, "it says so again and again")
        self.assertTrue(all(message.header.stamp.is_zero() for message in self.shown[count:]))

    def test_not_followed_unless_the_device_subscribes(self):
        if self.haptic == "dvrk":
            self.check_settings_first()
        reason = f"/device does not subscribe to the hand's force, {self.force}"
        self.check_held(reason)
        subscriber = self.listen()
        until(self.newest_followed, "a hand that is followed")
        subscriber.unregister()
        self.check_held(reason)
        subscriber = self.listen()
        until(self.newest_followed, "a hand that is followed again")
        subscriber.unregister()

    def check_settings_first(self):
        """Both are latched, true, and heard before any force and before the hand counts."""
        force = self.listen()
        self.check_held(f"/device has not received its settings {SETTINGS[0]}")
        self.assertEqual(self.forces, [])
        heard = [rospy.Subscriber(topic, Bool, lambda message, topic=topic: self.set_.update({topic: message.data}))
                 for topic in SETTINGS]
        until(self.newest_followed, "a hand that is followed")
        # Position, settings and force come through connections of their own, in no certain order.
        until(lambda: self.set_ == {topic: True for topic in SETTINGS}, "both settings, true")
        until(lambda: self.forces, "a force")
        force.unregister()
        self.subscribers.extend(heard)


if __name__ == "__main__":
    rospy.init_node("device")
    rostest.rosrun("cell_microinjection", f"force_receiver_{rospy.myargv()[1]}", ForceReceiverTest)
