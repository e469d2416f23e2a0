#!/usr/bin/python3
"""A large surface in rviz, drawn in software, beside a live session: rates, processor time, and the 1 kHz loop meanwhile.

A surface of 10,000 triangles with a moving dent is published 30 times a second to the display node, beside a live session
at 1 kHz whose surrogate cell is indented and left again and again. rviz draws what the display node makes of it on a
virtual display. Counted are the messages of the display node, the frames of rviz (Mesa's own count, GALLIUM_HUD) and the
processor time of both; the periods of the cell simulator as in ./dev bench realtime, at first without any drawing.
"""
import argparse
import csv
import io
import math
import os
import re
import sys
import tempfile
import threading
import time
from pathlib import Path


ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'tools'))
sys.path.insert(0, str(ROOT / 'benchmark'))

import full_solution  # noqa: E402
import realtime  # noqa: E402
import yaml_file  # noqa: E402
from demo_session import DemoSession, SessionError  # noqa: E402
from processes import Child, wait_until  # noqa: E402
from rviz_view import RvizError, RvizView  # noqa: E402

SURFACE = '/bench/cell_state'  # the display node's /cell/state
SECTORS = 100         # of the sphere: 2 triangles for each on a ring, 1 on a cap
RADIUS, DENT = 40e-6, 15e-6  # m
LEAST_SURFACE = 50000  # bytes of a message with the surface
DENTS = 30            # surfaces that are shown in turn


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of display.csv')
    parser.add_argument('--seconds', type=float, default=30, help='that are measured, with and without (default 30)')
    parser.add_argument('--rate', type=int, default=30, help='Hz, of surfaces and of rviz (default 30)')
    parser.add_argument('--triangles', type=int, default=10000, help='of the surface, about (default 10000)')
    parser.add_argument('--size', type=int, default=700, help='px, width and height of the view (default %(default)s)')
    parser.add_argument('--cell', default='mouse_oocyte_pipette', help='name in config/cells (default %(default)s)')
    parser.add_argument('--cut', action='store_true', help='the display node cuts the surface open')
    return parser.parse_args()


def say(text):
    print(f'display: {text}', flush=True)


def sphere(rings):
    """@returns ([unit vector], [corner]) of a sphere, three corners a triangle, counter-clockwise seen from outside"""
    points = [(0.0, 0.0, 1.0)]
    for ring in range(1, rings):
        polar = math.pi * ring / rings
        around = (2 * math.pi * sector / SECTORS for sector in range(SECTORS))
        points += [(math.sin(polar) * math.cos(a), math.sin(polar) * math.sin(a), math.cos(polar)) for a in around]
    points.append((0.0, 0.0, -1.0))
    corners, last = [], len(points) - 1
    for sector in range(SECTORS):
        beside = (sector + 1) % SECTORS
        corners += [0, 1 + sector, 1 + beside]
        for ring in range(rings - 2):
            a, b = 1 + ring * SECTORS, 1 + (ring + 1) * SECTORS
            corners += [a + sector, b + sector, a + beside, a + beside, b + sector, b + beside]
        bottom = 1 + (rings - 2) * SECTORS
        corners += [last, bottom + beside, bottom + sector]
    return points, corners


class Surfaces:
    """Publishes one surface after the other in a thread of its own. They are made before, to cost little meanwhile."""

    def __init__(self, triangles, rate):
        import rospy  # late: it takes the master's address from the environment at once
        from cell_microinjection.msg import CellState
        points, corners = sphere(max(2, round(triangles / (2 * SECTORS)) + 1))
        self.triangles, self._period = len(corners) // 3, 1 / rate
        self._messages = [self._ready(points, corners, DENT * i / DENTS) for i in range(DENTS)]
        self._publisher = rospy.Publisher(SURFACE, CellState, queue_size=1)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @staticmethod
    def _ready(points, corners, dent):
        from cell_microinjection.msg import CellState
        from geometry_msgs.msg import Point32

        class Ready(CellState):
            """It is written as it was made."""

            def serialize(self, buff):
                buff.write(self.made)

        def depth(point):
            return dent * math.exp(-8 * (1 - point[2]))
        state = Ready(triangles=corners, converged=True)
        state.header.frame_id = 'cell'
        state.rest_vertices = [Point32(*(RADIUS * x for x in point)) for point in points]
        state.vertices = [Point32(RADIUS * x, RADIUS * y, RADIUS * z - depth((x, y, z))) for x, y, z in points]
        state.displacement = [depth(point) for point in points]
        state.parameter_names, state.parameter_values = ['young_modulus', 'poisson_ratio'], [10e3, 0.49]
        state.material, state.layer_radii = 'neo_hookean', [RADIUS, 0.9 * RADIUS]
        written = io.BytesIO()
        CellState.serialize(state, written)
        state.made = written.getvalue()
        return state

    def _run(self):
        number, due = 0, time.monotonic()
        while not self._ended.wait(max(0, due - time.monotonic())):
            self._publisher.publish(self._messages[number % DENTS])
            number, due = number + 1, max(due + self._period, time.monotonic())

    def close(self):
        self._ended.set()
        self._thread.join()


