"""What the tests of the operator's console share: a virtual screen with the console, its mouse, and what is to be seen."""

import os
import re
import subprocess
import tempfile
import time
from pathlib import Path

import numpy
import rospy
from cell_microinjection.msg import StringStamped

import console_eye
from processes import Child
from screen import Screen

PATIENCE = 150        # s of wall time; only a session or a console that hangs takes that long
START_PATIENCE = 400  # s, for rviz on a busy machine
SIZE = (1280, 800)    # px


class ConsoleUser:
    """For unittest.TestCase. `sent`: the commands on /controller/state_command."""

    @classmethod
    def open_console(cls, name="inject", session=("cell:=mouse_oocyte", "only:=display rviz"), buttons=console_eye.BUTTONS):
        """session: what is launched."""
        cls.console, cls.buttons = name, buttons
        os.environ.pop("DISPLAY", None)  # never the user's: the mouse is the test's
        cls.folder = tempfile.TemporaryDirectory()
        logs = Path(cls.folder.name)
        cls.screen = Screen(logs / "xvfb.log", SIZE, logs)
        cls.environment = {**os.environ, **cls.screen.environment}
        cls.rviz = Child(["roslaunch", "cell_microinjection", "session.launch", f"console:={name}", *session], logs / "rviz.log", cls.environment)
        cls.sent = []
        cls.sight, cls.picture = "nothing yet", None
        cls.listener = rospy.Subscriber("/controller/state_command", StringStamped,
                                        lambda message: cls.sent.append(message.string))

    @classmethod
    def close_console(cls):
        cls.rviz.stop(10)
        cls.screen.close()
        cls.folder.cleanup()

    def report(self):
        """For the message of a test that fails."""
        rviz = "rviz has died" if self.died() else "rviz runs" if self.rviz.running() else "roslaunch has ended"
        colours = 0 if self.picture is None else len(numpy.unique(self.picture.reshape(-1, 3), axis=0))
        return f"sent {self.sent}; seen: {self.sight}, of {colours} colours; {rviz}: {self.rviz.tail(10)}"

    def died(self):
        """Whether rviz has; roslaunch goes on."""
        return re.search(r"\[rviz-\d+\] process has died", self.rviz.output()) is not None

    def until(self, condition, what, patience=PATIENCE):
        end = time.monotonic() + patience
        while True:
            result = condition()
            if result:
                return result
            self.assertLess(time.monotonic(), end, f"{what}: not within {patience} s; {self.report()}")
            time.sleep(0.1)

    def look(self):
        """The console; `picture`: all that is on the screen."""
        try:
            self.picture = console_eye.pixels_of(Path(self.folder.name) / "Xvfb_screen0")
            console = console_eye.Console(self.picture, self.console, self.buttons)
            self.sight = f"headline {console.headline}, lamps {console.lamps}, offered {console.offered}"
            return console
        except console_eye.NotSeen as reason:
            self.sight = str(reason)
            return None

    def shows(self, condition, what, patience=PATIENCE):
        """The console, as soon as it shows that."""
        def check():
            console = self.look()
            return console if console and condition(console) else None
        return self.until(check, f"a console with {what}", patience)

    def do(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=60)

    def click(self, place):
        self.do("mousemove", *place)
        self.do("click", 1)

    def press(self, button):
        console = self.shows(lambda seen: seen.offered[button], f"{button} offered")
        before = len(self.sent)
        self.click(console.place[button])
        self.until(lambda: len(self.sent) > before, f"a command of {button}")
