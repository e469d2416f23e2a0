"""Short ways to the messages of the chain. Metres and newtons."""

import numpy as np
from geometry_msgs.msg import PoseStamped, TransformStamped, WrenchStamped


def pose(x, y, z, frame="world"):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
    message.pose.orientation.w = 1
    return message


def transform(x, y, z, frame="world"):
    message = TransformStamped()
    message.header.frame_id = frame
    message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = x, y, z
    message.transform.rotation.w = 1
    return message


def wrench(x, y, z, frame="world"):
    message = WrenchStamped()
    message.header.frame_id = frame
    message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = x, y, z
    return message


def position(message):
    return np.array([message.pose.position.x, message.pose.position.y, message.pose.position.z])


def force(message):
    return np.array([message.wrench.force.x, message.wrench.force.y, message.wrench.force.z])
