#!/usr/bin/python3
"""Draws a cell in the mouth of its holding pipette, in section, under some suctions, and its tongue's length by the suction."""
import argparse
import sys
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before
import numpy  # noqa: E402
from cell_microinjection import ConfigError, Scene, aspirate  # noqa: E402
from output_files import check_outputs  # noqa: E402


def wall(mouth, plane, far):
    """@returns (n, 2), m: the section of the pipette's wall, whose lip's crest is at z = plane, from z = -far"""
    inner, outer, edge = mouth['inner_radius'], mouth['outer_radius'], mouth['edge_radius']
    angle = numpy.linspace(0, numpy.pi / 2, 30)
    bore = numpy.column_stack([inner + edge - edge * numpy.cos(angle), plane - edge + edge * numpy.sin(angle)])
    outside = numpy.column_stack([outer - edge + edge * numpy.sin(angle), plane - edge + edge * numpy.cos(angle)])
    return numpy.concatenate([[[inner, -far]], bore, outside, [[outer, -far]]])


def draw(scene, drawn, path):
    mouth, radius = scene.to_dict()['holding_pipette']['mouth'], scene.diameter / 2
    good = numpy.flatnonzero(drawn['converged'])
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.6), gridspec_kw={'width_ratios': [1.2, 1]})
    shades = plt.get_cmap('viridis')(numpy.linspace(0.85, 0.1, len(good)))
    for shade, i in zip(shades, good):
        outline = drawn['outline'][i]
        for side in (1, -1):
            left.plot(side * 1e6 * outline[:, 0], 1e6 * outline[:, 1], color=shade, lw=1.5, label=f'{drawn["pressure"][i]:g} Pa' if side > 0 else None)
    # The lip's plane is the tongue's length above the lowest place.
    plane = drawn['outline'][good[-1]][0, 1] + drawn['tongue_length'][good[-1]]
    section = wall(mouth, plane, 1.7 * radius)
    for side in (1, -1):
        left.fill(side * 1e6 * section[:, 0], 1e6 * section[:, 1], color='0.75', lw=0)
    left.set_aspect('equal')
    left.set_xlim(-1.4e6 * radius, 1.4e6 * radius)
    left.set_ylim(-1.6e6 * radius, 1.15e6 * radius)
    left.set_xlabel('r (um)')
    left.set_ylabel('z (um)')
    left.legend(loc='upper right', fontsize='small')
    right.plot(-drawn['pressure'][good], 1e6 * drawn['tongue_length'][good], 'o-', color='tab:blue')
    right.set_xlabel('suction (Pa)')
    right.set_ylabel('tongue (um)')
    right.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--scene', default='mouse_oocyte_held', help='scene file, or a name of config/cells, with a mouth (default %(default)s)')
    parser.add_argument('--pressures', help='Pa, gauge, at most 0, with commas; default: six to three times that of the scene')
    parser.add_argument('--out', type=Path, default=Path('tongue.png'), help='picture to write (default %(default)s)')
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    try:
        check_outputs({'--scene': arguments.scene}, {'--out': arguments.out})
        scene = Scene.load(arguments.scene)
        if 'mouth' not in scene.to_dict().get('holding_pipette', {}):
            raise ConfigError(f'{arguments.scene}: holding_pipette/mouth: is missing')
        strongest = 3 * scene.to_dict()['holding_pipette']['mouth']['pressure']
        pressures = [float(text) for text in arguments.pressures.split(',')] if arguments.pressures else numpy.linspace(strongest / 6, strongest, 6)
        drawn = aspirate(scene, pressures)
        if not drawn['converged'].any():
            raise ConfigError(f'no pressure has a solution: {drawn["reason"][0]}')
        draw(scene, drawn, arguments.out)
    except (OSError, ValueError) as error:
        sys.exit(f'plot_tongue: {error}')
    print(arguments.out)


if __name__ == '__main__':
    main()
