#!/usr/bin/python3
"""A node whose parameters are wrong ends with status 1, names key, value and range, and never comes alive."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import rosnode
import rospkg
import rospy
import rostest

from case import case
from live_chain import until

NODES = pathlib.Path(sys.argv[0]).parent  # this program is found beside them
SCENE = rospkg.RosPack().get_path("cell_microinjection") + "/test/chain/coarse_oocyte.yaml"
ROUNDED = rospkg.RosPack().get_path("cell_microinjection") + "/config/cells/mouse_oocyte_pipette.yaml"
FAMILIES = rospkg.RosPack().get_path("cell_microinjection") + "/config/families"
MOTION = rospkg.RosPack().get_path("cell_microinjection") + "/config/hand_motions/indent_and_retract.yaml"
EMPTY = tempfile.mkdtemp()  # no mesh, nothing prepared
GOOD = {  # what each node cannot do without
    "calibration": {},
    "camera": {"source": "folder", "path": tempfile.mkdtemp()},
    "cell_estimator": {"scene": ROUNDED, "families": FAMILIES},
    "cell_simulator": {"scene": SCENE},
    "display": {},
    "focus": {},
    "force_sensor": {},
    "force_watchdog": {},
    "haptic_bridge": {},
    "haptic_device": {"kind": "joy"},
    "image_recorder": {"output_dir": tempfile.mkdtemp()},
    "injection_controller": {},
    "injector": {},
    "micromanipulator": {},
    "microscope": {},
    "notebook": {"file": tempfile.mkdtemp() + "/notebook.csv"},
    "operator": {"motion": MOTION},
    "session_recorder": {"output_dir": tempfile.mkdtemp()},
    "vision": {},
    "visual_servo": {},
}
BAD = [  # node, wrong parameters, what the message must say
    ("calibration", {"pattern/rows": 1}, ["pattern/rows = 1", "[2, 100]"]),
    ("calibration", {"file": MOTION}, ["indent_and_retract.yaml"]),
    ("camera", {"path": "/nowhere"}, ["/nowhere"]),
    ("camera", {"rate": -1}, ["rate = -1"]),
    ("camera", {"source": "television"}, ["source = television", "device, folder, video"]),
    ("cell_estimator", {"estimator/modulus_deviation": 0}, ["modulus_deviation = 0", "[0.01, 3]"]),
    ("cell_estimator", {"estimator/history/capacity": 2}, ["history/capacity = 2", "[40, 2000]"]),
    ("cell_estimator", {"scene": SCENE}, ["coarse_oocyte.yaml", "needs a cell of a family"]),
    ("cell_simulator", {"scene": "/nowhere.yaml"}, ["/nowhere.yaml"]),
    ("cell_simulator", {"model": "prepared"}, ["model = prepared", "needle/tip/shape = disc"]),
    ("cell_simulator", {"model": "prepared", "scene": ROUNDED}, ["model = prepared", "prepare --scene"]),
    ("cell_simulator", {"model": "guessed"}, ["model = guessed", "auto, prepared, live, explicit"]),
    ("cell_simulator", {"rate": 1e6}, ["rate = 1e+06", "[50, 5000]"]),
    ("cell_simulator", {"extrapolation_limit": 0.0}, ["extrapolation_limit = 0", "(0, inf)"]),
    ("display", {"rate": -1}, ["rate = -1"]),
    ("focus", {"step": 0}, ["step = 0"]),
    ("force_sensor", {"simulated/bits": 2}, ["simulated/bits = 2", "[4, 32]"]),
    ("force_sensor", {"simulated/axial_range": "wide"}, ["axial_range = wide", "number"]),
    ("force_sensor", {"source": "guessed"}, ["source = guessed", "simulated, serial, topic"]),
    ("force_sensor", {"source": "serial"}, ["serial/path is missing", "serial/matrix is missing"]),
    ("force_sensor", {"frame": "nowhere", "frame_timeout": 0.5}, ["frame 'nowhere'", "static_transform_publisher"]),
    ("force_watchdog", {"timeout": 0.0}, ["timeout = 0", "(0, inf)"]),
    ("force_watchdog", {"kind": "omni", "force": "body/servo_cf"}, ["force = body/servo_cf", "kind: crtk only"]),
    ("force_watchdog", {"kind": "moon"}, ["kind = moon", "crtk, omni, geomagic"]),
    ("haptic_bridge", {"position_scale": 0}, ["position_scale = 0", "(0, inf)"]),
    ("haptic_bridge", {"force_source": "guessed"}, ["force_source = guessed", "predicted, measured"]),
    ("haptic_bridge", {"timeouts/clutch": -1}, ["timeouts/clutch = -1", "[0, inf)"]),
    ("haptic_device", {"kind": "moon"}, ["kind = moon", "crtk, omni, geomagic, joy, keyboard, marker"]),
    ("haptic_device", {"kind": "crtk", "position_type": "twist"}, ["position_type = twist", "pose, transform"]),
    ("haptic_device", {"kind": "crtk", "clutch/index": -1}, ["clutch/index = -1", "[0, 63]"]),
    ("haptic_device", {"centre": 1}, ["centre = 1", "(0, 1)"]),
    ("haptic_device", {"kind": "omni", "clutch_button": "red"}, ["clutch_button = red", "grey, white, none"]),
    ("haptic_device", {"kind": "omni", "operator_button": "grey"}, ["operator_button", "another than clutch_button"]),
    ("haptic_device", {"kind": "keyboard"}, ["needs a terminal"]),
    ("injection_controller", {"force_limit": -1e-6}, ["force_limit = -1", "(0, inf)"]),
    ("injection_controller", {"mode": "moon", "rate": 1}, ["mode = moon", "manual, semi_automatic, automatic", "rate = 1"]),
    ("injector", {"pipette/tip_radius": -1e-6}, ["tip_radius = -1e-06", "(0, inf)"]),
    ("injector", {"source": "serial"}, ["serial/path is missing", "serial/pulse is missing"]),
    ("microscope", {"focus/start": 1}, ["focus/start = 1", "within range"]),
    ("microscope", {"specimen/dust": -1}, ["specimen/dust = -1", "[0, 200]"]),
    ("microscope", {"camera/pixel_size": 0}, ["camera/pixel_size = 0"]),
    ("micromanipulator", {"collision_margin": -1}, ["collision_margin = -1", "[0, inf)"]),
    ("micromanipulator", {"pipette_tilt": 2}, ["pipette_tilt = 2 rad", "[0, 1.2] rad"]),
    ("micromanipulator", {"device/backlash": -1}, ["device/backlash = -1", "[0, inf)"]),
    ("micromanipulator", {"rig": "moon"}, ["rig = moon", "eppendorf, mp285, scientifica, zaber"]),
    ("micromanipulator", {"rig": "mp285", "device/microsteps": "[1, 0, 0]"}, ["device/microsteps"]),
    ("micromanipulator", {"rig": "eppendorf", "device/speed": 1}, ["device/speed = 1"]),
    ("micromanipulator", {"rig": "scientifica", "device/version": 4}, ["device/version = 4", "[2, 3]"]),
    ("micromanipulator", {"rig": "zaber", "device/gain": -1}, ["device/gain = -1"]),
    ("notebook", {"file": "/proc/nowhere/notebook.csv"}, ["/proc/nowhere"]),
    ("operator", {"motion": "/nowhere.csv"}, ["/nowhere.csv"]),
    ("operator", {"mass": -0.1}, ["mass = -0.1", "(0, inf)"]),
    ("session_recorder", {"row_period": 0}, ["row_period = 0", "(0, inf)"]),
    ("image_recorder", {"output_dir": "/proc/nowhere"}, ["/proc/nowhere"]),
    ("image_recorder", {"rate": 0}, ["rate = 0", "[1, 1000]"]),
    ("vision", {"pixel_size": -1}, ["pixel_size = -1", "[0, 0.0001]"]),
    ("vision", {"cell/look": "x_ray"}, ["cell/look = x_ray", "bright_field, phase, dic, unknown"]),
    ("visual_servo", {"image_target/gain": 0}, ["image_target/gain = 0", "(0, 1]"]),
]


def start(node, parameters):
    arguments = [f"_{key}:={value}" for key, value in parameters.items()]
    return subprocess.Popen([str(NODES / node), *arguments, f"__name:=tried_{node}"],
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            env={**os.environ, "XDG_CACHE_HOME": EMPTY})


class BadParametersTest(unittest.TestCase):
    def check_refused(self, node, parameters, words):
        for key in rospy.get_param(f"/tried_{node}", {}):
            rospy.delete_param(f"/tried_{node}/{key}")
        process = start(node, {**GOOD[node], **parameters})
        try:
            output, _ = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            self.fail(f"{node} came alive with {parameters}")
        self.assertEqual(process.returncode, 1, output)
        for word in words:
            self.assertIn(word, output)
        self.assertNotIn(f"/tried_{node}", rosnode.get_node_names())

    def test_out_of_range(self):
        for node, parameters, words in BAD:
            with case(node, parameters):
                self.check_refused(node, parameters, words)

    def test_unknown_key(self):
        for node in GOOD:
            with case(node):
                self.check_refused(node, {"forse_limit": 3}, ["forse_limit", "unknown key"])

    def test_missing_key(self):
        for node, needed in GOOD.items():
            for key in needed:
                with case(node, key):
                    parameters = dict(needed)
                    del parameters[key]
                    saved, GOOD[node] = GOOD[node], parameters
                    try:
                        self.check_refused(node, {}, [f"{key} is missing"])
                    finally:
                        GOOD[node] = saved

    def test_good_ones_do_come_alive(self):
        """Without this the tests above would pass for a node that never starts."""
        for node, parameters in GOOD.items():
            with case(node):
                for key in rospy.get_param(f"/tried_{node}", {}):
                    rospy.delete_param(f"/tried_{node}/{key}")
                process = start(node, parameters)
                try:
                    until(lambda: f"/tried_{node}" in rosnode.get_node_names() or process.poll() is not None,
                          "its end, or a node that the master knows")
                    self.assertIsNone(process.poll(), "ended")
                    self.assertIn(f"/tried_{node}", rosnode.get_node_names())
                finally:
                    process.terminate()
                    process.communicate()


if __name__ == "__main__":
    rospy.init_node("bad_parameters")
    rostest.rosrun("cell_microinjection", "bad_parameters", BadParametersTest)
