"""Where the workflows' programs are: a folder given as `--config programs=FOLDER`, or what ./dev has built."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILT = (ROOT / "catkin_ws/install/lib/cell_microinjection", ROOT / "build/core/plain/src")


def find(name, config):
    folders = [Path(config["programs"])] if "programs" in config else BUILT
    for folder in folders:
        if (folder / name).is_file():
            return (folder / name).resolve()
    raise SystemExit(f"{name} is not in {', '.join(map(str, folders))}; ./dev build makes it")


def required(key, config, meaning):
    if key not in config:
        raise SystemExit(f"{key} is missing: add {key}={meaning} behind --config")
    return Path(config[key]).resolve()
