#!/usr/bin/python3
"""Makes the pictures of README.md: an injection in the scene and its plot, the console, and a short animation of it.

Leaves scene.png and force_depth.png (of ./dev demo), console.png and injection.gif in the output folder. Draws on a virtual
display, so that their size is the same everywhere.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import console_pictures
from demo_session import SessionError
from processes import Child, wait_until

ROOT = Path(os.environ.get('MICROINJECTION_ROOT') or Path(__file__).resolve().parents[2])
SIZE = (1280, 800)    # px
MENU = 62             # px above the panels
PERIOD = 0.12         # s of wall time between two frames, at least
SLOW = {'stab_speed': 2.0e-5, 'retract_speed': 8.0e-5}  # m/s, or nobody sees the stab
LARGEST = 3e6         # bytes, of the animation
PAUSE = '200'         # hundredths of a second, of its last frame
STEPS = ('approach', 'indent', 'inject', 'withdraw')
PATIENCE = 240        # s of wall time, for rviz to come up, and for a step
SETTLE = 6            # s, for rviz to draw the first images


class PicturesError(Exception):
    """What went wrong, for the user."""


class Injection:
    """The controller's messages, and commands to it. The session's monitor is this process' node."""

    def __init__(self):
        import rospy
        from cell_microinjection.msg import InjectionStatus, StringStamped
        self.status = None
        self.changes = 0  # of the state: a pulse may be over between two looks
        self._stamped = StringStamped
        self._commands = rospy.Publisher('/controller/state_command', StringStamped, queue_size=1)
        rospy.Subscriber('/controller/injection_state', InjectionStatus, self._on_status)

    def _on_status(self, message):
        self.changes += self.status is not None and message.state != self.status.state
        self.status = message

    def say(self, command):
        self._commands.publish(self._stamped(string=command))

    def waits(self):
        return self.status is not None and (self.status.waits or self.status.state == 'idle')


class Recording:
    """Frames of the whole display."""

    def __init__(self, folder, screen):
        """screen: the file in which Xvfb keeps its picture: a copy takes milliseconds, where a program that asks the server
        for it takes as long as a step of the injection."""
        self.frames = []  # of (state, path)
        self._begin = self._end = None  # s of wall time
        self._folder, self._screen = folder, screen

    def take(self, state):
        self._end = time.monotonic()
        self._begin = self._begin or self._end
        path = self._folder / f'{len(self.frames):03}.xwd'
        shutil.copyfile(self._screen, path)
        self.frames.append((state, path))

    def last_of(self, state):
        """@raises PicturesError when no frame was taken in this state."""
        path = next((path for name, path in reversed(self.frames) if name == state), None)
        if path is None:
            raise PicturesError(f'no frame was taken in the state {state}: the machine is too slow')
        return path

    def animate(self, path):
        """@raises PicturesError when the animation is too large or convert fails."""
        period = (self._end - self._begin) / max(1, len(self.frames) - 1)
        frames = [f'xwd:{frame}' for _, frame in self.frames]
        command = ['convert', '-loop', '0', '-delay', str(round(100 * period)), *frames[:-1], '-delay', PAUSE, frames[-1], '-crop',
                   f'{SIZE[0]}x{SIZE[1] - MENU - 20}+0+{MENU}', '+repage', '-resize', '68%', '+dither', '-colors', '48',
                   '-layers', 'optimize', str(path)]
        if subprocess.run(command, check=False, timeout=600).returncode != 0:
            raise PicturesError('ImageMagick could not make the animation')
        if path.stat().st_size > LARGEST:
            raise PicturesError(f'{path} has {path.stat().st_size} bytes, at most {LARGEST:.0f} are allowed')


def say(text):
    print(f'pictures: {text}', flush=True)


