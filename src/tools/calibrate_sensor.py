#!/usr/bin/python3
"""Tare and gain of the force sensor, step by step, from a terminal: doc/guide/calibrate.md."""

import argparse
import sys
import time

import rospy
from cell_microinjection.srv import CalibrateForce, CalibrateForceRequest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Vector3
from std_srvs.srv import Trigger

MICRONEWTON = 1e-6   # N
SERVER_TIMEOUT = 10  # s
PATIENCE = 30        # s of wall time for an average, whose time is the parameter averaging
BUSY = ("taring", "averaging under the known force")
ACTIONS = {"solve": CalibrateForceRequest.SOLVE, "undo": CalibrateForceRequest.UNDO, "clear": CalibrateForceRequest.CLEAR}


class SensorError(Exception):
    """What went wrong, for the user."""


class Outcome:
    """What the node reports of its last average."""

    def __init__(self):
        self._newest, self._at = {}, 0.0
        self._subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)

    def _on_diagnostics(self, message):
        for status in message.status:
            if status.name == "force_sensor: sensor":
                self._newest, self._at = {pair.key: pair.value for pair in status.values}, time.monotonic()

    def after(self, began):
        """The outcome of the average that began then. @raises SensorError"""
        end = time.monotonic() + PATIENCE
        while self._at < began or self._newest.get("tare and calibration") in BUSY:
            if time.monotonic() > end or rospy.is_shutdown():
                raise SensorError("the node reports no end of the average")
            time.sleep(0.05)
        return self._newest


def ask(name, kind, *request):
    """@raises SensorError with the node's reason"""
    rospy.wait_for_service(f"/force_sensor/{name}", SERVER_TIMEOUT)
    answer = rospy.ServiceProxy(f"/force_sensor/{name}", kind)(*request)
    if not answer.success:
        raise SensorError(answer.message)
    return answer


def average(outcome, name, kind, *request):
    ask(name, kind, *request)
    values = outcome.after(time.monotonic())
    if values["tare and calibration"].startswith("the average was aborted"):
        raise SensorError(values["tare and calibration"])
    print(values["tare and calibration"])
    if "calibration file" in values:
        print(f"file: {values['calibration file']}")


def act(step, forces):
    if step in ("tare", "point"):
        outcome = Outcome()
        if step == "tare":
            return average(outcome, "tare", Trigger)
        axial, lateral = (MICRONEWTON * force for force in (forces + [0.0])[:2])
        return average(outcome, "calibrate", CalibrateForce, CalibrateForceRequest.ADD, Vector3(lateral, 0, axial))
    answer = ask("calibrate", CalibrateForce, ACTIONS[step], Vector3())
    print(answer.message)
    if step == "solve":
        print(f"gain {[round(value, 5) for value in answer.gain]}, residual {answer.residual / MICRONEWTON:.3g} uN rms")
    return None


def main():
    parser = argparse.ArgumentParser(description="Tare and gain of the force sensor, step by step.")
    parser.add_argument("step", choices=("tare", "point", "solve", "undo", "clear"), help="tare: the present reading is zero; "
                        "point: a known force acts now; solve: the gain that fits the points; undo: takes back the last "
                        "step; clear: no points, gain 1")
    parser.add_argument("force", type=float, nargs="*", help="of a point: known force along the pipette, and across it (uN)")
    arguments = parser.parse_args(rospy.myargv()[1:])
    if (arguments.step == "point") != (1 <= len(arguments.force) <= 2):
        parser.error("point takes one or two forces, the other steps none")
    rospy.init_node("calibrate_sensor", anonymous=True)
    try:
        act(arguments.step, arguments.force)
    except (SensorError, rospy.ROSException, rospy.ServiceException) as error:
        print(f"calibrate_sensor: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
