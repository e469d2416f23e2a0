#!/usr/bin/python3
"""A node that commands the needle of a session that it knows nothing of: to 100 um above the cell, with each pose that
the needle tells."""

import rospy
from geometry_msgs.msg import PoseStamped

from messages import pose

if __name__ == "__main__":
    rospy.init_node("stranger")
    publisher = rospy.Publisher("/needle/servo_cp", PoseStamped, queue_size=1)

    def command(told):
        message = pose(0, 0, 100e-6)
        message.header.stamp = told.header.stamp
        publisher.publish(message)

    rospy.Subscriber("/needle/measured_cp", PoseStamped, command, queue_size=1)
    rospy.spin()
