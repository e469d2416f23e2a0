"""The connections between nodes, which come and go at their own time."""

import time
import xmlrpc.client

import rospy
from rospy.impl.registration import RegManager


def _publisher_update(self, topic, addresses):
    """In place of rospy's own, which takes the newest list of a topic's publishers and drops those that wait before it:
    the master's reply to a new subscriber may come after the list with a publisher that registered since, which was
    then lost for good. No list ends a connection, so the publishers of all that wait are taken."""
    with self.cond:
        waiting = [address for name, listed in self.updates if name == topic for address in listed]
        self.updates.append((topic, list(dict.fromkeys([*waiting, *addresses]))))
        self.cond.notify_all()


RegManager.publisher_update = _publisher_update


def _connections(uri):
    """getBusInfo of a node: (topic, direction, the other end: a publisher's address or a subscriber's name) of each."""
    try:
        info = xmlrpc.client.ServerProxy(uri).getBusInfo(rospy.get_name())[2]
    except OSError:  # it has ended
        return set()
    return {(topic, direction, end) for _, end, direction, _, topic, *_ in info}


def await_end_of_links(addresses, patience):
    """Until this node has read the last message of publishers that are dead, and their connections are gone: a new one
    at such an address would pass for connected."""
    end = time.monotonic() + patience
    while left := {link for link in _connections(rospy.get_node_uri()) if link[2] in addresses}:
        if time.monotonic() > end:
            raise AssertionError(f"a connection to a dead node: {sorted(left)}")
        rospy.rostime.wallsleep(0.05)
