#!/usr/bin/python3
"""Calibrates the camera against the manipulator, or only the tip's place after a pipette change: doc/guide/calibrate.md."""

import argparse
import sys

import actionlib
import rospy
from cell_microinjection.msg import CalibrateAction, CalibrateGoal
from std_srvs.srv import Trigger

MICROMETRE = 1e-6  # m
SERVER_TIMEOUT = 10  # s


def rezero():
    rospy.wait_for_service("/calibration/rezero", SERVER_TIMEOUT)
    answer = rospy.ServiceProxy("/calibration/rezero", Trigger)()
    print(answer.message)
    return answer.success


def calibrate(field_x, field_z):
    client = actionlib.SimpleActionClient("/calibration/calibrate", CalibrateAction)
    if not client.wait_for_server(rospy.Duration(SERVER_TIMEOUT)):
        raise rospy.ROSException("no node calibration: start a session with camera:=sim or camera:=device")

    def show(feedback):
        print(f"\rpoint {feedback.waypoint} of {feedback.waypoints}, tip seen at {feedback.seen}", end="", flush=True)

    rospy.on_shutdown(client.cancel_all_goals)
    client.send_goal(CalibrateGoal(field_x=MICROMETRE * field_x, field_z=MICROMETRE * field_z), feedback_cb=show)
    client.wait_for_result()
    result = client.get_result()
    print(f"\n{result.message}")
    return result.success


def main():
    parser = argparse.ArgumentParser(description="Calibrates the microscope's camera against the manipulator.")
    parser.add_argument("--field-x", type=float, default=0, metavar="UM", help="extent of the pattern across the needle; "
                        "0: that of config/calibration.yaml")
    parser.add_argument("--field-z", type=float, default=0, metavar="UM", help="extent along the needle")
    parser.add_argument("--rezero", action="store_true", help="keep the axes; only the tip's place is new")
    arguments = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("calibrate", anonymous=True)
    try:
        succeeded = rezero() if arguments.rezero else calibrate(arguments.field_x, arguments.field_z)
    except (rospy.ROSException, rospy.ServiceException) as error:
        print(f"calibrate: {error}", file=sys.stderr)
        return 1
    return 0 if succeeded else 1


if __name__ == "__main__":
    sys.exit(main())
