#!/usr/bin/python3
"""What Python costs beside C++: forces of arrays and of single tips, import, and steps of the tasks for programs.

Ratios within one run, C++ and Python in turn; medians of several runs, with the lowest and the highest. Nothing else should run
beside it.
"""
import argparse
import csv
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy

from cell_microinjection import Cell, gym

ROOT = Path(__file__).resolve().parents[1]
TIPS = 20000


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of python.csv')
    parser.add_argument('--runs', type=int, default=7, help='default %(default)s')
    return parser.parse_args()


def cpp_ns():
    program = next(ROOT.glob('catkin_ws/devel/lib/cell_microinjection/bench_force_calls'))
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / 'times.csv'
        subprocess.run([program, '--csv', table], check=True, stdout=subprocess.DEVNULL)
        with table.open(encoding='utf-8') as file:
            return float(next(csv.DictReader(file))['median_ns'])


def median_time(work, count):
    times = []
    for _ in range(count):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def import_s():
    program = 'import time; t = time.perf_counter(); import cell_microinjection; print(time.perf_counter() - t)'
    return float(subprocess.run([sys.executable, '-c', program], check=True, capture_output=True, text=True).stdout)


def steps_per_second(env, action, steps):
    """Of an env that is reset when it is over; the resets do not count."""
    env.reset(seed=1)
    took, done = 0.0, 0
    while done < steps:
        begin = time.perf_counter()
        over = False
        while done < steps and not over:
            over = any(env.step(action)[2:4])
            done += 1
        took += time.perf_counter() - begin
        env.reset()
    return steps / took


def main():
    arguments = parse_arguments()
    cell = Cell('mouse_oocyte_injection')
    tips = cell.tips(numpy.linspace(0, 10e-6, TIPS))
    single = tips[TIPS // 2]
    figures = {name: [] for name in ('array over C++', 'one call above C++ (us)', 'import (s)', 'inject, times real time',
                                     'approach_by_image, times real time')}
    for run in range(arguments.runs):
        print(f'run {run + 1} of {arguments.runs}', file=sys.stderr)
        cpp = cpp_ns()
        figures['array over C++'].append(1e9 * median_time(lambda: cell.force(tips), 31) / TIPS / cpp)
        calls = 1e6 * median_time(lambda: [cell.force(single) for _ in range(1000)], 31) / 1000
        figures['one call above C++ (us)'].append(calls - 1e-3 * cpp)
        figures['import (s)'].append(import_s())
        figures['inject, times real time'].append(1e-3 * steps_per_second(gym.Inject(), [0, 0, -5e-6, 0], 50000))
        images = gym.ApproachByImage()
        figures['approach_by_image, times real time'].append(
            gym.ApproachByImage.PERIOD * steps_per_second(images, [0, 0], 90))
        images.close()
    with (arguments.out / 'python.csv').open('w', encoding='utf-8', newline='') as file:
        rows = csv.writer(file)
        rows.writerow(['figure', 'median', 'lowest', 'highest'])
        for name, values in figures.items():
            row = [name, *(f'{value:.3g}' for value in (statistics.median(values), min(values), max(values)))]
            rows.writerow(row)
            print(f'{row[0]}: {row[1]} ({row[2]} to {row[3]})')


if __name__ == '__main__':
    main()
