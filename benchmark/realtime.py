#!/usr/bin/python3
"""A live session's 1 kHz: lateness of the cell simulator's periods beside a bare timer loop of the same run.

A period is the time from one step of the cell simulator to its next, measured in the node: a step follows the needle's
pose through the whole chain from the hand, so that what any node of the chain is late by is in it. It is late by what it
has more than 1 ms. The bare loop sleeps for 1 ms at a time in the session recorder's process, in real time (SCHED_RR) as
the chain's nodes are, and shows what the machine allows. The surrogate cell is indented and left again and again; rviz
draws it, with the operator's console where one is named. Also told: the resident memory of the cell simulator at begin
and end, and the processor time of the thread in which rviz draws and the console works.
"""
import argparse
import csv
import os
import sys
import tempfile
import time
import xmlrpc.client
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'tools'))

import full_solution  # noqa: E402
import yaml_file  # noqa: E402
from demo_session import DemoSession, SessionError  # noqa: E402
from processes import wait_until  # noqa: E402
from rviz_view import RvizError, RvizView, write_console  # noqa: E402

SOURCES = {'cell_simulator': 'cell_simulator: cycle', 'bare_timer_loop': 'session_recorder: bare timer loop'}
PERIOD = 1e-3     # s
ALLOWED = 1e-3    # share of late periods beyond the bare loop's
SETTLE = 5        # s after the hand has begun, not counted
RVIZ_TIMEOUT = 90  # s
HELD = {'holder': 'sim', 'overrides.holder.balance': -2000}  # Pa


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of realtime.csv')
    parser.add_argument('--seconds', type=float, default=60, help='that are measured (default 60)')
    parser.add_argument('--cell', default='mouse_oocyte_pipette', help='name in config/cells (default %(default)s)')
    parser.add_argument('--model', default='surrogate', choices=('surrogate', 'live', 'auto'), help='default %(default)s')
    parser.add_argument('--console', default='', help="rviz with the operator's console, name in config/console")
    parser.add_argument('--holder', action='store_true', help='the cell, one with a mouth, is held by suction')
    parser.add_argument('--rate', type=int, default=2, help='Hz, of the scene in rviz on a virtual display (default 2)')
    parser.add_argument('--freeze', action='store_true', help='rviz is stopped (SIGSTOP) while it is measured')
    parser.add_argument('--no-rviz', action='store_true', help='display node, but nobody who draws')
    return parser.parse_args()


def say(text):
    print(f'realtime: {text}', flush=True)


def write_motion(path, seconds):
    """Writes a hand motion whose path to the cell and back is repeated until `seconds` are over."""
    motion = yaml_file.read(ROOT / 'config' / 'hand_motions' / 'indent_and_retract.yaml')
    path_of_hand = motion['path']
    free = 1 + max(number for number, waypoint in enumerate(path_of_hand) if waypoint.get('clutch'))
    again = path_of_hand[free:]  # begins and ends where the clutch was released
    while sum(waypoint['duration'] for waypoint in path_of_hand) < seconds:
        path_of_hand = path_of_hand + again
    path.write_text(yaml.safe_dump({**motion, 'path': path_of_hand}), encoding='utf-8')


class Histograms:
    """The newest histograms that the nodes tell on /diagnostics, since their start. `sources`: name -> status."""

    def __init__(self, sources):
        import rospy  # late: it takes the master's address from the environment at once
        from diagnostic_msgs.msg import DiagnosticArray
        self.newest = {}
        self._sources = sources
        self._subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics, queue_size=100)

    def _on_diagnostics(self, message):
        for status in message.status:
            for source, name in self._sources.items():
                if status.name != name:
                    continue
                values = {pair.key: pair.value for pair in status.values}
                bins = (entry.split(':') for entry in values['intervals up to (s):count'].split())
                self.newest[source] = (
                    int(values['intervals since the start']), int(values['intervals of more than two periods']),
                    {float(upper): int(count) for upper, count in bins})

    def complete(self):
        return set(self.newest) == set(self._sources)


def difference(before, after):
    """What was added to a histogram (count, late, {upper edge: count}) from `before` to `after`."""
    bins = {upper: count - before[2].get(upper, 0) for upper, count in after[2].items()}
    return after[0] - before[0], after[1] - before[1], {upper: count for upper, count in bins.items() if count}


def resident_memory(node):
    """Resident memory of a node's process, bytes."""
    with xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI']) as master:
        address = master.lookupNode('/realtime', node)[2]
    with xmlrpc.client.ServerProxy(address) as slave:
        pid = slave.getPid('/realtime')[2]
    with open(f'/proc/{pid}/statm', encoding='utf-8') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE')


