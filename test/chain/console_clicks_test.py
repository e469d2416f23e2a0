#!/usr/bin/python3
"""Mouse and keyboard at the operator's console while a service that it has called hangs. What the buttons do is tested in
test/rviz/console_clicks_test.cpp."""

import threading
import unittest

import rospy
import rostest
from cell_microinjection.msg import InjectorState
from sensor_msgs.msg import FluidPressure
from std_srvs.srv import Trigger, TriggerResponse

import console_eye
from console_user import START_PATIENCE, ConsoleUser
from live_chain import Master
from shown_controller import ShownController


class ShownInjector:
    """The messages and the service of an injector. A reset takes until it is `released`."""

    def __init__(self):
        self.balances, self.resets, self.released = [], [], threading.Event()
        state = rospy.Publisher("/injector/state", InjectorState, queue_size=1)
        listener = rospy.Subscriber("/injector/set_balance", FluidPressure,
                                    lambda message: self.balances.append(message.fluid_pressure))
        service = rospy.Service("/injector/reset", Trigger, self._reset)
        timer = rospy.Timer(rospy.Duration(0.1), lambda _: state.publish(InjectorState()))
        self._ends = [timer.shutdown, listener.unregister, service.shutdown]

    def _reset(self, _):
        self.resets.append(True)
        self.released.wait()
        return TriggerResponse(success=True)

    def close(self):
        self.released.set()
        while self._ends:
            self._ends.pop(0)()


class ConsoleClicksTest(ConsoleUser, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        rospy.init_node("injection_controller")  # which the .test names it, too: the console sends nothing to others
        rospy.set_param("/injector/balance", 545)
        cls.controller = ShownController(mode="automatic", force_limit="2e-5", depth_limit="60 um")
        cls.open_console()

    @classmethod
    def tearDownClass(cls):
        cls.controller.close()
        cls.close_console()
        cls.master.kill()

    def injector_buttons(self, count):
        """The injector's buttons, of which so many are offered."""
        def check():
            console = self.look()
            rows = console_eye.rows_of_offered(self.picture, 1) if console else []
            places = [place for row in rows for place in row if place[0] > console.stop_right]
            return (places,) if len(places) == count else None
        return self.until(check, f"{count} offered buttons of the injector")[0]

    def test_the_console_works_while_a_service_hangs(self):
        self.controller.status.guard_force = 18e-6  # 90 % of 2e-5, which ROS has as text
        self.shows(lambda seen: seen.offered["Enable"] and seen.guards == {"Force": "yellow", "Depth": "empty"},
                   "Enable, and a force near its limit", START_PATIENCE)
        injector = ShownInjector()
        self.addCleanup(injector.close)
        set_button, reset_button = self.injector_buttons(2)
        self.click(reset_button)
        self.until(lambda: injector.resets, "a reset")
        self.assertEqual(self.injector_buttons(1), [set_button])
        # A number is typed without Enter, and the space bar stops while its field has the focus.
        x, y = set_button
        self.click((x - 80, y))
        self.do("key", "ctrl+a")
        self.do("type", "605")
        self.injector_buttons(1)
        self.click(set_button)
        self.until(lambda: injector.balances, "a balance pressure")
        self.assertEqual(injector.balances, [605])
        self.press("Enable")
        self.until(lambda: self.controller.state == "ENABLED", "an enabled controller")
        self.shows(lambda seen: not seen.offered["Enable"], "an enabled controller")
        self.click((x - 80, y))
        self.do("key", "space")
        self.until(lambda: self.controller.state == "PAUSED", "a controller that is stopped")
        self.assertEqual(self.sent, ["enable", "pause"])
        injector.released.set()
        self.injector_buttons(2)
        self.assertEqual(len(injector.resets), 1)


if __name__ == "__main__":
    rostest.rosrun("cell_microinjection", "console_clicks", ConsoleClicksTest)
