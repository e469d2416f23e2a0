#!/usr/bin/python3
"""Fits a session to its cell. session.launch calls it before any node starts. Usage: NAME:=VALUE ...

The files of config/ and urdf/rig.urdf are for a cell of 56 um and 17.9 kPa. For another cell lengths and speeds are
scaled with its radius R, forces with E R^2 (E: the Young's modulus that the needle feels), and the guards of the force with
the largest puncture force. `overrides`, a YAML file of the user's, has the last word. Writes the parameters that differ
to `out`. Ends with status 1 when something does not fit: roslaunch then stops.

scene, urdf, haptic_config, overrides: paths; the last two may be empty. camera: as in session.launch. force_sources: those of controller and hand.
"""

import os
import pathlib
import re
import sys

import yaml

from fit_rig import Rig

PACKAGE = pathlib.Path(__file__).resolve().parents[1]
NODES = ("micromanipulator", "haptic_bridge", "injection_controller", "display", "microscope")
OVERRIDDEN = (*NODES, "vision", "calibration", "visual_servo", "focus", "touch", "cell_estimator", "haptic_device", "force_sensor",
              "injector", "cell_simulator", "operator", "teleoperation_follower")

RADIUS, MODULUS = 28e-6, 17.9e3  # m, Pa, of the cell that the files are for
GUARD = 2  # times the largest puncture force

# How parameters follow the cell: +1 with its radius, -1 with one over it; force and 1/force with E R^2.
LENGTHS = {
    "micromanipulator": ("servo_speed_limit",),
    "haptic_bridge": ("position_scale", "rate_mode/gain", "rate_mode/speed_limit", "fixtures/wall/point",
                      "fixtures/workspace/low", "fixtures/workspace/high"),
    "injection_controller": (
        "speed_limit", "jump_limit", "lag_limit", "tracking_limit", "needle_speed_limit", "depth_limit",
        "motion/approach_speed", "motion/travel_limit", "motion/indent_speed", "motion/stab_speed",
        "motion/stab_acceleration", "motion/overshoot", "motion/retract_speed", "goal/depth", "goal/margin"),
    "display": ("colour_range", "force_scale", "injection_pipette/length", "holding_pipette/length"),
    "microscope": ("camera/pixel_size", "focus/range", "focus/speed"),
    "haptic_device": ("handle_offset", "arrow_scale")}
PER_LENGTH = {"haptic_device": ("hand_scale", "enlargement"), "display": ("enlargement",)}
FORCES = {"injection_controller": ("force_limit", "lateral_force_limit")}
PER_FORCE = {"haptic_bridge": ("force_gain",), "display": ("force_scale",)}
SPEEDS = (("micromanipulator", "servo_speed_limit"), ("injection_controller", "speed_limit"),
          ("injection_controller", "motion/stab_speed"), ("haptic_bridge", "rate_mode/speed_limit"))


SIMULATED_CALIBRATION = str(pathlib.Path(os.environ.get("XDG_DATA_HOME") or pathlib.Path.home() / ".local/share") /
                            "cell_microinjection/calibration_simulated.yaml")


class Loader(yaml.SafeLoader):
    """Also takes 56e-6 for a number, as YAML 1.2 and yaml-cpp do."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+$"),
                             list("-+0123456789"))


class Misfit(Exception):
    """What does not fit, for the user."""


class Cell:
    """What a session has to know of its scene."""

    def __init__(self, scene):
        cell = scene["cell"]
        layers = cell.get("layers") or [{"outer_radius": cell["diameter"] / 2, "material": cell.get("material")}]
        self.radius = float(layers[0]["outer_radius"])  # m
        self.modulus = MODULUS if cell.get("model") == "tensegrity" else self._felt_modulus(layers)  # Pa
        puncture = cell.get("puncture") or {}
        self.puncture_force = max([float(layer.get("force", 0)) for layer in puncture.get("layers", [puncture])])  # N
        self.tip_radius = float(scene["needle"]["tip"]["radius"])  # m
        self.mouth_radius = float((scene.get("holding_pipette") or {}).get("contact_radius", 0))  # m

    @staticmethod
    def _felt_modulus(layers):
        """An estimate: a layer adds its modulus over that of the inside by the square of its share of the volume. The
        converged forces of mouse_oocyte_zona and zebrafish_embryo at half a radius are within a third of that."""
        radii = [float(layer["outer_radius"]) for layer in layers]
        moduli = [float(layer["material"]["young_modulus"]) for layer in layers]
        felt = moduli[-1]
        for outer, inner, modulus in reversed(list(zip(radii, radii[1:], moduli))):
            felt += (modulus - felt) * (1 - (inner / outer)**3)**2
        return felt

    @property
    def length_scale(self):
        return self.radius / RADIUS

    @property
    def force_scale(self):
        return self.modulus / MODULUS * self.length_scale**2


def read(path):
    """@returns a YAML file's dictionary."""
    try:
        content = yaml.load(pathlib.Path(path).read_text(encoding="utf-8"), Loader) or {}
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise Misfit(f"{path}: {' '.join(str(error).split())}") from error
    if not isinstance(content, dict):
        raise Misfit(f"{path}: must be keys with values")
    return content


