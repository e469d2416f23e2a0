"""A lock-step session that a test is among the participants of, kills nodes in, and looks at what comes of it."""

import csv
import os
import sys
import tempfile
import unittest

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from std_msgs.msg import Header, String

from cell_microinjection.msg import InjectionStatus, InjectorState, OperatingState, StringStamped
from killable_nodes import PACKAGE, PATIENCE, KillableNodes, parameters, rig
from links import missing_links
from messages import force, pose, position
from participant import Participant

TICK = 1e-3  # s
SLACK = 2 * TICK  # what a message needs from node to node
STILL = 2e-9  # m
HAND, FELT, NEEDLE, SETPOINT = "/haptic/measured_cp", "/haptic/servo_cf", "/needle/measured_cp", "/needle/servo_cp"
INJECTOR = "/injector/state"
RECORDED = {HAND: PoseStamped, FELT: WrenchStamped, NEEDLE: PoseStamped, SETPOINT: PoseStamped, INJECTOR: InjectorState}

BRIDGE, CONTROLLER, LINK = (parameters(file) for file in ("haptic_bridge", "injection_controller", "link"))
RIG, INJECT, OPERATOR = rig(), parameters("injector"), parameters("operator")
PACKETS = {"haptic_bridge": ["link/hand/received:=link/rig/sent"],
           "teleoperation_follower": ["link/rig/received:=link/hand/sent"]}
AFTER = CONTROLLER["motion"]["stop_time"]  # s, from a set-point that rests to a needle that rests
HAND_TIMEOUT, CONTROLLER_TIMEOUT = BRIDGE["timeouts"]["hand"], CONTROLLER["input_timeout"]
START = 32e-6  # m, 4 um above the cell
# s, for begin(): its words are no part of the lock step, and late by as many ticks as the machine does meanwhile.
START_DELAY = 0.6

# Seconds, where the hand has got to (m of the needle), phase.
MOTION = [(0.02, 0, "rest"), (0.15, -3e-6, "approach"), (0.3, -8e-6, "indent"), (0.35, -8e-6, "hold"),
          (0.6, -3e-6, "withdraw"), (0.3, -3e-6, "rest")]


