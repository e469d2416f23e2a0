#!/usr/bin/python3
"""A synthetic user at the operator's console: time from roslaunch to an injected cell by mouse only, and from STOP to rest.

Each run starts session.launch with console:=inject on a virtual display, presses Approach, Indent, Inject and Withdraw as
soon as each is offered in the picture, and waits for the outcome. Then it approaches again and again and presses STOP
(in turn by mouse and by space bar) after a random time: counted from the press are the command's arrival and the last
motion of the needle. rviz draws in software: the press waits for its frame. In the end a console is closed, one hangs
(SIGSTOP) and one is killed, each while the needle is in the cell: the 1 kHz loop before and after, and the injection's end.
"""
import argparse
import csv
import json
import os
import random
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'tools'))
sys.path.insert(0, str(ROOT / 'test' / 'chain'))
sys.path.insert(0, str(ROOT / 'benchmark' / 'common'))
sys.path.insert(0, str(ROOT / 'launch'))

import console_eye  # noqa: E402
import console_faults  # noqa: E402
from demo_session import DemoSession, SessionError  # noqa: E402
from processes import wait_until  # noqa: E402
from screen import Screen  # noqa: E402

PATIENCE = 120   # s for each step of the user
ALLOWED = 60     # s, from roslaunch to the outcome
REACTION = 0.5   # s of a person, in which the console draws the state that has just changed
REST = 0.1e-6    # m from where the needle rests in the end: nearer, it rests
SEED = 100001


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of console.csv')
    parser.add_argument('--runs', type=int, default=5, help='sessions (default 5)')
    parser.add_argument('--stops', type=int, default=10, help='of each session (default 10)')
    parser.add_argument('--cell', default='mouse_oocyte_injection', help='name in config/cells (default %(default)s)')
    parser.add_argument('--seconds', type=float, default=20, help='before and after each fault of a console (default 20)')
    parser.add_argument('--only', help='run of this number, or this fault; rospy knows one master in a process')
    return parser.parse_args()


def say(text):
    print(f'console: {text}', flush=True)


class User:
    """Looks at the screen and presses buttons."""

    def __init__(self, environment, folder):
        import rospy  # late: it takes the master's address from the environment at once
        from cell_microinjection.msg import InjectionStatus, OperatingState, StringStamped
        from geometry_msgs.msg import PoseStamped
        self._environment, self._picture = environment, folder / 'screen.png'
        self.status = self.operating = None
        self.commands, self.heights = [], []  # (s, command); (s, m) of the needle
        follow = rospy.Subscriber
        self._subscribers = [
            follow('/controller/injection_state', InjectionStatus, lambda m: setattr(self, 'status', m)),
            follow('/controller/operating_state', OperatingState, lambda m: setattr(self, 'operating', m.state)),
            follow('/controller/state_command', StringStamped,
                   lambda m: self.commands.append((time.monotonic(), m.string))),
            follow('/needle/measured_cp', PoseStamped,
                   lambda m: self.heights.append((time.monotonic(), m.pose.position.z)), tcp_nodelay=True)]

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def look(self):
        try:
            return console_eye.look(self._picture, self._environment)
        except console_eye.NotSeen:
            return None

    def wait(self, condition, what):
        if not wait_until(condition, PATIENCE, period=0.02):
            raise SessionError(f'{what}: not within {PATIENCE} s; the controller is {self.operating}, {self.status}')

    def press(self, button):
        seen = []

        def offered():
            console = self.look()
            if console and console.offered[button]:
                seen.append(console)
            return bool(seen)
        self.wait(offered, f'{button} offered')
        before = len(self.commands)
        self.do('mousemove', *seen[0].place[button], 'click', 1)
        self.wait(lambda: len(self.commands) > before, f'a command of {button}')
        return seen[0]

    def do(self, *words):
        subprocess.run(['xdotool', *map(str, words)], env=self._environment, check=True, timeout=60)

    def inject(self):
        self.press('Approach')
        for button in ('Indent', 'Inject'):
            self.press(button)
        # Withdraw is offered all the time, and gives up what is under way: the user waits as the headline tells.
        self.wait(lambda: self.status.waits and self.status.volume > 0, 'the injected cell')
        self.press('Withdraw')
        self.wait(lambda: self.status.state == 'idle', 'the needle out of the cell')
        return self.status.outcome

    def stop(self, by_key, after):
        """(s from the press to the command, s to rest)."""
        self.wait(lambda: self.status.state == 'idle' and self.operating == 'ENABLED', 'idle')
        console = self.press('Approach')
        self.wait(lambda: self.status.state == 'approach', 'the approach')
        time.sleep(after)
        before, self.heights = len(self.commands), self.heights[-1:]
        if not by_key:
            self.do('mousemove', *console.stop)
        pressed = time.monotonic()
        self.do(*(('key', 'space') if by_key else ('click', 1)))
        self.wait(lambda: self.operating == 'PAUSED', 'PAUSED')
        time.sleep(0.5)
        final = self.heights[-1][1]
        moving = [at for at, height in self.heights if at > pressed and abs(height - final) > REST]
        sent = self.commands[before][0]
        self.press('Withdraw')
        # It was paused by a person and is so again at its start.
        self.wait(lambda: self.status.state == 'idle' and self.operating == 'PAUSED', 'the needle at its start')
        time.sleep(REACTION)
        self.press('Enable')
        return sent - pressed, max(moving, default=sent) - pressed