def demo(out, logs):
    say('the scene and the plot, by the demo')
    command = [sys.executable, str(ROOT / 'src/tools/demo.py'), '--out', str(logs / 'demo'), '--close', '--no-judge']
    environment = {name: value for name, value in os.environ.items() if name != 'DISPLAY'}
    if subprocess.run(command, check=False, env=environment).returncode != 0:
        raise PicturesError('the demo failed, see above')
    for name in ('scene.png', 'force_depth.png'):
        shutil.copyfile(logs / 'demo' / name, out / name)


def record(session, recording):
    """A whole injection, step by step."""
    injection = Injection()
    if not wait_until(injection.waits, PATIENCE):
        raise PicturesError('the controller is silent')
    time.sleep(SETTLE)
    for step in STEPS:
        say(step)
        before = injection.changes
        injection.say(step)
        end, begun = time.monotonic() + PATIENCE, False  # the state has changed since
        while not (begun and injection.waits()):
            if time.monotonic() > end:
                raise PicturesError(f'{step} does not end: {injection.status}')
            session.check()
            recording.take(injection.status.state)
            begun = injection.changes > before
            time.sleep(PERIOD)
    recording.take('idle')
    if injection.status.outcome != 'injected':
        raise PicturesError(f'the injection ended with {injection.status.outcome}')


def console(out, logs):
    say('a session with the console')
    os.environ.pop('DISPLAY', None)
    keys = {'hand.device': 'none', 'injection.mode': 'semi_automatic', 'camera.source': 'sim', 'display.markers': 'false',
            'cell': 'mouse_oocyte_injection',
            **{f'overrides.injection_controller.motion.{key}': value for key, value in SLOW.items()}}
    command = ['roslaunch', str(ROOT / 'launch/session.launch'), 'console:=inject', 'only:=display rviz']

    def start_view(environment):
        return Child(command, logs / 'rviz.log', {**os.environ, **environment})

    with console_pictures.seen_session(logs, SIZE, keys, start_view) as (session, _):
        session.monitor.go()
        recording = Recording(Path(tempfile.mkdtemp(dir=logs)), logs / 'Xvfb_screen0')
        record(session, recording)
    recording.animate(logs / 'injection.gif')
    subprocess.run(['convert', f"xwd:{recording.last_of('indent')}", str(out / 'console.png')], check=True, timeout=60)
    shutil.copyfile(logs / 'injection.gif', out / 'injection.gif')


def consoles(out, logs):
    """Each in a process of its own. @raises PicturesError"""
    failed = []
    for name in console_pictures.CONSOLES:
        for width, height in console_pictures.SIZES:
            say(f'console:={name} at {width} x {height}')
            command = [sys.executable, '-B', console_pictures.__file__, name, str(width), str(height), str(out), str(logs)]
            if subprocess.run(command, check=False).returncode != 0:
                failed.append(f'{name} at {width} x {height}')
    if failed:
        raise PicturesError(f'no picture of {", ".join(failed)}')


def main():
    parser = argparse.ArgumentParser(prog='./dev pictures --', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, help='folder of the pictures (.readme)')
    parser.add_argument('--only-console', action='store_true', help='leave out what the demo makes')
    parser.add_argument('--consoles', action='store_true', help='instead: a picture of every console at 1280 x 800 and 1920 '
                        'x 1080 with a session that runs, in out/consoles or --out')
    arguments = parser.parse_args()
    out, logs = (arguments.out or ROOT / ('out/consoles' if arguments.consoles else '.readme')).resolve(), ROOT / 'out/pictures'
    shutil.rmtree(logs, ignore_errors=True)
    logs.mkdir(parents=True)
    out.mkdir(parents=True, exist_ok=True)
    try:
        if arguments.consoles:
            consoles(out, logs)
        else:
            if not arguments.only_console:
                demo(out, logs)
            console(out, logs)
    except (PicturesError, SessionError, RuntimeError, OSError, subprocess.SubprocessError) as error:
        print(f'pictures: {error}', file=sys.stderr)
        return 1
    say(f'they are in {out}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