def write_motion(path):
    rows, time, z = [], 0.0, 0.0
    for duration, goal, phase in MOTION:
        rows += [(time, 0, 0, 1e3 * z, 0, phase), (time + duration - 1e-6, 0, 0, 1e3 * goal, 0, phase)]
        time, z = time + duration, goal
    with open(path, "w", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([("time_s", "x_m", "y_m", "z_m", "clutch", "phase"), *rows])


class Session:
    """A lock-step session with the test among the participants, that a node is killed in."""

    def __init__(self, nodes, seen, remaps):
        participants = [rospy.get_name(), *(f"/{node}" for node in nodes)]
        self.nodes = KillableNodes({"lockstep_clock": {}, **nodes}, participants, remaps)
        self.records = {topic: {} for topic in RECORDED}
        self.answers = {}
        self._subscribers = [rospy.Subscriber(topic, kind, self._record, topic) for topic, kind in RECORDED.items()]
        self._subscribers.append(rospy.Subscriber("/lockstep/acknowledgement", Header, self._on_answer))
        self._moves = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=1)
        self.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=1)
        self._leave, self._left = rospy.Publisher("/lockstep/leave", String, queue_size=1), ""
        self._subscribers.append(rospy.Subscriber("/lockstep/left", String, self._on_left))
        self._busy = []  # what the rig has said so far
        self._subscribers.append(rospy.Subscriber("/needle/operating_state", OperatingState, self._on_rig))
        self._seen, self.chain = seen, None

    def _record(self, message, topic):
        self.records[topic][message.header.stamp.to_nsec()] = message

    def _on_answer(self, header):
        self.answers[header.frame_id] = header.stamp

    def _on_rig(self, message):
        self._busy.append(message.is_busy)

    def _on_left(self, message):
        self._left = message.data

    def close(self):
        self.nodes.stop()
        # The master tells subscribers of each publisher that goes: this node need not hear it, and at the addresses of
        # the dead there may be others when it does. So they unsubscribe first, and only then does any publisher go.
        for subscriber in self._subscribers:
            subscriber.unregister()
        if self.chain:
            self.chain.unsubscribe()
        self.nodes.forget()
        for publisher in (self._moves, self.commands, self._leave):
            publisher.unregister()
        if self.chain:
            self.chain.close()

    def until(self, condition, what, ticks=3000):
        for _ in range(ticks):
            if condition():
                return
            self.chain.tick()
        raise AssertionError(f"{what}: not within {ticks} ticks; seen {self.chain.seen}; {self.nodes.report()}")

    def says(self, topic, field, *values):
        return topic in self.chain.seen and getattr(self.chain.seen[topic], field) in values

    def wait_for(self, condition):
        for _ in range(1000 * PATIENCE):
            if condition():
                return
            rospy.rostime.wallsleep(0.001)
        raise AssertionError(f"the session hangs; {self.nodes.report()}")

    def begin(self):
        """The needle is put near the cell, and when that is over the controller is enabled: two would be a fault."""
        kinds = {"/controller/injection_state": InjectionStatus, "/controller/operating_state": OperatingState,
                 "/operator/phase": StringStamped}
        try:
            self.chain = Participant({}, {topic: kinds[topic] for topic in self._seen})
        except Exception as error:
            raise AssertionError(f"the session does not begin: {error!r}; no connection: {sorted(missing_links())}; "
                                 f"{self.nodes.report()}") from error
        goal = pose(0, 0, START)
        goal.header.stamp = self.chain.now
        self._moves.publish(goal)
        self.until(self.at_start, "the way to the start")
        self.commands.publish(StringStamped(string="enable"))
        # The lock step does not wait for this topic, which may come late. A test that looks at the injection's state needs
        # its first tick, and could miss it here.
        if "/controller/injection_state" not in self._seen:
            self.until(lambda: self.says("/controller/operating_state", "state", "ENABLED"), "ENABLED")

    def at_start(self):
        records = self.records[NEEDLE]
        over = True in self._busy and not self._busy[-1]
        return records and over and abs(position(records[max(records)])[2] - START) < STILL

    def kill(self, node, freezes):
        """Once all have done this tick. @returns its time (s): the last word of the node. `freezes`: it is stopped
        instead (SIGSTOP), and the clock hears of it."""
        others = {f"/{name}" for name in self.nodes.names()} - {"/lockstep_clock"}
        self.wait_for(lambda: all(self.answers.get(name) == self.chain.now for name in others))
        if freezes:
            self.nodes.freeze(node)
            self._leave.publish(f"/{node}")
            self.wait_for(lambda: f"/{node} " in self._left)
        else:
            self.nodes.kill(node)
        return self.chain.now.to_sec()

    def series(self, topic, value):
        """(times in s, values of all messages) so far."""
        records = self.records[topic]
        times = sorted(records)
        return np.array(times) * 1e-9, np.array([value(records[time]) for time in times])

    def catch_up(self, topic):
        """Until what was said before the present tick is here."""
        self.wait_for(lambda: max(self.records[topic]) >= self.chain.now.to_nsec() - 1.5e6)


