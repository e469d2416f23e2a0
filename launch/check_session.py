#!/usr/bin/python3
"""Checks the arguments of session.launch, which calls it before any node starts. Usage: NAME:=VALUE ...

Prints each wrong argument with its value and the allowed values, and ends with status 1: roslaunch then stops.
"""

import pathlib
import sys

PACKAGE = pathlib.Path(__file__).resolve().parents[1]


def stems(folder, pattern):
    return sorted(path.stem for path in (PACKAGE / folder).glob(pattern))


def choices():
    """@returns {argument: allowed values}; devices are those with a file."""
    rigs = [name for name in stems("config/rigs", "*.yaml") if name not in ("sim", "imperfect")]
    injectors = stems("config/injectors", "*.yaml")
    boolean = ["true", "false"]
    flags = ("allow_network", "require_operator", "inject", "link_emulated", "auto_enable", "display", "rviz", "bag",
             "end_when_done", "wait_for_go", "twin")
    return {
        "model": ["auto", "prepared", "live", "explicit"],
        "rig": ["sim", *rigs, *(f"emulated_{name}" for name in rigs)],
        "sensor": ["simulated", "serial", "topic", "none"],
        "injector": ["simulated", *injectors, *(f"emulated_{name}" for name in injectors), "serial", "none"],
        "haptic": stems("launch/haptic", "*.launch"),
        "position_type": ["", "pose", "transform"],
        "mode": ["manual", "automatic", "semi_automatic"],
        "force_source": ["predicted", "measured"],
        "hand_force": ["predicted", "measured", "blend"],
        "link": ["none", "wave"],
        "console": ["none", *stems("config/console", "*.yaml")],
        "camera": ["none", "sim", "device", "folder", "video", "topic"],
        "clock": ["wall", "lockstep", "external"],
        **{flag: boolean for flag in flags}}


def problems(arguments):
    """@returns a line for each argument that is wrong."""
    found = []
    for name, allowed in choices().items():
        value = arguments[name].lower() if allowed == ["true", "false"] else arguments[name]
        if value not in allowed:
            found.append(f"{name} = '{arguments[name]}': must be one of: {', '.join(filter(None, allowed))}")
    if not pathlib.Path(arguments["scene"]).is_file():
        names = ", ".join(stems("config/cells", "*.yaml"))
        found.append(f"cell, scene = '{arguments['scene']}': no such file; the cells are: {names}")
    if arguments["hidden"] and not pathlib.Path(arguments["hidden"]).is_file():
        found.append(f"hidden = '{arguments['hidden']}': no such file")
    if arguments["hidden"] and arguments["modelled"].lower() != "true":
        found.append(f"hidden with rig = '{arguments['rig']}': must be with sim or an emulated rig; a real one has its own cell")
    if arguments["twin"].lower() == "true" and arguments["sensor"] == "none" and arguments["camera"] == "none":
        found.append("twin = 'true' with sensor = 'none' and camera = 'none': must be with a force sensor, which shows modulus "
                     "and height of the cell, or with a camera, which shows the height")
    if arguments["sensor"] == "none" and "measured" in (arguments["force_source"], arguments["hand_force"]):
        found.append("force_source, hand_force = 'measured' with sensor = 'none': must be with a force sensor")
    if arguments["twin"].lower() == "true" and arguments["modelled"].lower() != "true" and arguments["sensor"] == "none":
        found.append(f"twin = 'true' with sensor = 'none' and rig = '{arguments['rig']}': must be with a force sensor on a real rig: "
                     "an image does not show the puncture")
    elif arguments["twin"].lower() == "true" and arguments["modelled"].lower() != "true" and arguments["force_source"] != "measured":
        found.append(f"twin = 'true' with force_source = '{arguments['force_source']}': must be measured on a real rig, "
                     "whose puncture the predicted force does not show")
    if arguments["clock"] == "lockstep" and arguments["twin"].lower() == "true" and arguments["sensor"] == "none":
        found.append("clock = 'lockstep' with twin = 'true' and sensor = 'none': must be with a force sensor, for which the twin "
                     "waits in each step")
    if arguments["clock"] == "lockstep" and arguments["haptic"] not in ("operator", "none"):
        found.append(f"clock = 'lockstep' with haptic = '{arguments['haptic']}': must be with operator or none, "
                     "which keep the clock's time")
    if arguments["mode"] != "manual" and arguments["haptic"] != "none":
        found.append(f"mode = '{arguments['mode']}': must be with haptic:=none")
    if arguments["operator"] and not arguments["record"]:
        found.append("operator: must be with record:=FOLDER, whose session is scored")
    return found


def main():
    found = problems(dict(argument.split(":=", 1) for argument in sys.argv[1:]))
    for line in found:
        print(f"session.launch: {line}", file=sys.stderr)
    print("checked")  # the parameter's value
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
