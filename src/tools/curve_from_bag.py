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
from output_files import check_outputs

NEEDLE, FORCE = '/needle/measured_cp', '/force_sensor/measured_cf'
FORCE_FRAME = 'needle_tip'
FURTHEST = 0.05  # s, from a force to the positions that it is put between


def axis_of(orientation):
    """z of the needle in the world, from a quaternion."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    return numpy.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])


def read(path, needle, force):
    """@returns (times and positions of the needle, its axes), (times and forces), s, m, N; what is not valid is left out.
    @raises ValueError when the bag has no such messages."""
    places, axes, forces = [], [], []
    with rosbag.Bag(str(path)) as bag:
        for topic, message, _ in bag.read_messages(topics=[needle, force]):
            stamp = message.header.stamp.to_sec()
            if not stamp:  # invalid (CRTK)
                continue
            if topic == needle:
                place = message.pose.position
                places.append((stamp, place.x, place.y, place.z))
                axes.append(axis_of(message.pose.orientation))
            else:
                if message.header.frame_id.lstrip('/') != FORCE_FRAME:
                    raise ValueError(f'{force} has frame {message.header.frame_id!r}: must be {FORCE_FRAME}')
                forces.append((stamp, message.wrench.force.z))
    for topic, found in ((needle, places), (force, forces)):
        if not found:
            raise ValueError(f'no valid message on {topic}')
    return numpy.array(places), numpy.array(axes), numpy.array(forces)


def curve(places, axes, forces):
    """@returns rows of time (s), travel along the pipette towards the cell (m) and force (N), at the forces' times."""
    finite = numpy.isfinite(places).all(axis=1) & numpy.isfinite(axes).all(axis=1)
    places, axes = places[finite], axes[finite]
    order = numpy.argsort(places[:, 0], kind='stable')
    places, axes = places[order], axes[order]
    travel = -(places[:, 1:] * axes).sum(axis=1)
    forces = forces[numpy.argsort(forces[:, 0], kind='stable')]
    after = numpy.searchsorted(places[:, 0], forces[:, 0])
    known = (after > 0) & (after < len(places)) & numpy.isfinite(forces[:, 1])
    forces, after = forces[known], after[known]
    apart = places[after, 0] - places[after - 1, 0]
    forces = forces[apart <= FURTHEST]
    if not len(forces):
        raise ValueError('no force is between two positions of the needle')
    return numpy.column_stack((forces[:, 0], numpy.interp(forces[:, 0], places[:, 0], travel), forces[:, 1]))


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
        rows = curve(*read(arguments.bag, arguments.needle, arguments.force))
        rows[:, 0] -= rows[0, 0]
        rows = rows[(rows[:, 0] >= arguments.begin) & (rows[:, 0] <= arguments.end)]
        if not len(rows):
            raise ValueError(f'no force from {arguments.begin} to {arguments.end} s')
        numpy.savetxt(out, rows, delimiter=',', header='time_s,position_m,force_N', comments='', fmt='%.9g')
    except (OSError, ValueError, rosbag.ROSBagException) as error:
        print(f'curve_from_bag: {arguments.bag}: {error}', file=sys.stderr)
        return 2
    print(f'curve_from_bag: {out}: {len(rows)} forces in {rows[-1, 0] - rows[0, 0]:.3g} s')
    return 0


if __name__ == '__main__':
    sys.exit(main())
