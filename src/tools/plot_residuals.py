#!/usr/bin/python3
"""Plots what `identify --residuals CSV` wrote: the measured and the fitted force over depth, and what is between them.

    plot_residuals.py CSV [--out PNG]
"""
import argparse
import csv
import sys
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before
import numpy  # noqa: E402
from output_files import check_outputs  # noqa: E402

COLUMNS = ('depth_m', 'force_N', 'fitted_N', 'residual_N')
SHARE = 40  # samples of a running median: a fortieth of the record


def read(path):
    """@returns the columns by name. @raises ValueError when the file is no table of residuals."""
    with open(path, encoding='utf-8', newline='') as file:
        reader = csv.DictReader(file)
        missing = [name for name in COLUMNS if name not in (reader.fieldnames or ())]
        if missing:
            raise ValueError(f'{path}: is no table of identify --residuals: it has no column {", ".join(missing)}')
        rows = list(reader)
    if not rows:
        raise ValueError(f'{path}: no rows')
    try:
        return {name: numpy.array([float(row[name]) for row in rows]) for name in COLUMNS}
    except (TypeError, ValueError) as error:
        raise ValueError(f'{path}: {error}') from error


def running_median(values):
    """The smooth part: what the model cannot follow."""
    half = max(2, len(values) // SHARE // 2)
    return numpy.array([numpy.median(values[max(0, i - half):i + half + 1]) for i in range(len(values))])


def plot(table, png):
    figure, (force, residual) = plt.subplots(2, 1, figsize=(7.5, 6.5), sharex=True, constrained_layout=True,
                                             gridspec_kw={'height_ratios': (2, 1)})
    depth = 1e6 * table['depth_m']
    force.plot(depth, 1e9 * table['force_N'], '.', color='#8fb8de', markersize=3, label='measured')
    force.plot(depth, 1e9 * table['fitted_N'], color='#8a3b00', linewidth=1.4, label='fitted')
    force.set_ylabel('force (nN)')
    force.legend(frameon=False)
    residual.plot(depth, 1e9 * table['residual_N'], '.', color='#8fb8de', markersize=3)
    residual.plot(depth, 1e9 * running_median(table['residual_N']), color='#8a3b00', linewidth=1.4,
                  label='running median: what the model cannot follow')
    residual.axhline(0, color='0.6', linewidth=0.8, zorder=0)
    residual.set_ylabel('measured less fitted (nN)')
    residual.set_xlabel('depth past the contact (µm)')
    residual.legend(frameon=False)
    for axes in (force, residual):
        axes.axvline(0, color='0.8', linewidth=0.8, zorder=0)
        axes.grid(color='0.92')
        axes.set_axisbelow(True)
        axes.spines[['top', 'right']].set_visible(False)
    figure.savefig(png, dpi=150)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('csv', type=Path, help='table that identify --residuals has written')
    parser.add_argument('--out', type=Path, help='picture; default: beside the table')
    arguments = parser.parse_args()
    out = arguments.out or arguments.csv.with_suffix('.png')
    try:
        check_outputs({'CSV': arguments.csv}, {'--out': out})
        plot(read(arguments.csv), out)
    except (OSError, ValueError) as error:
        print(f'plot_residuals: {error}', file=sys.stderr)
        return 2
    print(f'plot_residuals: {out}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
