#!/usr/bin/python3
"""Takes each core away from all other programs now and then, as a busy host does to a virtual machine.

A busy loop of real-time priority runs on each core, about a quarter of the time: for 5 ms to 0.9 s, at random, and on each
core by itself. What runs beside it must be right nevertheless: `./dev test --stalls`.
"""
import argparse
import errno
import multiprocessing
import os
import random
import sys
import time

PRIORITY = 50
BETWEEN = 0.7                                     # s, mean of the time between two stalls of a core
STALLS = (0.005, 0.02, 0.05, 0.1, 0.3, 0.3, 0.6)  # s, times 0.5 to 1.5


def stall(core, seed):
    """Stalls one core for as long as the parent lives."""
    parent = os.getppid()
    os.sched_setaffinity(0, {core})
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    draw = random.Random(f'{seed} {core}')
    while os.getppid() == parent:
        time.sleep(draw.expovariate(1 / BETWEEN))
        end = time.monotonic() + draw.choice(STALLS) * draw.uniform(0.5, 1.5)
        while time.monotonic() < end:
            pass


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--seed', type=int, default=1, help='of the random times (default: 1)')
    seed = parser.parse_args().seed
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    except OSError as error:
        if error.errno != errno.EPERM:
            raise
        sys.exit(f'stall_cores: no real-time priority {PRIORITY}: run it as root, or allow it (ulimit -r {PRIORITY})')
    parent = os.getppid()
    for core in os.sched_getaffinity(0):
        multiprocessing.Process(target=stall, args=(core, seed), daemon=True).start()
    while os.getppid() == parent:  # who was started in the background hears no Ctrl-C
        time.sleep(0.5)


if __name__ == '__main__':
    main()
