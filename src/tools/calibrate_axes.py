#!/usr/bin/python3
"""Finds device_axes of a haptic device from three motions of the hand: doc/guide/your_haptic_device.md."""

import argparse
import math
import sys
import time

import rospy
from cell_microinjection.srv import CalibrateAxes, CalibrateAxesRequest as Request
from diagnostic_msgs.msg import DiagnosticArray

SERVICE = "/haptic_bridge/calibrate_axes"
SERVER_TIMEOUT = 10  # s
WRITING = 0.5        # s of wall time, after which the node knows whether the file was written
PATIENCE = 10        # s of wall time for its report


class AxesError(Exception):
    """What went wrong, for the user."""


class WrittenFile:
    """What the node reports of the file that it writes."""

    def __init__(self):
        self._file, self._at = "", 0.0
        self._subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)

    def _on_diagnostics(self, message):
        for status in message.status:
            if status.name == "haptic_bridge: loop":
                values = {pair.key: pair.value for pair in status.values}
                self._file, self._at = values.get("file of the axes", ""), time.monotonic()

    def require(self, path):
        """@raises AxesError unless the file is written"""
        began = time.monotonic()
        while self._at < began + WRITING:
            if time.monotonic() > began + PATIENCE or rospy.is_shutdown():
                raise AxesError(f"the node does not report whether it has written {path}")
            time.sleep(0.05)
        if self._file != path:
            raise AxesError(f"the axes apply, but are not in {path}: {self._file}")


def step(action):
    return rospy.ServiceProxy(SERVICE, CalibrateAxes)(action)


def require(answer):
    if not answer.success:
        raise AxesError(answer.message)
    return answer


def report(answer, written):
    print(f"device_axes: {answer.device_axes}")
    written.require(answer.file)
    print(f"the next session takes them with set:=overrides={answer.file}")


def residual(answer):
    return (f"motions within {math.degrees(answer.angle_to_axis):.1f} degrees of the axes, "
            f"within {math.degrees(answer.angle_to_square):.1f} degrees of a right angle")


def calibrate(written):
    answer = require(step(Request.BEGIN))
    try:
        while answer.next:
            print(answer.message if answer.success else f"refused: {answer.message}; move the hand {answer.next} again")
            wish = input("Enter when it is there, u to undo, q to quit: ").strip()
            if wish == "q":
                raise KeyboardInterrupt
            answer = step(Request.UNDO if wish == "u" else Request.MOTION)
            if answer.success and wish != "u":
                print(residual(answer))
    finally:  # else the needle would stay held; nothing after the third motion
        step(Request.STOP)
    if not answer.success:
        raise AxesError(answer.message)
    report(answer, written)


def undo(written):
    step(Request.STOP)
    report(require(step(Request.UNDO)), written)


def main():
    parser = argparse.ArgumentParser(description="Finds the axes of a haptic device: move the hand right, away, up.")
    parser.add_argument("--undo", action="store_true", help="the axes before the last calibration of this session")
    arguments = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("calibrate_axes", anonymous=True, disable_signals=True)
    try:
        rospy.wait_for_service(SERVICE, SERVER_TIMEOUT)
        written = WrittenFile()
        (undo if arguments.undo else calibrate)(written)
    except (KeyboardInterrupt, EOFError):
        print("\nended without a change")
        return 1
    except (AxesError, rospy.ROSException, rospy.ServiceException) as error:
        print(f"calibrate_axes: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
