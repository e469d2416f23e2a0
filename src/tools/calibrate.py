#!/usr/bin/python3
"""Calibrates the camera against the manipulator, or only the tip's place after a pipette change; brings the tip to a pixel, or
into focus: doc/guide/calibrate.md."""

import argparse
import sys

import actionlib
import rospy
from cell_microinjection.msg import (CalibrateAction, CalibrateGoal, FindFocusAction, FindFocusGoal, FindTouchAction,
                                     FindTouchGoal, GoToPixelAction, GoToPixelGoal)
from std_srvs.srv import Trigger

MICROMETRE = 1e-6  # m
SERVER_TIMEOUT = 10  # s


def ask(service):
    """Calls a service of the node. @returns its success"""
    name = f"/calibration/{service}"
    rospy.wait_for_service(name, SERVER_TIMEOUT)
    answer = rospy.ServiceProxy(name, Trigger)()
    print(answer.message)
    return answer.success


def run(name, action, goal, describe):
    """Runs an action to its end, with its progress in one line; Ctrl-C cancels it. @returns its success"""
    client = actionlib.SimpleActionClient(name, action)
    if not client.wait_for_server(rospy.Duration(SERVER_TIMEOUT)):
        raise rospy.ROSException(f"no action {name}: start a session with camera:=..., such as sim or device")
    rospy.on_shutdown(client.cancel_all_goals)
    client.send_goal(goal, feedback_cb=lambda feedback: print(f"\r{describe(feedback)}  ", end="", flush=True))
    client.wait_for_result()
    result = client.get_result()
    print(f"\n{result.message if result else 'cancelled'}")
    return result is not None and result.success


def calibrate(field_x, field_z):
    return run("/calibration/calibrate", CalibrateAction,
               CalibrateGoal(field_x=MICROMETRE * field_x, field_z=MICROMETRE * field_z),
               lambda at: f"point {at.waypoint} of {at.waypoints}, tip seen at {at.seen}")


def go_to(x, y):
    return run("/visual_servo/go_to_pixel", GoToPixelAction, GoToPixelGoal(x=x, y=y),
               lambda at: f"{at.distance:.1f} px away" + (f", {at.waits_for}" if at.waits_for else ""))


def focus():
    return run("/focus/find", FindFocusAction, FindFocusGoal(), lambda at: f"plane {at.plane} of {at.planes}")


def touch():
    return run("/touch/find", FindTouchAction, FindTouchGoal(),
               lambda at: f"{at.travel / MICROMETRE:.1f} um down, outline displaced by {at.displacement:.1f} px")


def main():
    parser = argparse.ArgumentParser(description="Calibrates the microscope's camera against the manipulator.")
    parser.add_argument("--field-x", type=float, default=0, metavar="UM", help="extent of the pattern across the needle; "
                        "0: that of config/calibration.yaml")
    parser.add_argument("--field-z", type=float, default=0, metavar="UM", help="extent along the needle")
    parser.add_argument("--rezero", action="store_true", help="keep the axes; only the tip's place is new")
    parser.add_argument("--undo", action="store_true", help="take back this session's last calibration or re-zero")
    parser.add_argument("--go-to", type=float, nargs=2, metavar=("X", "Y"), help="bring the tip to this pixel")
    parser.add_argument("--focus", action="store_true", help="bring the tip into focus")
    parser.add_argument("--touch", action="store_true", help="lower the needle to the cell, by the image")
    arguments = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("calibrate", anonymous=True)
    try:
        if arguments.focus:
            succeeded = focus()
        elif arguments.touch:
            succeeded = touch()
        elif arguments.go_to:
            succeeded = go_to(*arguments.go_to)
        elif arguments.rezero or arguments.undo:
            succeeded = ask("rezero" if arguments.rezero else "undo")
        else:
            succeeded = calibrate(arguments.field_x, arguments.field_z)
    except (rospy.ROSException, rospy.ServiceException) as error:
        print(f"calibrate: {error}", file=sys.stderr)
        return 1
    return 0 if succeeded else 1


if __name__ == "__main__":
    sys.exit(main())
