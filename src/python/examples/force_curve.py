#!/usr/bin/python3
"""Draws the force of a cell over the depth, and that of one twice as stiff."""
import sys

import matplotlib
import numpy

from cell_microinjection import Cell, Scene

matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402  the backend is chosen before


def main(picture='force_curve.png'):
    scene = Scene.load('mouse_oocyte_injection')
    depths = numpy.linspace(0, 15e-6, 300)
    figure, axes = pyplot.subplots()
    for factor in (1, 2):
        cell = Cell(scene.replace({'cell/material/young_modulus': 17.9e3 * factor}))
        force = cell.force(cell.tips(depths))[:, 2]
        axes.plot(1e6 * depths, 1e6 * force, label=f'{17.9 * factor:.1f} kPa')
        print(f'{17.9 * factor:.1f} kPa: {1e6 * force[-1]:.3f} uN at 15 um; {cell.description.split(";")[-1].strip()}')
    axes.set_xlabel('depth (um)')
    axes.set_ylabel('force along the pipette (uN)')
    axes.legend()
    figure.savefig(picture)


if __name__ == '__main__':
    main(*sys.argv[1:])
