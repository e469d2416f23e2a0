#!/usr/bin/python3
"""Runs a session: the virtual hand approaches, touches, indents, punctures, injects and retracts.

Leaves in the output folder: force_depth.csv and force_depth.png (force against depth, and the course of the
injection), scene.png (rviz while the needle rests in the dent), session.bag, summary.yaml (rates and latency),
force_error.csv (against the full solution along the same way in, up to the puncture), with --trainee training.yaml
and training.png, and log/. Exit code 1 when one of them is missing (but the last) or a node died, or when the default
motion in the default cell ended without puncture, injection or withdrawal.
"""
import argparse
import os
import shutil
import signal
import sys
import time
from pathlib import Path

import demo_summary
import full_solution
import plot_force_depth
from demo_session import DemoSession, SessionError
from processes import wait_until
from rviz_view import RvizError, RvizView
from session_monitor import Progress

ROOT = Path(os.environ.get('MICROINJECTION_ROOT') or Path(__file__).resolve().parents[2])
CELL = 'mouse_oocyte_tough'  # its puncture follows from its toughness
MOTION = ROOT / 'config' / 'hand_motions' / 'puncture_and_inject.yaml'
OUT = ('idle', 'approach')  # states of an injection whose needle is out of the cell
RESULTS = ('force_depth.csv', 'force_depth.png', 'scene.png', 'session.bag', 'summary.yaml')

TRAINING = ('training.yaml', 'training.png')  # with --trainee

RVIZ_TIMEOUT = 90    # s of wall time, for rviz to come up
PHASE_TIMEOUT = 300  # s, for a phase of the motion
SETTLE = 0.8         # s, for rviz to draw what the nodes have just said
RATES = (1000, 200, 50)  # Hz, largest of all loops: those of config, and what a slower computer gets


class DemoError(Exception):
    """What went wrong, for the user."""


class TooSlow(Exception):
    """This computer does not keep the `rate` (Hz) of the loops of these nodes."""

    def __init__(self, rate, nodes):
        super().__init__(f'this computer does not keep loops of {rate:g} Hz ({", ".join(nodes)}): the demo begins again with '
                         'slower ones')
        self.rate = rate


def parse_arguments():
    parser = argparse.ArgumentParser(prog='./dev demo --', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, default=ROOT / 'out' / 'demo', help='folder of the results (%(default)s)')
    parser.add_argument('--cell', default=CELL,
                        help='name in config/cells, or path of a scene file (%(default)s)')
    parser.add_argument('--model', choices=('auto', 'surrogate', 'live', 'explicit'), default='auto',
                        help='surrogate: converged force, of a family or made ready first (minutes, once); live: P1 tetrahedra, at '
                        'once; auto: surrogate where the cell can be')
    parser.add_argument('--clock', choices=('wall', 'virtual'), default='wall',
                        help='wall: live nodes on wall time; virtual: all nodes in one process, many times faster, the same '
                        'bytes in each run, without rviz')
    parser.add_argument('--rate', type=float,
                        help='Hz, the largest rate of all loops (rate of a session); else those of config, or 200 or 50 where this '
                        'computer does not keep them')
    parser.add_argument('--tried', type=float, help=argparse.SUPPRESS)  # a rate that this computer did not keep
    parser.add_argument('--rig', default='sim',
                        help='sim, a real one: eppendorf, mp285, scientifica, sensapex, transferman, zaber; or emulated_ before '
                        'its name (%(default)s)')
    parser.add_argument('--haptic', choices=('virtual_hand', 'external', 'none'), default='virtual_hand',
                        help='who moves the hand; a session without the virtual hand ends with Ctrl-C')
    parser.add_argument('--motion', type=Path, default=MOTION,
                        help="file of the virtual hand's motion (%(default)s)")
    parser.add_argument('--trainee', default='', help='who trains: the session is scored, and compared with the '
                        'trainee\'s earlier ones in training.png')
    parser.add_argument('--no-rviz', action='store_true', help='no rviz and no scene.png')
    parser.add_argument('--no-judge', action='store_true',
                        help='do not compare with the full solution afterwards (a minute or two)')
    parser.add_argument('--close', action='store_true', help='close rviz when the session is over')
    arguments = parser.parse_args()
    if arguments.tried and not arguments.rate:
        arguments.rate = max(rate for rate in RATES if rate < arguments.tried)
    return arguments


def say(text):
    print(f'demo: {text}', flush=True)


