"""The connections between nodes: they come and go at their own time, and are waited for while the session's stands."""

import time
import xmlrpc.client

import rosgraph
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


def missing_links():
    """(topic, publisher, subscriber) of each connection that the master tells the nodes of and that is not there yet.

    The publisher is asked: from the moment that it knows of a subscriber no message is lost."""
    master = rosgraph.Master(rospy.get_name())
    publishers, subscribers, _ = master.getSystemState()
    subscribers = dict(subscribers)
    expected = {(topic, name, subscriber) for topic, names in publishers for name in names
                for subscriber in subscribers.get(topic, ()) if subscriber != name}
    there = set()
    for name in {name for _, name, _ in expected}:
        there |= {(topic, name, end) for topic, direction, end in _connections(master.lookupNode(name))
                  if direction == "o"}
    return expected - there


def await_links(patience):
    """Until nobody who has registered misses anybody. @param patience  s of wall time after which it hangs"""
    _await(missing_links, patience, "no connection")


def await_publishers(topic, names, patience):
    """Until these nodes publish it: nodes that take no part in the lock step, and so are not waited for there."""
    def missing():
        publishers, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
        return set(names) - set(dict(publishers).get(topic, ()))
    _await(missing, patience, f"no publisher of {topic}")


def await_end_of_links(addresses, patience):
    """Until this node has read the last message of publishers that are dead, and their connections are gone: a new one
    at such an address would pass for connected."""
    def remaining():
        return {link for link in _connections(rospy.get_node_uri()) if link[2] in addresses}
    _await(remaining, patience, "a connection to a dead node")


def _await(missing, patience, what):
    end = time.monotonic() + patience
    while left := missing():
        if time.monotonic() > end:
            raise AssertionError(f"{what}: {sorted(left)}")
        rospy.rostime.wallsleep(0.05)
