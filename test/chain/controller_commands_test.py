#!/usr/bin/python3
"""A command without a stamp whose publisher latches comes again to a controller that starts anew: it moves nothing then.
Said again it is obeyed, as those of CRTK clients are."""

import unittest

import rospy
import rostest
from cell_microinjection.msg import InjectionStatus, OperatingState, StringStamped
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped

from killable_nodes import KillableNodes, parameters
from messages import pose, wrench
from participant import Participant

START = 60e-6  # m


class ControllerCommandsTest(unittest.TestCase):
    def setUp(self):
        self.commands = rospy.Publisher("/controller/state_command", StringStamped, queue_size=10, latch=True)
        self.nodes, self.world = None, None
        self.said = set()  # by all reports, because only one has what has just been refused
        self.diagnostics = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: self.said.update(
            status.message for status in message.status))

    def tearDown(self):
        self.nodes.stop()
        self.diagnostics.unregister()
        self.world.unsubscribe()
        self.nodes.forget()
        self.world.close()
        self.commands.unregister()

    def say(self, word):
        self.commands.publish(StringStamped(string=word))

    def begin(self):
        """The controller starts, ENABLED, with a needle and a cell that it does not touch."""
        controller = parameters("injection_controller", mode="semi_automatic", injector=False, auto_enable=True,
                                start_when_enabled=False, diagnostic_period=0.1)
        self.nodes = KillableNodes({"lockstep_clock": {}, "injection_controller": controller},
                                   [rospy.get_name(), "/injection_controller"])
        self.world = Participant({"/needle/measured_cp": PoseStamped, "/cell/predicted_cf": WrenchStamped},
                                 {"/needle/servo_cp": PoseStamped, "/controller/injection_state": InjectionStatus,
                                  "/controller/operating_state": OperatingState})
        self.run_until(lambda: "/controller/injection_state" in self.world.seen, "a state")

    def good(self):
        setpoint = self.world.seen.get("/needle/servo_cp") or pose(0, 0, START)
        return {"/needle/measured_cp": pose(0, 0, setpoint.pose.position.z), "/cell/predicted_cf": wrench(0, 0, 0)}

    def run_until(self, condition, what):
        for _ in range(5000):
            if condition():
                return
            self.world.tick(self.good())
        self.fail(f"{what}: not within 5 s; {self.world.seen}; {self.world.diagnostics}")

    def state(self):
        return self.world.seen["/controller/injection_state"].state

    def operating_state(self):
        return self.world.seen["/controller/operating_state"].state

    def until_refused(self, word):
        said = f"state command {word} refused: it has no stamp and its publisher latches"
        self.run_until(lambda: any(said in message for message in list(self.said)), said)

    def check_is_obeyed_when_said_again(self, word):
        self.say(word)
        self.begin()
        self.until_refused(word)
        self.assertEqual((self.state(), self.operating_state()), ("idle", "ENABLED"))
        self.say("approach")
        self.run_until(lambda: self.state() == "approach", "what is said now is obeyed")
        self.say(word)
        self.run_until(lambda: self.world.seen["/controller/injection_state"].outcome == "preempted",
                       f"{word} that is said now is obeyed")

    def test_withdraw(self):
        self.check_is_obeyed_when_said_again("withdraw")

    def test_home(self):
        self.check_is_obeyed_when_said_again("home")

    def test_what_stops_is_obeyed_however_old_it_may_be(self):
        self.say("pause")
        self.begin()
        self.run_until(lambda: self.operating_state() == "PAUSED", "PAUSED")


if __name__ == "__main__":
    rospy.init_node("asker")
    rostest.rosrun("cell_microinjection", "controller_commands", ControllerCommandsTest)
