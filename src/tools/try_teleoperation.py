#!/usr/bin/python3
"""Does what doc/guide/teleoperate.md tells a person to do, with made-up keys or a made-up mouse in rviz.

    ./dev shell -- python3 src/tools/try_teleoperation.py OUT [--hand keyboard|marker] [--cell NAME]

Starts a session and rviz (without a display: on a virtual one), goes into the cell until it gives way, injects,
withdraws; leaves OUT/HAND.png of the pressed cell, prints when what was reached, and fails when it was not.
"""
import argparse
import os
import pty
import subprocess
import sys
import time
from pathlib import Path

import rospy
from sensor_msgs.msg import Joy

from cell_microinjection.msg import InjectionStatus, OperatingState
from demo_session import DemoSession, SessionError
from rviz_mouse import MouseError, RvizMouse
from rviz_view import PICTURE_RATE, RvizError, RvizView

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120     # s, for rviz to show the cell, and for the whole injection
MOUSE_RATE = 8     # Hz, that rviz draws at for a mouse
PICTURE_FORCE = 2e-6  # N, of the pressed cell in the picture


class Keyboard:
    """keyboard_hand in a terminal, and who types there: a held key comes again after half a second, then 30 times a s."""

    DOWN, INJECT, HOME = b'\x1b[B', b'i', b'w'

    def __init__(self):
        self._terminal, ours = pty.openpty()
        self._program = subprocess.Popen(['rosrun', 'cell_microinjection', 'keyboard_hand'], stdin=ours, stdout=ours)
        os.close(ours)
        os.set_blocking(self._terminal, False)
        time.sleep(3)
        self._next = 0.0

    def press(self):
        os.write(self._terminal, self.DOWN)
        self._next = time.monotonic() + 0.5

    def go_on(self):
        if time.monotonic() >= self._next:
            os.write(self._terminal, self.DOWN)
            self._next = time.monotonic() + 1 / 30
        self.said()

    def release(self):
        pass

    def inject(self):
        os.write(self._terminal, self.INJECT)

    def withdraw(self):
        os.write(self._terminal, self.HOME)

    def said(self):
        try:
            return os.read(self._terminal, 65536).decode(errors='replace')
        except BlockingIOError:
            return ''

    def close(self):
        os.write(self._terminal, b'q')
        self._program.wait(20)


class Mouse:
    """The handle in rviz, dragged by the arrow below it, and its menu."""

    def __init__(self, view, folder):
        self._mouse = RvizMouse(view, folder)
        self._held = time.monotonic()  # since then the handle is held, as far as is known
        rospy.Subscriber('/haptic/operator_present', Joy, self._hear)

    def _hear(self, message):
        if message.buttons[0]:
            self._held = time.monotonic()

    def press(self):
        if not self._mouse.holds():
            self._mouse.take_hold()
        self._held = time.monotonic()

    def go_on(self):
        if time.monotonic() > self._held + 2:
            print('        the handle was lost', flush=True)
            self._mouse.release()
            self.press()
        self._mouse.drag_down()

    def release(self):
        self._mouse.release()

    def inject(self):
        self._mouse.choose('Inject')

    def withdraw(self):
        self._mouse.choose('Withdraw')

    def close(self):
        pass


class Trial:
    def __init__(self, check):
        self._check = check
        self._start = time.monotonic()
        self.status = InjectionStatus()
        self.state = OperatingState()
        rospy.Subscriber('/controller/injection_state', InjectionStatus, lambda m: setattr(self, 'status', m))
        rospy.Subscriber('/controller/operating_state', OperatingState, lambda m: setattr(self, 'state', m))

    def when_told(self, act):
        """`act` again each time that the controller has told that it was not done."""
        seen = [self.status.header.stamp]

        def once():
            if self.status.notice and self.status.header.stamp > seen[0] + rospy.Duration(1):
                seen[0] = self.status.header.stamp
                print(f'        told: {self.status.notice}', flush=True)
                act()
        return once

    def until(self, condition, what, meanwhile=lambda: None):
        end = self._start + PATIENCE
        while not condition(self.status):
            if time.monotonic() > end:
                raise SessionError(f'{what}: not within {PATIENCE} s; {self.state.state}, {self.status}')
            self._check()
            meanwhile()
            time.sleep(0.02)
        print(f'{time.monotonic() - self._start:6.1f} s  {what}: {self.status.state}, {1e6 * self.status.force:.2f} uN, '
              f'{1e6 * self.status.depth:.1f} um deep, {1e15 * self.status.volume:.1f} pL', flush=True)


def run(arguments, session):
    session.wait_ready()
    by_mouse = arguments.hand == 'marker'
    view = RvizView(ROOT / 'config/session.rviz', arguments.out, MOUSE_RATE if by_mouse else PICTURE_RATE)
    try:
        trial = Trial(session.check)
        if not view.picture(arguments.out / 'before.png', PATIENCE, session.check):
            raise SessionError('rviz does not show the cell')
        time.sleep(5)  # until it shows the rest
        hand = Mouse(view, arguments.out) if by_mouse else Keyboard()
        hand.press()
        trial.until(lambda s: s.force > PICTURE_FORCE, 'pressed', hand.go_on)
        time.sleep(2)  # rviz without a graphics card draws twice a second
        view.picture(arguments.out / f'{arguments.hand}.png', PATIENCE, session.check)
        hand.press()
        trial.until(lambda s: s.punctures > 0, 'through', hand.go_on)
        hand.release()
        time.sleep(2)  # a person's way to another key or the menu
        trial.until(lambda s: s.state == 'punctured', 'at rest')
        hand.inject()
        # Where the force was not known for a moment the pulse is over, or not given; the operator is told, and says it
        # again.
        trial.until(lambda s: s.volume > 0 and s.state == 'punctured' and not s.notice, 'injected',
                    trial.when_told(hand.inject))
        hand.withdraw()
        trial.until(lambda s: trial.state.state == 'PAUSED' and s.depth == 0, 'withdrawn')
        hand.close()
    finally:
        view.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('out', type=Path)
    parser.add_argument('--hand', choices=('keyboard', 'marker'), default='keyboard')
    parser.add_argument('--cell', default='mouse_oocyte')
    arguments = parser.parse_args()
    arguments.out = arguments.out.resolve()
    arguments.out.mkdir(parents=True, exist_ok=True)
    session = DemoSession(ROOT / 'launch/session.launch', arguments.out,
                          {'hand.device': arguments.hand, 'cell': arguments.cell})
    try:
        run(arguments, session)
    except (SessionError, RvizError, MouseError) as error:
        sys.exit(f'try_teleoperation: {error}')
    finally:
        session.stop()


if __name__ == '__main__':
    main()