def merge(base, more):
    """Sets the values of `more` in `base`, key by key."""
    for key, value in more.items():
        if isinstance(value, dict) and isinstance(base.get(key), dict):
            merge(base[key], value)
        else:
            base[key] = value
    return base


def find(parameters, path):
    """@returns the value at a path such as motion/travel_limit, or None."""
    for key in path.split("/"):
        parameters = parameters.get(key) if isinstance(parameters, dict) else None
    return parameters


def put(parameters, path, value):
    *folders, name = path.split("/")
    for folder in folders:
        parameters = parameters.setdefault(folder, {})
    parameters[name] = value


def scaled(value, factor):
    if isinstance(value, list):
        return [scaled(item, factor) for item in value]
    return float(f"{factor * value:.6g}")


class Fit:
    """The parameters of a session's nodes that follow the cell."""

    def __init__(self, cell, haptic, limits):
        """@param haptic: of the device's file; @param limits: of the axes, m/s"""
        self._cell = cell
        self.base = {node: read(PACKAGE / "config" / f"{node}.yaml") for node in NODES}
        for node in ("haptic_bridge", "haptic_device"):
            merge(self.base.setdefault(node, {}), haptic.get(node, {}))
        self.changed = {}
        self._scale()
        self._follow_puncture_force()
        self._follow_scene()
        for node, path in SPEEDS:
            value = self.get(node, path)
            if value is not None and value > limits:
                self._set(node, path, limits)

    def get(self, node, path):
        value = find(self.changed.get(node, {}), path)
        return find(self.base.get(node, {}), path) if value is None else value

    def _set(self, node, path, value):
        if value != find(self.base[node], path):
            put(self.changed.setdefault(node, {}), path, value)

    def _scale(self):
        length, force = self._cell.length_scale, self._cell.force_scale
        for table, factor in ((LENGTHS, length), (PER_LENGTH, 1 / length), (FORCES, force), (PER_FORCE, 1 / force)):
            if factor == 1:
                continue
            for node, paths in table.items():
                for path in paths:
                    if self.get(node, path) is not None:
                        self._set(node, path, scaled(self.get(node, path), factor))
        threshold = "detection/contact_force"  # no smaller: a sensor's noise does not shrink with the cell
        self._set("injection_controller", threshold, scaled(self.get("injection_controller", threshold), max(1, force)))

    def _follow_puncture_force(self):
        if self._cell.puncture_force:
            self._set("injection_controller", "force_limit", scaled(self._cell.puncture_force, GUARD))

    def _follow_scene(self):
        for node, needle, holder in (("display", "injection_pipette", "holding_pipette"),
                                     ("microscope", "specimen/injection_pipette", "specimen/holding_pipette")):
            self._follow(node, needle, ("tip_radius", "shaft_radius"), self._cell.tip_radius)
            self._follow(node, holder, ("mouth_radius", "outer_radius"), self._cell.mouth_radius)

    def _follow(self, node, pipette, names, radius):
        """The first radius is the scene's, if it has one, and the second keeps its ratio to the first."""
        first, second = (self.get(node, f"{pipette}/{name}") for name in names)
        if radius:
            self._set(node, f"{pipette}/{names[0]}", radius)
            self._set(node, f"{pipette}/{names[1]}", scaled(second, radius / first))


def override(fit, rig, path):
    """Takes the user's values over."""
    for node, values in read(path).items():
        if not isinstance(values, dict):
            raise Misfit(f"{path}: {node} = {values}: must be keys with values")
        if node == "rig":
            rig.override(values, path)
        elif node in OVERRIDDEN:
            merge(fit.changed.setdefault(node, {}), values)
        else:
            raise Misfit(f"{path}: unknown key {node}; allowed: rig, {', '.join(OVERRIDDEN)}")


