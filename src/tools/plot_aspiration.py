#!/usr/bin/python3
"""Draws how suction in a needle breaks a membrane: the tongue in its bore, and what the witnesses see of the break, in a trial of ./dev bench suction."""
import argparse
import sys
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before
import numpy  # noqa: E402
from cell_microinjection import ConfigError, Scene, _core, aspirate  # noqa: E402
from output_files import check_outputs  # noqa: E402
from plot_tongue import wall  # noqa: E402

BORE, TIP = 2.5e-6, 3.5e-6  # m, radii of the drawn needle
SUCTIONS = (0.02, 0.1, 0.2, 0.3)  # over the modulus


def draw_tongues(axes):
    """Of a bore in a cell of the default scene's size, in section; the needle comes from above."""
    mouth = {'inner_radius': BORE, 'outer_radius': TIP, 'edge_radius': (TIP - BORE) / 2}
    held = Scene.load('mouse_oocyte_held')
    scene = held.replace({f'holding_pipette/mouth/{key}': value for key, value in mouth.items()})
    modulus = held.to_dict()['cell']['material']['young_modulus']
    drawn = aspirate(scene, [-modulus * suction for suction in SUCTIONS])
    good = numpy.flatnonzero(drawn['converged'])
    for shade, i in zip(plt.get_cmap('viridis')(numpy.linspace(0.85, 0.1, len(good))), good):
        outline = drawn['outline'][i]
        for side in (1, -1):
            axes.plot(side * 1e6 * outline[:, 0], -1e6 * outline[:, 1], color=shade, lw=1.5, label=f'{SUCTIONS[i]:g} E' if side > 0 else None)
    plane = drawn['outline'][good[-1]][0, 1] + drawn['tongue_length'][good[-1]]
    section = wall(mouth, plane, scene.diameter)
    for side in (1, -1):
        axes.fill(side * 1e6 * section[:, 0], -1e6 * section[:, 1], color='0.75', lw=0)
    axes.set(aspect='equal', xlim=(-8, 8), ylim=(-1e6 * plane - 6, -1e6 * plane + 5), xlabel='r (um)', ylabel='z (um)')
    axes.legend(loc='lower right', fontsize='small', title='suction')


def draw_break(all_axes, trial):
    """Suction, force and interface over the time since the dent; red: the first witness ends the suction."""
    time, suction, force, length = trial['samples'].T
    ends = time[1:][(suction[1:] == 0) & (suction[:-1] > 0)] - time[0]
    for axes, values, label in zip(all_axes, (suction, 1e9 * force, 1e6 * length), ('suction (Pa)', 'force (nN)', 'in the bore (um)')):
        axes.plot(time - time[0], values, lw=0.8)
        for end in ends:
            axes.axvline(end, color='tab:red', lw=0.8)
        axes.set_ylabel(label)
        axes.grid(alpha=0.3)
    all_axes[-1].set_xlabel('s since the needle rests in the dent')
    all_axes[0].set_title(f'breaks at {trial["suction_Pa"]:.0f} Pa, told after {1e3 * trial["latency_s"]:.0f} ms, '
                          f'{1e15 * trial["drawn_too_much_m3"]:.2f} pL too much', fontsize=10)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seed', type=int, default=1, help='of the trial (default %(default)s)')
    parser.add_argument('--out', type=Path, default=Path('aspiration.png'), help='picture to write (default %(default)s)')
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    try:
        check_outputs({}, {'--out': arguments.out})
        trial = _core.suction_trial(arguments.seed)
        if not trial['broken_by_suction']:
            raise ConfigError(f'--seed {arguments.seed}: suction does not break this cell ({trial["outcome"]}); choose another')
        figure = plt.figure(figsize=(10, 5))
        grid = figure.add_gridspec(3, 2, width_ratios=(1, 1.5))
        draw_tongues(figure.add_subplot(grid[:, 0]))
        draw_break([figure.add_subplot(grid[row, 1]) for row in range(3)], trial)
        figure.tight_layout()
        figure.savefig(arguments.out, dpi=120)
    except (OSError, ValueError) as error:
        sys.exit(f'plot_aspiration: {error}')
    print(arguments.out)


if __name__ == '__main__':
    main()
