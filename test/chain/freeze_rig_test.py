#!/usr/bin/python3
"""The driver of a real rig is frozen (SIGSTOP) or killed while the needle indents a cell: its stop guard stops the device.
Live, with an emulated rig that follows set-points and one that only moves, as a program of its own, which tells where the
device truly is. The guards of all rigs are in test/hardware/devices."""

import os
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
import yaml
from cell_microinjection.msg import InjectionStatus, OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped

from case import case
from killable_nodes import PACKAGE, PROGRAMS, KillableNodes, parameters
from live_chain import Master, until

SPEED = 20e-6  # m/s, of all motion
SILENCE = 0.2 + 0.04  # s, until the guard says stop, and its tick
STOP = 0.05  # s, from the stop to standstill, wire included; far more than any of them needs
READING = 0.02  # s between two readings of the device
AT_REST = 75  # readings in a row: for longer than a machine stalls
HELD_UP = 0.3  # s, that guard, device and this test may be kept from the processor beside what this test sees of it
START = 48e-6  # m, 20 um above the cell: an approach of 1 s, which a machine that stalls does not miss
CASES = (("zaber", "7.40", signal.SIGSTOP), ("mp285", None, signal.SIGSTOP), ("zaber", "7.40", signal.SIGKILL))
CELL = {"scene": str(PACKAGE / "config/cells/mouse_oocyte_injection.yaml"), "families": str(PACKAGE / "config/families")}


class Emulator:
    def __init__(self, rig, firmware, folder):
        self.link, self._file = f"{folder}/{rig}", f"{folder}/positions.csv"
        version = ["--firmware", firmware] if firmware else []
        self._process = subprocess.Popen([PROGRAMS / "emulate", rig, "--link", self.link, "--positions", self._file,
                                          *version])
        until(lambda: os.path.exists(self.link), "a terminal")

    def place(self):
        """(time in s, place in m) of the last row."""
        with open(self._file, "rb") as file:
            file.seek(0, os.SEEK_END)
            file.seek(max(0, file.tell() - 1000))
            rows = file.read().decode().split("\n")
        values = [float(value) for value in rows[-2].split(",")]
        return values[0], np.array(values[1:])

    def close(self):
        self._process.kill()
        self._process.wait()


class Session:
    """An automatic injection with this rig."""

    def __init__(self, rig, emulator):
        device = yaml.safe_load((PACKAGE / f"config/rigs/{rig}.yaml").read_text())
        device["port"]["path"] = emulator.link
        goal = {"depth": 15e-6, "margin": 0.5e-6, "pulse": {"pressure": 20e3, "duration": 30.0}}
        motion = {f"{name}_speed": SPEED for name in ("stab", "indent", "approach", "retract")}
        controller = parameters("injection_controller", mode="automatic", goal=goal, detection={"noise_samples": 50},
                                motion=motion, speed_limit=SPEED, auto_enable=False, input_timeout=1.0)
        self.seen, self._has_moved = {}, False
        self._subscribers = [rospy.Subscriber(topic, kind, self._receive, topic)
                             for topic, kind in (("/controller/injection_state", InjectionStatus),
                                                 ("/controller/operating_state", OperatingState),
                                                 ("/needle/operating_state", OperatingState),
                                                 ("/needle/measured_cp", PoseStamped))]
        self.nodes = KillableNodes({
            "micromanipulator": parameters("micromanipulator", rig=rig, device=device, allow_network=True,
                                           command_timeout=1.0),
            "injector": parameters("injector"), "injection_controller": controller,
            "cell_simulator": parameters("cell_simulator", needle_timeout=1.0, **CELL)})
        self._move = rospy.Publisher("/needle/move_cp", PoseStamped, queue_size=1)
        self.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=1)
        self._rig_commands = rospy.Publisher("/needle/state_command", StringStamped, queue_size=1)
        self.process = self.nodes.process("micromanipulator")

    def _receive(self, message, topic):
        self.seen[topic] = message
        self._has_moved = self._has_moved or topic == "/needle/operating_state" and message.is_busy

    def begin(self):
        """The needle goes above the cell, and the injection begins."""
        until(lambda: self.rig() == "ENABLED", "a rig that is ready")
        until(lambda: self._move.get_num_connections() and self.commands.get_num_connections(), "connections")
        message = PoseStamped()
        message.header.stamp = rospy.Time.now()
        message.pose.position.z, message.pose.orientation.w = START, 1
        self._has_moved = False
        self._move.publish(message)
        until(self.is_at_start, "a needle above the cell")
        # Its pose may come before the state that belongs to it: the injection would begin beside the move.
        until(lambda: self._has_moved and not self.seen["/needle/operating_state"].is_busy, "a needle that rests")
        self.commands.publish(StringStamped(string="enable"))

    def rig(self):
        return self.seen["/needle/operating_state"].state if "/needle/operating_state" in self.seen else ""

    def is_at_start(self):
        message = self.seen.get("/needle/measured_cp")
        return message and not message.header.stamp.is_zero() and abs(message.pose.position.z - START) < 0.2e-6

    def state(self):
        status = self.seen.get("/controller/injection_state")
        return status.state if status else ""

    def goes_on(self):
        """A machine that stands still for longer than an answer may take has its rig stopped and the injection paused. An
        operator then lets them go on."""
        controller = self.seen.get("/controller/operating_state")
        if controller and controller.state == "PAUSED":
            self._rig_commands.publish(StringStamped(string="enable"))
            self.commands.publish(StringStamped(string="resume"))
        return True

    def restart(self):
        """The driver, which is dead."""
        self.process.wait()
        self.seen.pop("/needle/operating_state", None)
        self.nodes.start("micromanipulator")
        self.process = self.nodes.process("micromanipulator")

    def close(self):
        self.process.send_signal(signal.SIGCONT)
        self.nodes.stop()
        self.nodes.forget()
        for end in (*self._subscribers, self._move, self.commands, self._rig_commands):
            end.unregister()


