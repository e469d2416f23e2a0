"""Takes a picture of an X window and tells whether it shows a coloured cell.

    screenshot.py PNG [--window NAME] [--timeout S]

Waits until there is colour in the picture; exit code 1 when there is none. Needs DISPLAY and ImageMagick's `import`.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import matplotlib.image
import numpy

# Background, glass, letters and buttons are almost grey; the cell, in the colours of its displacement, is not.
LEAST_SATURATION = 40 / 255  # difference of the strongest and the weakest channel
LEAST_SHARE = 0.03           # of the picture that the cell fills; in our view of it about 0.08


def take(path, window='root', env=None):
    """Writes the window with this title ('root': the whole screen) to the PNG file `path`. Returns whether it did."""
    try:
        subprocess.run(['import', '-silent', '-window', window, f'png24:{path}'], env=env, check=True, timeout=20,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return True
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired, OSError):
        return False


def coloured_share(path):
    """Returns which share of a PNG picture is coloured rather than grey."""
    channels = matplotlib.image.imread(str(path))[..., :3]
    return float(numpy.mean(channels.max(axis=-1) - channels.min(axis=-1) > LEAST_SATURATION))


def shows_cell(path):
    return coloured_share(path) >= LEAST_SHARE


def take_scene(path, windows=('root',), env=None, timeout=20.0, go_on=lambda: True):
    """Tries these windows until a picture shows the cell, which becomes the PNG file `path`; gives up after `timeout` s
    or when not go_on(), with `path` as it was. Returns whether there is such a picture."""
    end = time.monotonic() + timeout
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        draft = Path(folder) / 'draft.png'
        while not any(take(draft, window, env) and shows_cell(draft) for window in windows):
            if time.monotonic() > end or not go_on():
                return False
            time.sleep(0.5)
        os.replace(draft, path)
        return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('png', type=Path)
    parser.add_argument('--window', default='root', help="the window's title; root: the whole screen")
    parser.add_argument('--timeout', type=float, default=20, help='s to wait for the cell')
    arguments = parser.parse_args()
    if not take_scene(arguments.png, (arguments.window,), timeout=arguments.timeout):
        sys.exit(f'screenshot: no picture of a cell within {arguments.timeout:g} s')


if __name__ == '__main__':
    main()