def number(fit, node, path):
    value = fit.get(node, path)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Misfit(f"{node}/{path} = {value}: must be a number")
    return value


def misfits(cell, fit, rig, sensor_range):
    """@returns a line for everything that does not go together. `sensor_range`: N, or None."""
    def controller(path):
        return number(fit, "injection_controller", path)

    micrometres = 1e6
    top, depth, force = cell.radius, controller("depth_limit"), controller("force_limit")
    found = rig.misfits(cell.radius, depth)
    if rig.start_height - top > controller("motion/travel_limit"):
        found.append(f"injection_controller/motion/travel_limit = {controller('motion/travel_limit'):g} m: the needle starts "
                     f"{micrometres * (rig.start_height - top):.4g} um above the cell; must be at least that")
    if controller("goal/depth") > depth:
        found.append(f"injection_controller/goal/depth = {controller('goal/depth'):g} m: must be at most depth_limit = {depth:g}")
    if force <= cell.puncture_force:
        found.append(f"injection_controller/force_limit = {force:g} N: must be above the puncture force "
                     f"{cell.puncture_force:g} N, or the cell is never punctured")
    if sensor_range is not None and force > sensor_range:
        found.append(f"injection_controller/force_limit = {force:g} N: must be at most the range of the force sensor, "
                     f"{sensor_range:g} N, whose force is used")
    for node, path in SPEEDS[:2]:
        if number(fit, node, path) > rig.axis_speed:
            found.append(f"{node}/{path} = {fit.get(node, path):g} m/s: must be at most the axes' {rig.axis_speed:g} m/s")
    return found


def fit_session(arguments):
    """@returns (text for the user, parameters that differ). Raises Misfit."""
    path = arguments["scene"]
    try:
        cell = Cell(read(path))
    except (KeyError, TypeError, ValueError, AttributeError, IndexError, ZeroDivisionError) as error:
        raise Misfit(f"scene {path}: has no valid cell and needle: {error!r}") from error
    if not (cell.radius > 0 and cell.modulus > 0 and cell.tip_radius > 0):
        raise Misfit(f"scene {path}: radius, modulus and the tip's radius must be above 0")
    rig = Rig(arguments["urdf"], Misfit)
    rig.scale(cell.length_scale, cell.mouth_radius)
    haptic = arguments["haptic_config"]
    fit = Fit(cell, read(haptic) if pathlib.Path(haptic).is_file() else {}, rig.axis_speed)
    if arguments["camera"] == "sim":  # of another camera only a calibration knows it
        put(fit.changed, "vision/pixel_size", fit.get("microscope", "camera/pixel_size"))
        for node, key in (("calibration", "file"), ("vision", "calibration"), ("visual_servo", "calibration")):
            put(fit.changed, f"{node}/{key}", SIMULATED_CALIBRATION)  # that of a real camera stays
    if arguments["overrides"]:
        override(fit, rig, arguments["overrides"])
    measured = arguments["sensor"] == "simulated" and "measured" in arguments["force_sources"]
    ranges = read(PACKAGE / "config" / "force_sensor.yaml")["simulated"]
    found = misfits(cell, fit, rig, ranges["axial_range"] if measured else None)
    if found:
        raise Misfit("\n".join(found))
    parameters = dict(fit.changed)
    if rig.changed:
        parameters["robot_description"] = rig.text()
    text = (f"for a cell of {2e6 * cell.radius:.4g} um: the needle starts at {1e6 * rig.start_height:.4g} um, stops at "
            f"{1e6 * number(fit, 'injection_controller', 'force_limit'):.3g} uN and "
            f"{1e6 * number(fit, 'injection_controller', 'depth_limit'):.3g} um of depth")
    return text, parameters


def main():
    arguments = dict(argument.split(":=", 1) for argument in sys.argv[1:])
    try:
        text, parameters = fit_session(arguments)
        with open(arguments["out"], "w", encoding="utf-8") as file:
            yaml.safe_dump(parameters, file)
    except (Misfit, OSError) as error:
        for line in str(error).splitlines():
            print(f"session.launch: {line}", file=sys.stderr)
        return 1
    print(f"session.launch: {text}", file=sys.stderr)  # roslaunch shows it
    print(text)  # the parameter's value
    return 0


if __name__ == "__main__":
    sys.exit(main())