class KillCase(unittest.TestCase):
    """Opens sessions, and closes each when the next begins."""

    FREEZES = "freeze" in sys.argv  # instead of being killed, nodes are stopped and stay

    @classmethod
    def cases(cls, *of_kill, of_freeze="indent"):
        """(state, ticks in it) in which a node is killed; of those the one in which it is frozen: to the others it is as
        silent then, whatever the state, and they cannot tell the difference."""
        return [case for case in of_kill if not cls.FREEZES or case[0] == of_freeze]

    def setUp(self):
        self.session = None

    def tearDown(self):
        if self.session:
            self.session.close()
            self.session = None

    def open(self, nodes, seen, remaps=None):
        self.tearDown()
        self.session = Session(nodes, ["/controller/operating_state", *seen], remaps)
        self.session.begin()

    def by_hand(self, more=(), linked=False, source="predicted"):
        """A session in which the virtual hand presses the needle into the cell; linked: over packets; source: of the
        force."""
        far_end = {"teleoperation_follower": LINK} if linked else {}
        with tempfile.TemporaryDirectory() as folder:
            motion = os.path.join(folder, "motion.csv")
            write_motion(motion)
            self.open({"operator": parameters("operator", motion=motion, start_delay=START_DELAY), **far_end,
                       "haptic_bridge": parameters("haptic_bridge", force_source=source, **(LINK if linked else {})),
                       "injection_controller": parameters("injection_controller", injector="injector" in more,
                                                           force_source=source),
                       "micromanipulator": RIG, "cell_simulator": self.cell("coarse_oocyte"),
                       **{node: parameters(node) for node in more}}, ["/operator/phase"], PACKETS)

    def by_itself(self):
        """A session in which the controller injects, with a pulse that would take half a minute."""
        goal = {"depth": 15e-6, "margin": 0.5e-6, "pulse": {"pressure": 20e3, "duration": 30.0}}
        controller = parameters("injection_controller", mode="automatic", goal=goal, detection={"noise_samples": 50},
                                motion={"stab_speed": 20e-6, "indent_speed": 20e-6, "approach_speed": 40e-6})
        self.open({"injection_controller": controller, "micromanipulator": RIG, "injector": INJECT,
                   "cell_simulator": self.cell("injected_oocyte")}, ["/controller/injection_state"])

    @staticmethod
    def cell(name):
        return parameters("cell_simulator", scene=str(PACKAGE / f"test/chain/{name}.yaml"), model="live", needle="true")

    def in_phase(self, phase, ticks):
        """Some ticks into a phase of the hand's motion."""
        self.session.until(lambda: self.session.says("/operator/phase", "string", phase), phase)
        late = self.session.chain.now - self.session.chain.seen["/operator/phase"].header.stamp
        self.assertLessEqual(late.to_sec(), 2 * TICK, f"{phase} began before the session was ready")
        self.session.chain.run(ticks)

    def in_state(self, state, ticks):
        """Some ticks into a state of the injection."""
        self.session.until(lambda: self.session.says("/controller/injection_state", "state", state), state)
        self.session.chain.run(ticks)

    def kill(self, node, ticks=240):
        time = self.session.kill(node, self.FREEZES)
        self.session.chain.run(ticks)
        return time

    def check_needle(self, killed, timeout, topic=NEEDLE, after=AFTER):
        """It moved until the kill, and rests for good within the time-out."""
        self.session.catch_up(topic)
        times, places = self.session.series(topic, position)
        self.assertGreater(times[-1], killed + timeout + 0.1)
        before = np.abs(times - killed) < 0.02
        self.assertGreater(np.ptp(places[before & (times <= killed)][:, 2]), 50e-9, "it moved")
        late = times[np.abs(places - places[-1]).max(axis=1) > STILL]
        self.assertLessEqual(late.max() - killed, timeout + after + SLACK)

    def check_force(self, killed, timeout, earlier=0.0, felt=True):
        """It is zero for good as soon as the time-out has elapsed; `earlier` (s): that it may be before."""
        self.session.catch_up(FELT)
        times, forces = self.session.series(FELT, force)
        self.assertGreater(times[-1], killed + timeout + 0.1)
        some = times[np.abs(forces).max(axis=1) > 0]
        if not felt:
            return self.assertTrue(len(some) == 0)
        self.assertGreater(len(some), 0)
        self.assertLessEqual(some.max() - killed, timeout + SLACK)
        self.assertGreaterEqual(some.max() - killed, timeout - earlier - SLACK)

    def check_goes_on(self, killed):
        """The needle follows the hand, and it feels the cell, as if nothing had been."""
        for topic in (NEEDLE, FELT):
            self.session.catch_up(topic)
        times, places = self.session.series(NEEDLE, position)
        self.assertGreater(np.ptp(places[times > killed + 0.06][:, 2]), 0.5e-6)
        times, forces = self.session.series(FELT, force)
        self.assertGreater(np.abs(forces[times > killed + 0.06]).max(axis=1).min(), 0)

