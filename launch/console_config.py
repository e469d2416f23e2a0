#!/usr/bin/python3
"""Writes the rviz configuration of a console, which display.launch calls before rviz starts. Usage: NAME OUT

It is config/session.rviz, with config/console/common.rviz and then config/console/NAME.yaml, which are parts of an rviz
configuration that override it: keys by their name, elements of a list by their Name. An element with another Name is added.
"""

import functools
import pathlib
import sys

import yaml

PACKAGE = pathlib.Path(__file__).resolve().parents[1]


def merged(base, task):
    """@returns base with what task overrides or adds."""
    if isinstance(base, dict) and isinstance(task, dict):
        return {**base, **{key: merged(base.get(key), value) for key, value in task.items()}}
    if isinstance(base, list) and isinstance(task, list):
        by_name = {element["Name"]: element for element in task}
        kept = [merged(element, by_name.pop(element.get("Name"), element)) for element in base]
        return kept + list(by_name.values())
    return task


def configuration(name):
    """@returns the rviz configuration of the console NAME, as text."""
    files = ("session.rviz", "console/common.rviz", f"console/{name}.yaml")
    parts = [yaml.safe_load((PACKAGE / "config" / file).read_text(encoding="utf-8")) for file in files]
    return yaml.safe_dump(functools.reduce(merged, parts), sort_keys=False)


def main():
    name, out = sys.argv[1:3]
    try:
        pathlib.Path(out).write_text(configuration(name), encoding="utf-8")
    except (OSError, yaml.YAMLError) as error:
        print(f"display.launch: console = '{name}': {error}", file=sys.stderr)
        return 1
    print("written")  # the parameter's value
    return 0


if __name__ == "__main__":
    sys.exit(main())