def session_keys(cell):
    return {'cell': cell, 'injection.layers': 2 if cell == 'mouse_oocyte_injection' else 1, 'hand.device': 'none',
            'injection.mode': 'semi_automatic'}


def run(arguments):
    """Returns {"injected": s to the injected cell, "stops": [(by key, s to the command, s to rest)]}."""
    logs = arguments.out / 'console_log' / str(arguments.only)
    logs.mkdir(parents=True, exist_ok=True)
    rng = random.Random(SEED + int(arguments.only))
    screen = Screen(logs / 'xvfb.log', (1280, 800))
    os.environ.update(screen.environment)
    begin = time.monotonic()
    session = DemoSession(ROOT / 'launch' / 'session.launch', logs, {**session_keys(arguments.cell), 'display.console': 'inject'})
    user = None
    try:
        session.wait_ready()
        user = User(dict(os.environ), logs)
        outcome = user.inject()
        took = time.monotonic() - begin
        if outcome != 'injected':
            raise SessionError(f'outcome {outcome}: {user.status.reason}')
        return {'injected': took, 'stops': [(key, *user.stop(key, rng.uniform(0.2, 0.8)))
                                            for key in (bool(i % 2) for i in range(arguments.stops))]}
    finally:
        if user:
            user.close()
        session.stop()
        screen.close()


def run_all(arguments, names):
    """Each run in a process of its own. Returns the results of those that succeeded."""
    results = []
    for name in names:
        done = subprocess.run([sys.executable, '-B', __file__, '--out', str(arguments.out), '--only', str(name), '--stops',
                               str(arguments.stops), '--cell', arguments.cell, '--seconds', str(arguments.seconds)],
                              stdout=subprocess.PIPE, text=True)
        if done.returncode:
            continue
        results.append(json.loads(done.stdout.splitlines()[-1]))
        if 'injected' in results[-1]:
            say(f'run {name}: injected after {results[-1]["injected"]:.1f} s')
    return results


def report(arguments, results):
    """Returns whether every run was quick enough."""
    times = [result['injected'] for result in results]
    stops = [stop for result in results for stop in result['stops']]
    with open(arguments.out / 'console.csv', 'w', encoding='utf-8', newline='') as file:
        rows = csv.writer(file, lineterminator='\n')
        rows.writerow(['what', 'seconds', 'to_rest_seconds'])
        rows.writerows(['injected', f'{took:.1f}', ''] for took in times)
        rows.writerows([f'stop by {"key" if key else "mouse"}', f'{sent:.4f}', f'{rest:.4f}'] for key, sent, rest in stops)
    print(f'{len(times)} of {arguments.runs} runs injected; longest {max(times, default=0):.1f} s, allowed {ALLOWED} s')
    for what, values in (('to the command', [sent for _, sent, _ in stops]), ('to rest', [rest for *_, rest in stops])):
        if values:
            print(f'STOP {what}: median {1e3 * statistics.median(values):.0f} ms, longest {1e3 * max(values):.0f} ms of '
                  f'{len(values)}')
    return len(times) == arguments.runs and max(times, default=0) <= ALLOWED


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    os.environ.pop('DISPLAY', None)  # never the user's: the mouse is the benchmark's
    if arguments.only is None:
        good = report(arguments, run_all(arguments, range(arguments.runs)))
        faults = run_all(arguments, console_faults.FAULTS)
        good = console_faults.report(faults) and len(faults) == len(console_faults.FAULTS) and good
        sys.exit(0 if good else 1)
    try:
        if arguments.only in console_faults.FAULTS:
            result = console_faults.run(arguments.out, session_keys(arguments.cell), arguments.only, arguments.seconds)
        else:
            result = run(arguments)
        print(json.dumps(result))
    except (SessionError, OSError, subprocess.SubprocessError) as error:
        sys.exit(f'console: run {arguments.only} failed: {error}')


if __name__ == '__main__':
    main()