class Demo:
    """One run. Whatever happens, close() takes everything down again."""

    def __init__(self, arguments):
        self._arguments = arguments
        self._out = arguments.out.resolve()
        self._logs = self._out / 'log'
        self._session = None
        self._view = None
        self._failed = ''

    def prepare(self):
        """Removes the results of the run before."""
        shutil.rmtree(self._logs, ignore_errors=True)
        self._logs.mkdir(parents=True)
        for name in (*RESULTS, *TRAINING, 'force_error.csv'):
            if (self._out / name).exists():
                (self._out / name).unlink()

        self._make_ready()

    def _scene(self):
        cell = Path(self._arguments.cell)
        return cell.resolve() if cell.is_file() else ROOT / 'config' / 'cells' / f'{self._arguments.cell}.yaml'

    def _make_ready(self):
        """The off-line stage; a cell that cannot be prepared is shown live."""
        if not self._scene().is_file():
            raise DemoError(f'--cell {self._arguments.cell}: there is no file {self._scene()}')
        if self._arguments.model == 'live':
            return
        if not self._arguments.tried:
            say('the off-line stage: takes minutes the first time, for a cell of no family')
        if not full_solution.prepare(self._scene()):
            if self._arguments.model == 'surrogate':
                raise DemoError('the cell cannot be prepared, see above')
            say('the cell cannot be prepared (see above): it will be live')
            self._arguments.model = 'live'

    def _keys(self):
        """The session's keys that differ from config/sessions/default.yaml."""
        return {'cell': self._scene(), 'model': self._arguments.model, 'rig.name': self._arguments.rig,
                'hand.device': self._arguments.haptic, 'hand.motion': self._arguments.motion.resolve(),
                'record.folder': self._out, 'record.trainee': self._arguments.trainee,
                **({'rate': self._arguments.rate} if self._arguments.rate else {})}

    def simulate(self):
        say('simulating the session on virtual time')
        if full_solution.simulate(self._keys()) != 0:
            raise DemoError('the session did not end well, see above')
        self._check_injection(demo_summary.injection(self._out / 'force_depth.csv'))

    def start(self):
        say(f'starting the session; its log is in {self._logs}')
        self._session = DemoSession(ROOT / 'launch' / 'session.launch', self._logs, self._keys())
        self._session.wait_ready()
        self._require_pace()
        if not self._arguments.no_rviz:
            self._start_rviz()
            self._require_pace()
        self._session.monitor.go()

    def _require_pace(self):
        """@raises TooSlow when this computer does not keep the rate, and there is a slower one"""
        rate, chosen = self._arguments.rate or RATES[0], self._arguments.rate and not self._arguments.tried
        if chosen or rate <= RATES[-1]:
            return
        slow = self._session.too_slow()
        if slow:
            raise TooSlow(rate, slow)

    def _start_rviz(self):
        try:
            self._wait_for_rviz()
        except RvizError:
            if not self._view or not self._view.virtual:
                raise
            # It has crashed in its own start, seldom, before it showed anything.
            say('rviz has ended; once more')
            self._view.close()
            self._wait_for_rviz()

    def _wait_for_rviz(self):
        self._view = RvizView(ROOT / 'config' / 'session.rviz', self._logs)
        say('starting rviz' + (' on a virtual display' if self._view.virtual else ''))

        def ready():
            self._session.check()
            self._view.check()
            return self._session.monitor.has_subscriber('/viz/markers')
        if not wait_until(ready, RVIZ_TIMEOUT, period=0.5):
            raise DemoError(f'rviz did not subscribe to /viz/markers within {RVIZ_TIMEOUT} s; see {self._logs}')

    def follow_operator(self):
        """Sees the session through; takes the picture while the needle is held at its deepest."""
        monitor, progress, pictured = self._session.monitor, Progress(), self._view is None
        while monitor.phase != 'done':
            self._session.check()
            if self._view and self._view.virtual:
                self._view.check()
            progress.show(monitor)
            if monitor.phase_age() > PHASE_TIMEOUT:
                raise DemoError(f'phase {monitor.phase} did not end within {PHASE_TIMEOUT} s')
            settled = monitor.phase == 'hold' and monitor.phase_age() > SETTLE
            if not pictured and (settled or monitor.phase == 'retract'):
                pictured = True
                self._view.picture(self._out / 'scene.png', 10, self._session.check)
            time.sleep(0.1)
        progress.show(monitor)
        progress.end()
        self._check_injection(monitor)

    def _check_injection(self, monitor):
        told = (f'membranes punctured: {monitor.punctures}, {1e15 * monitor.volume:.2f} pL injected, the needle is in '
                f'"{monitor.injection}"')
        say(told)
        whole = monitor.punctures > 0 and monitor.volume > 0 and monitor.injection in OUT
        if not whole and (self._arguments.cell, self._arguments.motion) == (CELL, MOTION):
            self._failed = f'the injection is not complete: {told}'

    def follow_hand(self):
        """Until Ctrl-C, or until rviz is closed; keeps a picture of the deepest indentation."""
        say('move the hand; Ctrl-C, or closing rviz, ends the session')
        monitor, progress, deepest = self._session.monitor, Progress(), -1.0
        try:
            while not self._view or self._view.running():
                self._session.check()
                progress.show(monitor)
                if self._view and monitor.state and monitor.state.indentation > deepest + 1e-6:
                    deepest = monitor.state.indentation
                    self._view.picture(self._out / 'scene.png', 5, self._session.check)
                time.sleep(0.1)
        except KeyboardInterrupt:
            pass
        progress.end()

    def end_session(self):
        """Stops the nodes; rviz stays when somebody looks at it."""
        if self._view and (self._view.virtual or self._arguments.close):
            self._view.close()
            self._view = None
        say('stopping the session')
        self._session.stop()

    def report(self):
        """Plots, prints the summary. @raises DemoError when a result is missing."""
        csv = self._out / 'force_depth.csv'
        if csv.is_file() and csv.stat().st_size > 0:
            plot_force_depth.plot(csv, self._out / 'force_depth.png', demo_summary.layers(self._out / 'summary.yaml'))
        if (self._out / 'summary.yaml').is_file():
            print(demo_summary.text(self._out / 'summary.yaml'), flush=True)
        if (self._out / 'training.yaml').is_file():
            print(demo_summary.training(self._out / 'training.yaml'), flush=True)
        if csv.is_file() and not self._arguments.no_judge:
            self._judge(csv)
        wanted = [name for name in RESULTS if not (name == 'scene.png' and self._arguments.no_rviz)]
        wanted += TRAINING[:1] if self._arguments.trainee else ()
        missing = [name for name in wanted if not (self._out / name).is_file() or not (self._out / name).stat().st_size]
        if missing:
            raise DemoError(f'missing or empty in {self._out}: {", ".join(missing)}; see {self._logs}')
        say(f'results are in {self._out}: {", ".join(wanted)}')
        if self._failed:
            raise DemoError(self._failed)

    def _judge(self, csv):
        say('comparing with the full solution along the way in, up to the puncture')
        verdict = full_solution.judge(self._scene(), csv, self._out / 'force_error.csv')
        print(f'  {verdict or "the full solution was lost on the way, or there was none: no comparison"}', flush=True)

    def leave_rviz_open(self):
        if not self._view:
            return
        say('rviz stays open; close it or press Ctrl-C')
        try:
            while self._view.running():
                time.sleep(0.2)
        except KeyboardInterrupt:
            pass

    def close(self):
        if self._view:
            self._view.close()
        if self._session:
            self._session.stop()


