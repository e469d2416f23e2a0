"""rviz on the user's display, or on a virtual one, and pictures of what it shows."""
import os
import re
import signal
import subprocess

import screenshot
from processes import Child
from screen import Screen


PICTURE_RATE = 2  # Hz; who looks at a virtual display wants one picture, and rendering in software costs a core


def _changed(config, folder, rate, size):
    """Returns a copy of an rviz configuration that draws at `rate` (Hz) in a window of `size` (px)."""
    text = re.sub(r'Frame Rate: \d+', f'Frame Rate: {rate}', config.read_text(encoding='utf-8'))
    text = re.sub(r'(Window Geometry:\n) *Height: \d+\n *Width: \d+', fr'\1  Height: {size[1]}\n  Width: {size[0]}', text)
    copy = folder / config.name
    copy.write_text(text, encoding='utf-8')
    return copy


SHARE = -3  # niceness of rviz's session, beside the session recorder's
PICTURE_SHARE = -12  # same while a picture is taken, for which the others can wait


class RvizError(Exception):
    """What went wrong, for the user."""


def write_console(name, path):
    """Writes the rviz configuration of an operator's console. @raises RvizError"""
    command = ['rosrun', 'cell_microinjection', 'session', f'display.console:={name}', '--view', str(path)]
    done = subprocess.run(command, text=True, capture_output=True)
    if done.returncode:
        raise RvizError(f'console {name}: {done.stderr.strip()}')


class RvizView:
    """rviz with a configuration; close it before the program ends."""

    def __init__(self, config, logs, virtual_rate=PICTURE_RATE, virtual_size=(1280, 960)):
        """@param virtual_rate  Hz, that a virtual display is drawn at
        @param virtual_size  px, width and height of a virtual display, which the window fills
        @raises RvizError when there is no display to be had."""
        try:
            self._screen = Screen(logs / 'xvfb.log', virtual_size)
        except (OSError, RuntimeError) as error:
            raise RvizError(f'there is no display, and no virtual one: {error}') from error
        self.virtual = self._screen.virtual
        self.environment = {**os.environ, **self._screen.environment}
        # The whole virtual screen is rviz's; of the user's screen the picture takes nothing but rviz's window, whose
        # title has an asterisk once the view was changed.
        self._windows = ('root',) if self.virtual else (f'{config.name} - RViz', f'{config.name}* - RViz')
        # Rendering in software takes a whole core; the nodes at 1 kHz come first by their real-time priority.
        shown = _changed(config, logs, virtual_rate, virtual_size) if self.virtual else config
        command = ['nice', '-n', '10', 'rosrun', 'cell_microinjection', 'rviz', '-d', str(shown)] + (['--fullscreen'] if self.virtual else [])
        try:
            self._rviz = Child(command, logs / 'rviz.log', self.environment)
            self._rviz.favour(SHARE)
        except OSError as error:
            self._screen.close()
            raise RvizError(f'rviz does not start: {error}') from error

    def running(self):
        return self._rviz.running()

    def freeze(self, frozen):
        """Stops the process as it is, or lets it go on."""
        self._rviz.send_signal(signal.SIGSTOP if frozen else signal.SIGCONT)

    def send_signal(self, number):
        self._rviz.send_signal(number)

    def drawing_time(self):
        """s of processor time that the first thread has used, in which rviz draws and its panels work."""
        return self._rviz.first_thread_time()

    def processor_time(self):
        """s of processor time that all of its threads have used."""
        return self._rviz.processor_time()

    def check(self):
        """@raises RvizError when rviz has ended."""
        if not self.running():
            raise RvizError(f'rviz has ended; {self._rviz.log} ends with\n{self._rviz.tail(8)}')

    def picture(self, path, timeout, check=lambda: None):
        """Writes a PNG as soon as rviz shows the scene. Returns whether it did within `timeout` s.
        @param check  called between attempts; may raise."""
        def go_on():
            check()
            return self.running()
        self._rviz.favour(PICTURE_SHARE)
        taken = screenshot.take_scene(path, self._windows, self.environment, timeout, go_on)
        self._rviz.favour(SHARE)
        return taken

    def close(self):
        self._rviz.stop(5)
        self._screen.close()