class Stalls:
    """A loop like the guard's on each core, to know how long this machine kept such loops from the processor: one core
    may stand still while the others go on."""

    def __init__(self):
        self._lost, self._ended = {core: 0.0 for core in os.sched_getaffinity(0)}, threading.Event()
        self._threads = [threading.Thread(target=self._watch, args=(core,), daemon=True) for core in self._lost]
        for thread in self._threads:
            thread.start()

    def _watch(self, core):
        os.sched_setaffinity(0, {core})  # of this thread alone
        while not self._ended.is_set():
            before = time.monotonic()
            time.sleep(READING)
            self._lost[core] += max(0.0, time.monotonic() - before - 2 * READING)

    def end(self):
        """@returns s, of guard and device together at the most: each waits for one core."""
        self._ended.set()
        for thread in self._threads:
            thread.join()
        return 2 * max(self._lost.values())


class FreezeRigTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("freezer")

    @classmethod
    def tearDownClass(cls):
        cls.master.kill()

    def indents(self, session, emulator):
        until(lambda: session.goes_on() and session.state() == "indent", "a needle that indents")
        begun = emulator.place()[1]
        until(lambda: session.goes_on() and np.abs(emulator.place()[1] - begun).max() > 0.5e-6,
              "a needle that moves in the cell")

    def check_stops(self, session, emulator, fault):
        stalls, place, same = Stalls(), emulator.place(), 0
        session.process.send_signal(fault)
        frozen, last = place[1], place
        try:
            while same < AT_REST:
                time.sleep(READING)
                now = emulator.place()
                same = same + 1 if now[0] == last[0] else 0
                last = now
                self.assertLess(now[0] - place[0], 60, "it does not stop")
        finally:
            lost = stalls.end()
        moved = np.abs(last[1] - frozen).max()
        allowed = SPEED * (SILENCE + STOP + HELD_UP + lost)
        self.assertLess(moved, allowed, f"the device moved {moved} m after its driver had failed, allowed {allowed} m")
        return last

    def check_rests_when_it_is_back(self, session, emulator, stopped, fault):
        if fault == signal.SIGSTOP:
            session.process.send_signal(signal.SIGCONT)
        else:
            session.restart()
        until(lambda: session.rig() == "ENABLED", "a rig that is ready again")
        for _ in range(AT_REST):
            time.sleep(READING)
        self.assertLess(np.abs(emulator.place()[1] - stopped[1]).max(), 0.1e-6, "it went on by itself")

    def test_a_driver_that_is_frozen_or_dead(self):
        for rig, firmware, fault in CASES:
            with case(rig, fault.name), tempfile.TemporaryDirectory() as folder:
                emulator = Emulator(rig, firmware, folder)
                session = Session(rig, emulator)
                try:
                    session.begin()
                    self.indents(session, emulator)
                    stopped = self.check_stops(session, emulator, fault)
                    self.check_rests_when_it_is_back(session, emulator, stopped, fault)
                except AssertionError as error:
                    raise AssertionError(f"{error}; {session.nodes.report()}") from None
                finally:
                    session.close()
                    emulator.close()


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "freeze_rig", FreezeRigTest)
