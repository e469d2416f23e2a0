#!/usr/bin/python3
"""Writes the force over the travel of a needle from a ROS bag as a table for `identify --record`.

    curve_from_bag.py BAG [--out CSV] [--needle TOPIC] [--force TOPIC] [--from S] [--to S]

The force is that along the pipette (z of needle_tip), the position the travel along it, towards the cell.
"""
import argparse
import sys
from pathlib import Path

import numpy
import rosbag
from cell_microinjection.bag import FORCE, NEEDLE, curve_of_bag
from output_files import check_outputs


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('bag', type=Path)
    parser.add_argument('--out', type=Path, help='table to write; default: beside the bag')
    parser.add_argument('--needle', default=NEEDLE, help=f'poses of the needle; default {NEEDLE}')
    parser.add_argument('--force', default=FORCE, help=f'forces on the tip; default {FORCE}')
    parser.add_argument('--from', dest='begin', type=float, default=0, help='s after the first row')
    parser.add_argument('--to', dest='end', type=float, default=float('inf'), help='s after the first row')
    arguments = parser.parse_args()
    out = arguments.out or arguments.bag.with_suffix('.csv')
    try:
        check_outputs({'BAG': arguments.bag}, {'--out': out})
        found = curve_of_bag(arguments.bag, arguments.needle, arguments.force)
        rows = numpy.column_stack(list(found.values()))
        rows = rows[(rows[:, 0] >= arguments.begin) & (rows[:, 0] <= arguments.end)]
        if not len(rows):
            raise ValueError(f'no force from {arguments.begin} to {arguments.end} s')
        numpy.savetxt(out, rows, delimiter=',', header=','.join(found), comments='', fmt='%.9g')
    except (OSError, ValueError, rosbag.ROSBagException) as error:
        print(f'curve_from_bag: {arguments.bag}: {error}', file=sys.stderr)
        return 2
    print(f'curve_from_bag: {out}: {len(rows)} forces in {rows[-1, 0] - rows[0, 0]:.3g} s')
    return 0


if __name__ == '__main__':
    sys.exit(main())
