#!/usr/bin/python3
"""A node hears a publisher that did not answer when it was first asked to connect: roscpp asks once."""

import unittest

import rospy
import rostest
from rospy.impl.masterslave import ROSHandler
from sensor_msgs.msg import FluidPressure

from cell_microinjection.msg import InjectorState
from killable_nodes import KillableNodes, parameters
from live_chain import until

TOPIC = "/injector/set_balance"
BALANCE = 700.0  # Pa


class DeafOnce:
    """In place of this node's requestTopic: the first subscriber of TOPIC gets an error."""

    def __init__(self):
        self.refused = 0
        self._answer = ROSHandler.requestTopic
        ROSHandler.requestTopic = lambda handler, *request: self._request(handler, *request)

    def _request(self, handler, caller, topic, protocols):
        if topic == TOPIC and self.refused == 0:
            self.refused = 1
            return 0, "busy", 0
        return self._answer(handler, caller, topic, protocols)


class LostPublisherTest(unittest.TestCase):
    def test_it_is_found_again(self):
        deaf = DeafOnce()
        publisher = rospy.Publisher(TOPIC, FluidPressure, queue_size=1)
        states = []
        rospy.Subscriber("/injector/state", InjectorState, states.append)
        nodes = KillableNodes({"injector": parameters("injector")})
        self.addCleanup(nodes.stop)
        until(lambda: states, "a state")
        until(lambda: deaf.refused, "a request")
        self.assertGreater(abs(states[-1].pressure - BALANCE), 100)

        def has_heard():
            message = FluidPressure(fluid_pressure=BALANCE)
            message.header.stamp = rospy.Time.now()
            publisher.publish(message)
            return abs(states[-1].pressure - BALANCE) < 1
        until(has_heard, "a balance pressure that was published")


if __name__ == "__main__":
    rospy.init_node("late")
    rostest.rosrun("cell_microinjection", "lost_publisher", LostPublisherTest)
