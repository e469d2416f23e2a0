"""A mouse in rviz on a virtual screen: takes hold of the needle's handle, drags it down, chooses from its menu."""
import subprocess
import time

import matplotlib.image
import numpy

import screenshot

STEP, PERIOD = 6, 0.15           # pixels, s: about 8 um/s of the handle
GLANCE = 1.5                     # s, until rviz, which draws in software, knows what the pointer is on
MENU = ('Enable', 'Inject', 'Withdraw', 'Disable')
FIRST_ROW, ROW, INDENT = 13, 25, 25  # pixels, of the menu from the pointer


class MouseError(Exception):
    """What went wrong, for the user."""


class RvizMouse:
    def __init__(self, view, folder):
        """@raises MouseError where the display is somebody's, whose pointer it is."""
        if not view.virtual:
            raise MouseError('the mouse is tried on a virtual screen; unset DISPLAY')
        self._environment = view.environment
        self._picture = folder / 'mouse.png'
        self._at = None  # pixels; None: the button is up
        self._next = 0.0

    def _do(self, *words):
        try:
            subprocess.run(['xdotool', *map(str, words)], env=self._environment, check=True, timeout=20)
        except (OSError, subprocess.SubprocessError) as error:
            raise MouseError(f'the mouse does not move: {error}') from error

    def _point(self, x, y):
        """Two motions: rviz looks under a pointer that moves."""
        self._do('mousemove', x, y - 1)
        time.sleep(GLANCE)
        self._do('mousemove', x, y)
        time.sleep(GLANCE)

    def _look(self):
        if not screenshot.take(self._picture, 'root', self._environment):
            raise MouseError('there is no picture of the screen')
        red, green, blue = numpy.moveaxis(255 * matplotlib.image.imread(str(self._picture))[..., :3], -1, 0)
        right = numpy.arange(red.shape[1]) > red.shape[1] // 2  # the words to the left have the ball's colour
        ball = (red > 150) & (green > 90) & (green < 190) & (blue < 90) & (red > green + 30) & right
        return ball, (blue > 90) & (red < 60) & (green < 60)

    def _ball(self):
        """Pixel of the orange ball's centre and all of the arrows along z."""
        ball, arrows = self._look()
        if ball.sum() < 100:
            raise MouseError(f'the handle is not to be seen in {self._picture}')
        y, x = (int(numpy.median(pixels)) for pixels in numpy.nonzero(ball))
        return x, y, arrows

    def take_hold(self):
        """Of the arrow below the ball."""
        x, y, arrows = self._ball()
        rows, columns = numpy.nonzero(arrows)
        below = (abs(columns - x) < 40) & (rows > y + 20) & (rows < y + 200)
        if below.sum() < 20:
            raise MouseError(f'the arrow below the handle is not to be seen in {self._picture}')
        self._at = [int(columns[below].mean()), int(rows[below].mean())]
        self._point(*self._at)
        self._do('mousedown', 1)
        self._next = time.monotonic() + GLANCE

    def holds(self):
        return self._at is not None

    def drag_down(self):
        """A step, when it is time for one."""
        if time.monotonic() < self._next:
            return
        self._next = time.monotonic() + PERIOD
        self._at[1] += STEP
        self._do('mousemove', *self._at)

    def release(self):
        self._do('mouseup', 1)
        self._at = None

    def choose(self, word):
        """From the ball's menu."""
        x, y, _ = self._ball()
        self._point(x, y)
        self._do('click', 3)
        time.sleep(GLANCE)
        self._do('mousemove', x + INDENT, y + FIRST_ROW + ROW * MENU.index(word))
        time.sleep(GLANCE)
        self._do('click', 1)
