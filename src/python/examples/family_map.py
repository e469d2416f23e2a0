#!/usr/bin/python3
"""The force at a fifth of the radius over size and tip: which cells a family serves, and how exactly."""
import numpy

from cell_microinjection import Cell, ConfigError, Scene


def main():
    scene = Scene.load('mouse_oocyte_injection')
    tips = numpy.array([1e-6, 2e-6, 3e-6, 5e-6])
    print('diameter  tip   force at R/5, nN   expected error, median')
    for diameter in (40e-6, 80e-6, 150e-6):
        for tip in tips:
            changed = scene.replace({'cell/diameter': diameter, 'needle/tip/radius': tip,
                                     'holding_pipette/contact_radius': 0.2 * diameter})
            try:
                cell = Cell(changed, 'surrogate')
            except ConfigError:
                print(f'{1e6 * diameter:5.0f} um {1e6 * tip:4.0f} um   in no family')
                continue
            force = cell.force(cell.tips([0.1 * diameter]))[0, 2]
            print(f'{1e6 * diameter:5.0f} um {1e6 * tip:4.0f} um   {1e9 * force:10.1f}         {100 * cell.expected_error[0]:.1f} %')


if __name__ == '__main__':
    main()