class DisplayNode:
    """The display node with the surface as its cell, and what it publishes."""

    def __init__(self, rate, cut, logs):
        import rospy
        settings = yaml_file.read(ROOT / 'config' / 'display.yaml')
        rospy.set_param('/display', {**settings, 'rate': rate, 'section': cut})
        self._process = Child(['nice', '-n', '10', 'rosrun', 'cell_microinjection', 'display', f'/cell/state:={SURFACE}'],
                              logs / 'display.log')
        self.drawn = 0
        # As bytes: to read so many points in Python would take longer than to draw them.
        self._subscriber = rospy.Subscriber('/viz/markers', rospy.AnyMsg, self._count, queue_size=10, buff_size=2**26)

    def _count(self, message):
        self.drawn += len(message._buff) > LEAST_SURFACE  # without the cell, a message has texts and arrows only

    def processor_time(self):
        return self._process.processor_time()  # nice and rosrun have become the node

    def close(self):
        self._subscriber.unregister()
        self._process.stop(20)


def frames(folder):
    """Frames a second that Mesa has counted, one number each half second; none where it does not count."""
    counted = [line for file in sorted(folder.glob('*fps*')) for line in file.read_text(encoding='utf-8').split()]
    return [float(line) for line in counted if re.fullmatch(r'[\d.]+', line)]


def measure(session, seconds, view=None, node=None, counts=None):
    """Figures of `seconds` of a session: periods of the loop, and of what draws."""
    histograms = realtime.Histograms(realtime.SOURCES)
    time.sleep(realtime.SETTLE)
    if not wait_until(histograms.complete, 20):
        raise SessionError(f'no histograms came but of {sorted(histograms.newest)}')

    def moment():
        drawing = (node.drawn, node.processor_time(), view.processor_time(), len(frames(counts))) if node else ()
        return time.monotonic(), dict(histograms.newest), drawing
    before = moment()
    end = before[0] + seconds
    while time.monotonic() < end:
        session.check()
        if view:
            view.check()
        time.sleep(min(1, max(0, end - time.monotonic())))
    after = moment()
    took = after[0] - before[0]
    figures = {}
    for source in realtime.SOURCES:
        count, late, _ = realtime.difference(before[1][source], after[1][source])
        figures[f'{source}: periods late by more than 1 ms'] = (100 * late / max(1, count), '%')
    if not node:
        return figures
    (drawn, display, rviz, first), (drawn_end, display_end, rviz_end, _) = before[2], after[2]
    shown = frames(counts)[first:]
    figures['display node: surfaces'] = ((drawn_end - drawn) / took, 'Hz')
    figures['display node: processor'] = (100 * (display_end - display) / took, '% of one')
    figures['rviz: frames'] = (sum(shown) / len(shown) if shown else math.nan, 'Hz')
    figures['rviz: processor'] = (100 * (rviz_end - rviz) / took, '% of one')
    return figures


def draw(session, arguments, logs, counts):
    """Figures while the surface is drawn."""
    os.environ.update(GALLIUM_HUD='fps', GALLIUM_HUD_VISIBLE='false', GALLIUM_HUD_DUMP_DIR=str(counts),
                      GALLIUM_HUD_PERIOD='0.5')
    os.environ.pop('DISPLAY', None)  # in software, whatever the user's display has
    surfaces = Surfaces(arguments.triangles, arguments.rate)
    say(f'{surfaces.triangles} triangles at {arguments.rate} Hz')
    node = view = None
    try:
        node = DisplayNode(arguments.rate, arguments.cut, logs)
        view = RvizView(ROOT / 'config' / 'session.rviz', logs, arguments.rate, (arguments.size, arguments.size))
        if not wait_until(lambda: frames(counts) or not view.running(), realtime.RVIZ_TIMEOUT, period=0.5):
            raise SessionError('Mesa counts no frames of rviz')
        if not wait_until(lambda: node.drawn > 0, realtime.RVIZ_TIMEOUT, period=0.5):
            raise SessionError('the display node draws no surface')
        return {'surface': (surfaces.triangles, 'triangles'), **measure(session, arguments.seconds, view, node, counts)}
    finally:
        if view:
            view.close()
        if node:
            node.close()
        surfaces.close()


def run(arguments, folder):
    """@returns [(what, without, with the surface, unit)]"""
    logs = arguments.out / 'display_log'
    logs.mkdir(parents=True, exist_ok=True)
    motion, counts = folder / 'motion.yaml', folder / 'frames'
    counts.mkdir()
    realtime.write_motion(motion, 2 * (arguments.seconds + realtime.SETTLE) + realtime.RVIZ_TIMEOUT)
    session = DemoSession(ROOT / 'launch' / 'session.launch', logs, {
        'cell': arguments.cell, 'model': 'surrogate', 'display.markers': 'false', 'hand.motion': motion,
        'record.folder': folder / 'record', 'record.bag': 'false'})
    try:
        session.wait_ready()
        session.monitor.go()
        say(f'measuring for {arguments.seconds:g} s without anything that draws')
        without = measure(session, arguments.seconds)
        drawn = draw(session, arguments, logs, counts)
        return [(what, without.get(what, ('',))[0], value, unit) for what, (value, unit) in drawn.items()]
    finally:
        session.stop()


def main():
    arguments = parse_arguments()
    scene = ROOT / 'config' / 'cells' / f'{arguments.cell}.yaml'
    if not full_solution.prepare(scene):
        sys.exit(f'display: {scene} cannot be prepared, see above')
    with tempfile.TemporaryDirectory() as folder:
        try:
            rows = run(arguments, Path(folder))
        except (SessionError, RvizError, OSError) as error:
            sys.exit(f'display: {error}')
    with open(arguments.out / 'display.csv', 'w', encoding='utf-8', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows([('what', 'without', 'with', 'unit'), *rows])
    for what, without, value, unit in rows:
        beside = '' if without == '' else f' ({without:.3f} without)'
        print(f'{what:<55} {value:10.3f} {unit}{beside}')


if __name__ == '__main__':
    main()