def simulate(demo, arguments):
    """The same session on virtual time, by the program simulate."""
    demo.prepare()
    demo.simulate()
    demo.report()


def interrupt(number, _frame):
    raise KeyboardInterrupt(signal.Signals(number).name)


def run(demo, arguments):
    demo.prepare()
    demo.start()
    if arguments.haptic == 'virtual_hand':
        demo.follow_operator()
    else:
        demo.follow_hand()
    demo.end_session()
    demo.report()
    demo.leave_rviz_open()


def main():
    arguments = parse_arguments()
    arguments.no_rviz = arguments.no_rviz or arguments.clock == 'virtual'
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    demo, tried = Demo(arguments), None
    try:
        (run if arguments.clock == 'wall' else simulate)(demo, arguments)
    except TooSlow as slow:
        say(slow)
        tried = slow.rate
    except (DemoError, SessionError, RvizError, full_solution.FullSolutionError, OSError) as error:
        sys.exit(f'demo: {error}')
    except KeyboardInterrupt:
        sys.exit('demo: interrupted')
    finally:
        # Taking down is bounded in time; a second Ctrl-C would leave processes behind.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        demo.close()
    if tried:
        # Another process: rospy keeps to the master that it has known first. An ignored signal would stay ignored in it.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.execv(sys.executable, [sys.executable, *sys.argv, '--tried', str(tried)])


if __name__ == '__main__':
    main()
