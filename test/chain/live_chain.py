"""The nodes of the chain live on a master of their own, with the test as the hand that drives the needle up and down."""

import math
import os
import signal
import subprocess
import sys
import threading

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy

from killable_nodes import PACKAGE, PATIENCE, RATE, KillableNodes, parameters, rig
from messages import pose, position
from processes import free_port

TIMEOUT = 3.0  # s, of all inputs: more than a machine stands still; who was stopped waits for a pause of the stream


def until(condition, what):
    for _ in range(100 * PATIENCE):
        if condition():
            return
        rospy.rostime.wallsleep(0.01)
    raise AssertionError(f"{what}: not within {PATIENCE} s")


class Master:
    """A ROS master of the test's own, before rospy.init_node. `port`: that of one before; none: a free one."""

    def __init__(self, port=None):
        self.port = port or free_port()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{self.port}"
        self._process = subprocess.Popen(["rosmaster", "--core", "-p", str(self.port)], stdout=subprocess.DEVNULL,
                                         stderr=subprocess.DEVNULL)
        until(rosgraph.is_master_online, "a master")

    def signal(self, number):
        self._process.send_signal(number)

    def kill(self):
        self._process.kill()
        self._process.wait()


def chain_parameters():
    """{node: parameters} of the chain with the cell of a family, which costs little, and the simulated rig."""
    patient = {key: TIMEOUT for key in ("hand", "needle", "predicted", "measured", "controller")}
    cell = {"scene": str(PACKAGE / "config/cells/mouse_oocyte_pipette.yaml"), "families": str(PACKAGE / "config/families")}
    return {
        "haptic_bridge": parameters("haptic_bridge", timeouts=patient),
        "injection_controller": parameters("injection_controller", auto_enable=True, input_timeout=TIMEOUT),
        "micromanipulator": {**rig(), "command_timeout": TIMEOUT},
        "injector": parameters("injector"),
        "cell_simulator": parameters("cell_simulator", state_rate=5, needle="true", needle_timeout=TIMEOUT, **cell),
        "force_sensor": parameters("force_sensor", input_timeout=TIMEOUT)}


class Hand:
    """Goes up and down by itself, so that a needle that follows it never rests; its clutch is released."""

    SPEED, STROKE = 5e-3, 2e-3  # m/s, m

    def __init__(self):
        self.way = 0.0  # m, so far
        self._publisher = rospy.Publisher("/haptic/measured_cp", PoseStamped, queue_size=1)
        self._clutch = rospy.Publisher("/haptic/clutch", Joy, queue_size=1)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def end(self):
        self._ended.set()
        self._thread.join()

    def _run(self):
        z, step = 0.0, -self.SPEED / RATE
        while not self._ended.is_set() and not rospy.is_shutdown():
            z += step
            self.way += abs(step)
            step = math.copysign(step, -z) if abs(z) > self.STROKE else step
            message = pose(0, 0, z, "haptic")
            message.header.stamp = rospy.Time.now()
            self._publisher.publish(message)
            self._clutch.publish(Joy(header=message.header, buttons=[0]))
            rospy.rostime.wallsleep(1 / RATE)


class HandProcess:
    """A Hand that is a process of its own, so that it may be killed and frozen. It takes the force, too: the bridge leads no
    needle without a device that does. `enter`: a command that runs another one in its place, as on another host;
    `environment`: variables instead of those of the test."""

    enter, environment = (), {}

    def __init__(self):
        self._start()

    def _start(self, clock=0.0):
        code = (f"import rospy; now = rospy.Time.now; rospy.Time.now = lambda: now() + rospy.Duration({clock});"
                "from geometry_msgs.msg import WrenchStamped; from live_chain import Hand;"
                "rospy.init_node('hand', anonymous=True); rospy.Subscriber('/haptic/servo_cf', WrenchStamped, lambda _: None);"
                "Hand(); rospy.spin()")
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), **self.environment}
        self._process = subprocess.Popen([*self.enter, sys.executable, "-c", code], env=environment, stdin=subprocess.DEVNULL)

    def fail(self, how):
        self._process.send_signal(signal.SIGKILL if how == "killed" else signal.SIGSTOP)

    def recover(self, how):
        if how == "frozen":
            return self._process.send_signal(signal.SIGCONT)
        self._process.wait()
        self._start()

    def set_clock(self, ahead):
        """Starts anew with a clock that is so many s ahead."""
        self.end()
        self._start(ahead)

    def end(self):
        self._process.kill()
        self._process.wait()


class LiveChain:
    """`changes`: {node: parameters} beside or instead of those of chain_parameters(); `outputs`: {node: descriptor of its
    standard output and error}; `hand`: what drives the needle, a class like Hand; `enter`: see KillableNodes."""

    def __init__(self, changes=None, outputs=None, hand=Hand, enter=None):
        self.newest, self.counts, self.diagnostics = {}, {}, {}
        self._subscribers = [rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)]
        self.follow("/needle/measured_cp", PoseStamped)
        self.follow("/haptic/servo_cf", WrenchStamped)
        self._frame = subprocess.Popen(
            ["rosrun", "tf2_ros", "static_transform_publisher", "0", "0", "0.04", "0", "0", "0", "needle_tip",
             "force_sensor", "__name:=force_sensor_frame"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.nodes = KillableNodes({**chain_parameters(), **(changes or {})}, outputs=outputs or {}, enter=enter)
        self.hand = hand()

    def follow(self, topic, kind):
        """Keeps the newest message and counts all."""
        def receive(message):
            self.newest[topic] = message
            self.counts[topic] = self.counts.get(topic, 0) + 1
        self.counts[topic] = 0
        self._subscribers.append(rospy.Subscriber(topic, kind, receive))

    def _on_diagnostics(self, message):
        for status in message.status:
            self.diagnostics[status.name] = status

    def needle(self):
        return position(self.newest["/needle/measured_cp"])

    def check_follows(self):
        """The needle follows the hand for half a stroke and more."""
        until(lambda: "/needle/measured_cp" in self.newest, "a pose of the needle")
        begin = self.needle()[2]
        try:
            until(lambda: abs(self.needle()[2] - begin) > 0.5e-6, "a needle that follows the hand")
        except AssertionError as error:
            loops = {name: status.message for name, status in list(self.diagnostics.items()) if status.level}
            raise AssertionError(f"{error}; {loops}; {self.nodes.report()}") from None

    def end_processes(self):
        self.hand.end()
        self.nodes.stop()
        self._frame.kill()
        self._frame.wait()

    def close(self):
        self.end_processes()
        for subscriber in self._subscribers:
            subscriber.unregister()
        self.nodes.forget()
