#!/usr/bin/python3
"""Hand to hand: time from a haptic device's pose to the force that comes back to it, for each kind of device.

An emulated device tells its pose at 1 kHz through its driver's topics (CRTK, phantom_omni, ros_geomagic) while a
virtual hand indents the cell again and again. Counted is the first force that depends on a pose: when the bridge's step began
that renders it, and when it had come to the device, adapter and all messages between included. Beside it the intervals
of a bare loop at 1 kHz of the same run, which show what the machine allows.
"""
import argparse
import csv
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'tools'))
sys.path.insert(0, str(ROOT / 'benchmark'))

import full_solution  # noqa: E402
import rospy  # noqa: E402
from demo_session import DemoSession, SessionError  # noqa: E402
from processes import Child, wait_until  # noqa: E402
from realtime import SETTLE, Histograms, difference, write_motion  # noqa: E402

HAPTIC = {'crtk': 'external', 'omni': 'omni', 'geomagic': 'geomagic'}  # kind of device -> hand.device of the session
ALLOWED = 2e-3  # s, 99 % of the round trips
SOURCES = {'device to bridge': 'emulated_haptic: device to bridge',
           'device to device': 'emulated_haptic: device to device',
           'bare loop at 1 kHz': 'session_recorder: bare timer loop'}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of latency.csv')
    parser.add_argument('--seconds', type=float, default=30, help='that are measured of each device (default 30)')
    parser.add_argument('--cell', default='mouse_oocyte_pipette', help='name in config/cells (default %(default)s)')
    parser.add_argument('--model', default='surrogate', choices=('surrogate', 'live', 'auto'), help='default %(default)s')
    parser.add_argument('--devices', default=','.join(HAPTIC), help='default %(default)s')
    arguments = parser.parse_args()
    arguments.devices = arguments.devices.split(',')
    for kind in arguments.devices:
        if kind not in HAPTIC:
            parser.error(f'--devices: "{kind}" is none of {", ".join(HAPTIC)}')
    return arguments


def say(text):
    print(f'latency: {text}', flush=True)


def quantile(bins, share):
    """s, from {upper edge: count} with bins 2 % wide."""
    count, target = 0, share * sum(bins.values())
    for upper in sorted(bins):
        count += bins[upper]
        if count >= target:
            return 0.99 * upper  # the middle of the bin
    return float('nan')


def check_runs(device):
    if not device.running():
        raise SessionError(f'the device has ended: {device.tail(5)}')


def measure(kind, arguments, folder):
    """Returns {what: (count, late, {upper edge in s: count})} of one device."""
    logs = arguments.out / 'log'
    logs.mkdir(parents=True, exist_ok=True)
    motion = folder / 'motion.yaml'
    write_motion(motion, arguments.seconds + SETTLE + 30)
    session = DemoSession(ROOT / 'launch' / 'session.launch', logs, {
        'cell': arguments.cell, 'model': arguments.model, 'hand.device': HAPTIC[kind],
        'record.folder': folder / f'record_{kind}', 'record.bag': 'false'})
    device = None
    try:
        session.wait_ready()
        rospy.set_param('/publish_rate', 1000)  # Hz, of ros_geomagic, as the guide says; 100 by default
        device = Child(['rosrun', 'cell_microinjection', 'emulated_haptic', f'_kind:={kind}', f'_motion:={motion}'],
                       logs / 'device.log')
        histograms = Histograms(SOURCES)
        time.sleep(SETTLE)
        complete = wait_until(histograms.complete, 20)
        check_runs(device)
        if not complete:
            raise SessionError(f'no histograms came but of {sorted(histograms.newest)}; see {logs}')
        before = dict(histograms.newest)
        end = time.monotonic() + arguments.seconds
        while time.monotonic() < end:
            session.check()
            check_runs(device)
            time.sleep(min(1, max(0, end - time.monotonic())))
        return {source: difference(before[source], histograms.newest[source]) for source in SOURCES}
    finally:
        if device:
            device.stop(10)
        session.stop()


HEADER = ['device', 'what', 'samples', 'median_ms', 'p99_ms', 'longest_ms', 'load_average', 'verdict']


def verdict(good):
    return f'{"within" if good else "NOT within"} {1e3 * ALLOWED:g} ms'


def rows_of(kind, arguments):
    """Measures one device."""
    load = os.getloadavg()[0]
    say(f'{kind} for {arguments.seconds:g} s; the load average of the machine before is {load:.2f}')
    with tempfile.TemporaryDirectory() as folder:
        try:
            measured = measure(kind, arguments, Path(folder))
        except (SessionError, OSError) as error:
            sys.exit(f'latency: {error}')
    rows = []
    for source, (count, _, bins) in measured.items():
        p99 = quantile(bins, 0.99)
        rows.append([kind, source, count, f'{1e3 * quantile(bins, 0.5):.3f}', f'{1e3 * p99:.3f}',
                     f'{1e3 * max(bins, default=0):.3f}', f'{load:.2f}',
                     verdict(count > 0 and p99 <= ALLOWED) if source == 'device to device' else ''])
    return rows


def rows_of_each(arguments):
    """Each device in a process of its own, since a process can talk to one ROS master only."""
    rows = []
    for kind in arguments.devices:
        folder = arguments.out / 'latency_log' / kind
        subprocess.run([sys.executable, __file__, '--out', str(folder), '--seconds', str(arguments.seconds), '--cell',
                        arguments.cell, '--model', arguments.model, '--devices', kind], check=True)
        with open(folder / 'latency.csv', encoding='utf-8', newline='') as file:
            rows += list(csv.reader(file))[1:]
    good = all(row[-1] == verdict(True) for row in rows if row[1] == 'device to device')
    return rows + [['all', 'device to device', '', '', '', '', '', verdict(good)]]


def main():
    arguments = parse_arguments()
    scene = ROOT / 'config' / 'cells' / f'{arguments.cell}.yaml'
    if arguments.model == 'surrogate' and not full_solution.prepare(scene):
        sys.exit(f'latency: {scene} cannot be prepared, see above')
    arguments.out.mkdir(parents=True, exist_ok=True)
    try:
        rows = rows_of(arguments.devices[0], arguments) if len(arguments.devices) == 1 else rows_of_each(arguments)
    except subprocess.CalledProcessError as error:
        sys.exit(error.returncode)
    rows = [HEADER, *rows]
    with open(arguments.out / 'latency.csv', 'w', encoding='utf-8', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows(rows)
    widths = [max(len(str(row[column])) for row in rows) for column in range(len(HEADER))]
    for row in rows:
        print('  '.join(str(cell).ljust(width) for cell, width in zip(row, widths)).rstrip())


if __name__ == '__main__':
    main()
