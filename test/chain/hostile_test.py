#!/usr/bin/python3
"""Strangers send each node of a live session what nobody should, on every topic that it listens to: at least 250 kinds
a topic, on sixteen topics at a time. No node ends, none publishes a number that is not finite, and the loop closes again,
by itself or when it is enabled again after it has said what it waits for. Usage: PART, of PARTS"""

import math
import sys
import tempfile
import unittest
import warnings
from itertools import zip_longest

import genpy
import rosgraph
import roslib.message
import rospy
import rostest
import yaml
from cell_microinjection.msg import StringStamped
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped

import foreign_messages
from case import case
from hostile_messages import INTEGERS, hostile_messages
from killable_nodes import PACKAGE, PATIENCE, KillableNodes, parameters
from live_chain import RATE, TIMEOUT, Hand, LiveChain, Master, until

# NaN means none in these fields (Inject.action).
MAY_BE_NAN = {"puncture_force", "puncture_depth"}
# Most of what a node publishes: a header alone would take three quarters of the time.
WITHOUT_REALS = {"std_msgs/Header", "Header", "string", "time", "duration", "bool", *INTEGERS, *(f"{each}[]" for each in INTEGERS)}
FARTHER = 1.5 * TIMEOUT * Hand.SPEED * 1e-3  # m, of the needle, which is a thousandth of the hand
PAUSE = 0.002  # s between two messages on a topic, so that none is lost in a queue
warnings.simplefilter("ignore", SyntaxWarning)  # rospy's, of a publisher without a queue
sys.setswitchinterval(1e-4)  # s, a fiftieth: who publishes waits for those that listen each time that it has written
GROUP = 16  # topics that are attacked together; the loop is looked at after each group


def classes(kind):
    """Of a type's name; "Header" is that of std_msgs, and a name may have [] behind it."""
    name = kind.partition("[")[0]
    package, _, message = name.rpartition("/")
    if package in ("omni_msgs", "geomagic_control"):  # ROS would look for these packages everywhere
        return getattr(foreign_messages, message)
    return roslib.message.get_message_class(name)


def not_finite(value, name=""):
    """Path of a number in a message that is not finite; else empty."""
    if isinstance(value, float):
        return name if not math.isfinite(value) and name.rpartition(".")[2] not in MAY_BE_NAN else ""
    if isinstance(value, genpy.Message):
        parts = ((f"{name}.{slot}", getattr(value, slot)) for slot, kind in zip(value.__slots__, value._slot_types)
                 if kind not in WITHOUT_REALS)
    elif isinstance(value, (list, tuple)):
        parts = ((f"{name}[]", each) for each in value)
    else:
        return ""
    for part, each in parts:
        found = not_finite(each, part)
        if found:
            return found
    return ""


class Watch:
    """Looks at all that some nodes publish."""

    def __init__(self, nodes):
        self.defects = []
        self._subscribers = {}
        self._nodes = {f"/{node}" for node in nodes}

    def follow(self, topic, cls):
        if topic not in self._subscribers:
            self._subscribers[topic] = rospy.Subscriber(topic, cls, self._look, topic)

    def _look(self, message, topic):
        sender = message._connection_header["callerid"]
        if sender not in self._nodes:
            return
        defect = not_finite(message)
        if defect:
            self.defects.append(f"{sender} on {topic}: {defect}")

    def close(self):
        for subscriber in self._subscribers.values():
            subscriber.unregister()


class HostileTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("stranger")
        cls.folder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.master.kill()
        cls.folder.cleanup()

    def begin(self, changes):
        self.chain = LiveChain(changes)
        self.addCleanup(self.chain.close)
        self.nodes = self.chain.nodes
        self.enable = {topic: rospy.Publisher(topic, StringStamped, queue_size=5)
                       for topic in ("/needle/state_command", "/controller/state_command")}
        self.chain.check_follows()
        self.watch_nodes()
        self.addCleanup(self.watch.close)

    def watch_nodes(self):
        self.watch = Watch(self.nodes.names())
        for topic, cls in self.topics(publishers=True).items():
            self.watch.follow(topic, cls)

    def topics(self, publishers=False):
        """{topic: class} of what the nodes listen to, or publish."""
        master = rosgraph.Master(rospy.get_name())
        state = master.getSystemState()[0 if publishers else 1]
        kinds = dict(master.getTopicTypes())
        ours = {f"/{node}" for node in self.nodes.names()}
        return {topic: classes(kinds[topic]) for topic, nodes in state if ours & set(nodes)}

    def follows(self):
        """The needle goes farther than it could in the time-outs of a chain that has just been cut, while the hand goes
        three times as far."""
        hand, begin = self.chain.hand, self.chain.hand.way
        way, last = 0.0, self.chain.needle()[2]
        while hand.way - begin < 3e3 * FARTHER:
            now = self.chain.needle()[2]
            way, last = way + abs(now - last), now
            if way > FARTHER:
                return True
            rospy.rostime.wallsleep(0.01)
        return False

    def waits_for(self):
        return {name: status.message for name, status in list(self.chain.diagnostics.items()) if status.level}

    def say(self, topic, command):
        self.enable[topic].publish(StringStamped(string=command))
        rospy.rostime.wallsleep(0.1)

    def check_closes_again(self, topics):
        """By itself; or it says what it waits for, and closes when it was enabled again."""
        self.check_lives(topics)
        for _ in range(2):  # who was only held up by the machine follows later, and says nothing
            if self.follows():
                return
            said = self.waits_for()
            if said:
                break
        else:
            self.fail(f"after {topics} the needle does not follow, and nobody says why; {self.nodes.report()}")
        for _ in range(5):
            self.say("/controller/state_command", "disable")
            self.say("/needle/state_command", "enable")
            self.say("/controller/state_command", "enable")
            if self.follows():
                return
        self.fail(f"after {topics} the loop stays open: {said}; enabled again: {self.waits_for()}; "
                  f"{self.nodes.report()}")

    def attack(self, topics, check):
        names = sorted(topics)
        for number in range(0, len(names), GROUP):
            group = names[number:number + GROUP]
            # Without a queue, each of whose connections has a thread that keeps this one from the processor.
            publishers = [rospy.Publisher(topic, topics[topic], queue_size=None) for topic in group]
            until(lambda: self.nodes.dead() or all(publisher.get_num_connections() for publisher in publishers),
                  f"listeners of {group}")
            self.check_lives(group)
            for messages in zip_longest(*(hostile_messages(topics[topic], classes, number) for topic in group)):
                for publisher, message in zip(publishers, messages):
                    if message is not None:
                        publisher.publish(message)
                rospy.rostime.wallsleep(PAUSE)
            print(f"{group}: sent", flush=True)
            for publisher in publishers:
                publisher.unregister()
            check(group)
            self.assertEqual(self.watch.defects, [], f"after {group}")

    def check_lives(self, topics):
        self.assertEqual(self.nodes.dead(), [], f"after {topics}: {self.nodes.report()}")


class ChainTest(HostileTest):
    def test_chain(self):
        recorder = {"output_dir": f"{self.folder.name}/record", "hand": True, "injector": True, "bag": True}
        self.begin({"session_recorder": recorder, "display": parameters("display", rate=5), "force_watchdog": {}})
        self.attack({topic: cls for topic, cls in self.topics().items() if topic != "/rosout"},
                    self.check_closes_again)
        force = self.chain.counts["/haptic/servo_cf"]
        until(lambda: self.chain.counts["/haptic/servo_cf"] > force + 100, "the bridge")
        self.check_predicted_force()
        self.chain.nodes.kill("session_recorder", 2)
        rows = [line.split(",") for line in open(f"{self.folder.name}/record/force_depth.csv", encoding="utf-8")]
        self.assertGreater(sum(1 for row in rows[-1000:] if row[3]), 500, "the forces' column goes on")

    def check_predicted_force(self):
        self.chain.follow("/cell/predicted_cf", WrenchStamped)
        until(lambda: "/cell/predicted_cf" in self.chain.newest and
              not self.chain.newest["/cell/predicted_cf"].header.stamp.is_zero(), "a valid predicted force")


class LinkTest(HostileTest):
    def test_link(self):
        """Hand and rig apart: the bridge and the follower hear each other through the emulated network. Its plug is left
        alone: who pulls that means it."""
        link = parameters("link")
        patient = {key: TIMEOUT for key in ("needle", "predicted", "measured", "controller")}
        bridge = parameters("haptic_bridge", timeouts={"hand": TIMEOUT, **patient}, link=link["link"])
        follower = {"link": link["link"], "rate": RATE, "timeouts": patient}
        self.begin({"haptic_bridge": bridge, "teleoperation_follower": follower, "link_emulator": {}})
        plug = "/link/plugged"
        self.attack({topic: cls for topic, cls in self.topics().items() if topic.startswith("/link/") and topic != plug},
                    self.check_closes_again)


class HapticDevicesTest(HostileTest):
    def test_haptic_devices(self):
        """Their adapters alone, each on the drivers' topics."""
        for kind in ("omni", "geomagic", "joy", "marker"):
            with case(kind):
                settings = yaml.safe_load((PACKAGE / f"config/haptic/{kind}.yaml").read_text())["haptic_device"]
                self.nodes = KillableNodes({"haptic_device": settings})
                try:
                    rospy.wait_for_message("/diagnostics", DiagnosticArray, PATIENCE)  # it listens to all it ever will
                    self.watch_nodes()
                    self.attack(self.topics(), self.check_lives)
                finally:
                    self.nodes.stop()
                    self.watch.close()
                    self.nodes.forget()


PARTS = {"chain": ChainTest, "link": LinkTest, "haptic_devices": HapticDevicesTest}

if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "hostile", PARTS[sys.argv[1]])
