#!/usr/bin/python3
"""Finds a cell's modulus from a force curve: one that is made up here, with a sensor's noise, in place of yours."""
import numpy

from cell_microinjection import Cell, Scene, identify


def record(modulus, noise=2e-9):
    """@returns a table as an instrument writes it: an approach, then 8 um into a cell of this modulus (Pa)."""
    cell = Cell(Scene.load('mouse_oocyte_injection').replace({'cell/material/young_modulus': modulus}))
    depth = numpy.linspace(-3e-6, 8e-6, 600)
    force = cell.force(cell.tips(depth))[:, 2]
    return {'time_s': 0.01 * numpy.arange(len(depth)), 'position_um': 1e6 * depth + 40,
            'force_nN': 1e9 * (force + numpy.random.default_rng(1).normal(0, noise, len(depth)))}


def main():
    found = identify(record(11e3), 'mouse_oocyte_injection')
    modulus = found['young_modulus']
    print(f'modulus {modulus.value / 1e3:.2f} kPa, 95 %: {modulus.low / 1e3:.2f} to {modulus.high / 1e3:.2f}; it was 11')
    print('the model follows the record' if found.consistent else 'another cell has this force')
    for warning in found.warnings:
        print(warning)


if __name__ == '__main__':
    main()