def start_rviz(session, logs, console, rate):
    """Returns rviz, drawing, or None where it cannot."""
    try:
        config = ROOT / 'config' / 'session.rviz'
        if console:
            config = logs / f'console_{console}.rviz'
            write_console(console, config)
        view = RvizView(config, logs, rate)
    except RvizError as error:
        say(f'without rviz: {error}')
        return None
    if not wait_until(lambda: session.monitor.has_subscriber('/viz/markers'), RVIZ_TIMEOUT, period=0.5):
        view.close()
        raise SessionError('rviz did not subscribe to /viz/markers')
    return view


def measure(session, seconds, view, freeze):
    """Returns the histograms of `seconds` of a session that has begun, the memory (bytes) at begin and end, and the share
    of a processor that rviz's first thread has used."""
    histograms = Histograms(SOURCES)
    time.sleep(SETTLE)
    if not wait_until(histograms.complete, 20):
        raise SessionError(f'no histograms came but of {sorted(histograms.newest)}')
    if freeze:
        view.freeze(True)
    drawn = view.drawing_time() if view else 0
    before, memory = dict(histograms.newest), [resident_memory('/cell_simulator')]
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        session.check()
        time.sleep(min(1, max(0, end - time.monotonic())))
    memory.append(resident_memory('/cell_simulator'))
    share = (view.drawing_time() - drawn) / seconds if view else 0
    if freeze:
        view.freeze(False)
    return {source: difference(before[source], histograms.newest[source]) for source in SOURCES}, memory, share


def run(arguments, folder):
    logs = arguments.out / 'realtime_log'
    logs.mkdir(parents=True, exist_ok=True)
    motion = folder / 'motion.yaml'
    write_motion(motion, arguments.seconds + SETTLE + 30)
    session = DemoSession(ROOT / 'launch' / 'session.launch', logs, {
        'cell': arguments.cell, 'model': arguments.model, 'hand.motion': motion, 'record.folder': folder / 'record',
        'record.bag': 'false', **(HELD if arguments.holder else {})})
    view = None
    try:
        session.wait_ready()
        view = None if arguments.no_rviz else start_rviz(session, logs, arguments.console, arguments.rate)
        session.monitor.go()
        say(f'measuring for {arguments.seconds:g} s')
        return measure(session, arguments.seconds, view, arguments.freeze and view)
    finally:
        if view:
            view.close()
        session.stop()


def write_table(path, measured):
    """Writes both histograms. @return the share of periods late by more than PERIOD, by source."""
    shares = {source: late / max(1, count) for source, (count, late, _) in measured.items()}
    uppers = sorted({upper for _, _, bins in measured.values() for upper in bins})
    rows = [['what', 'lateness_ms', *SOURCES],
            ['periods', '', *(measured[source][0] for source in SOURCES)],
            ['late_by_more', 1e3 * PERIOD, *(measured[source][1] for source in SOURCES)],
            ['share_late_by_more', 1e3 * PERIOD, *(f'{shares[source]:.3g}' for source in SOURCES)]]
    # Bins are 2 % of the interval wide, from the bin before.
    rows += [['bin_up_to', f'{1e3 * (upper - PERIOD):.4f}', *(measured[source][2].get(upper, 0) for source in SOURCES)]
             for upper in uppers]
    with open(path, 'w', encoding='utf-8', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows(rows)
    return shares


def report(measured, memory, share, shares):
    for source, (count, late, bins) in measured.items():
        print(f'{source:<16} {count:7d} periods, {late:5d} late by more than 1 ms ({100 * shares[source]:.3f} %), '
              f'longest {1e3 * max(bins, default=0):.1f} ms')
    beyond = shares['cell_simulator'] - shares['bare_timer_loop']
    verdict = 'within' if beyond <= ALLOWED else 'NOT within'
    print(f'difference       {100 * beyond:+.3f} %, {verdict} {100 * ALLOWED:g} %')
    print(f'cell_simulator: {memory[0] / 2**20:.1f} MiB resident at the begin, {memory[1] / 2**20:.1f} MiB at the end')
    print(f"rviz: {100 * share:.1f} % of a processor in the thread that draws")


def main():
    arguments = parse_arguments()
    scene = ROOT / 'config' / 'cells' / f'{arguments.cell}.yaml'
    if arguments.model == 'surrogate' and not full_solution.prepare(scene):
        sys.exit(f'realtime: {scene} cannot be prepared, see above')
    with tempfile.TemporaryDirectory() as folder:
        try:
            measured, memory, share = run(arguments, Path(folder))
        except (SessionError, OSError) as error:
            sys.exit(f'realtime: {error}')
    report(measured, memory, share, write_table(arguments.out / 'realtime.csv', measured))


if __name__ == '__main__':
    main()
