#!/usr/bin/env python3
"""Plots the recorder's force_depth.csv: forces against depth, and the force at the hand against time.

    plot_force_depth.py CSV PNG
"""
import argparse
import csv
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before
import numpy  # noqa: E402

OUTWARD = ('retract', 'done')  # phases; in all others the needle goes in or rests
HAND = '#3d7a4d'
# Label, whether inwards, and (colour, width) of the predicted and of the measured force.
BRANCHES = (('indentation', True, '-', ('#f0a04b', 3.0), ('#8fb8de', 0.9)),
            ('retraction', False, '--', ('#8a3b00', 1.4), ('#1f4e79', 0.9)))
MOST_POINTS = 4000  # a line; more would make the picture slow, not better


def read(path):
    """Returns the columns of the CSV file by name: text for the phase, numbers else, NaN where a field is empty.
    @raises ValueError when there are no rows."""
    with open(path, encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise ValueError(f'{path}: no rows')
    return {name: numpy.array([row[name] for row in rows]) if name == 'phase' else
            numpy.array([float(row[name] or 'nan') for row in rows]) for name in rows[0]}


def thinned(mask):
    """Returns at most MOST_POINTS indices at which `mask` holds, evenly spread."""
    indices = numpy.flatnonzero(mask)
    return indices[::max(1, -(-indices.size // MOST_POINTS))]


def plot_force(axes, table):
    depth = 1e6 * table['depth_m']
    touched = table['in_contact'] == 1
    outward = numpy.isin(table['phase'], OUTWARD)
    for label, inward, style, predicted, measured in BRANCHES:
        rows = thinned(touched & (outward != inward))
        for source, (colour, width) in (('predicted', predicted), ('measured', measured)):
            if rows.size:
                axes.plot(depth[rows], 1e6 * table[f'{source}_axial_N'][rows], style, color=colour, linewidth=width,
                          label=f'{source}, {label}')
    punctured = numpy.flatnonzero(table['punctured'] == 1)
    if punctured.size:
        axes.axvline(depth[punctured[0]], color='0.4', linestyle=':', label='puncture')
    axes.set_title('Force of the cell on the needle')
    axes.set_xlabel('indentation depth (µm)')
    axes.set_ylabel('axial force (µN)')
    axes.set_xlim(left=0)
    if touched.any():
        axes.legend(loc='upper left', frameon=False)


def plot_hand(axes, table):
    time = table['time_s'] - table['time_s'][0]
    rows = thinned(numpy.ones(time.size, bool))
    axes.plot(time[rows], table['hand_force_N'][rows], color=HAND, linewidth=1)
    phases = table['phase']
    starts = numpy.flatnonzero(numpy.r_[True, phases[1:] != phases[:-1]])
    for number, start in enumerate(starts):
        axes.axvline(time[start], color='0.8', linewidth=0.8, zorder=0)
        # At two heights in turn, since a short phase has no room for its name.
        axes.annotate(str(phases[start]), (time[start], 1), xycoords=('data', 'axes fraction'),
                      xytext=(3, -3 - 10 * (number % 2)), textcoords='offset points', va='top', fontsize=8,
                      color='0.35')
    axes.set_xlim(0, max(time[-1], 1e-3))
    axes.margins(y=0.4)
    axes.set_title('Force felt at the hand')
    axes.set_xlabel('time (s)')
    axes.set_ylabel('force (N)')


def plot_difference(axes, table):
    rows = thinned(table['in_contact'] == 1)
    difference = 1e9 * (table['measured_axial_N'] - table['predicted_axial_N'])
    axes.plot(1e6 * table['depth_m'][rows], difference[rows], '.', color='#4a7fb5', markersize=2)
    axes.set_title('What the sensor adds: measured less predicted')
    axes.set_xlabel('indentation depth (µm)')
    axes.set_ylabel('force (nN)')
    axes.set_xlim(left=0)


def plot(csv_path, png):
    """Writes the picture. @raises ValueError or KeyError when the file has no rows or lacks a column."""
    table = read(csv_path)
    figure, (force, difference, hand) = plt.subplots(3, 1, figsize=(7.5, 9), constrained_layout=True,
                                                     gridspec_kw={'height_ratios': (3, 1, 1)})
    plot_force(force, table)
    plot_difference(difference, table)
    plot_hand(hand, table)
    for axes in (force, difference, hand):
        axes.spines[['top', 'right']].set_visible(False)
        axes.grid(color='0.92')
        axes.set_axisbelow(True)
    figure.savefig(png, dpi=150)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('csv', type=Path)
    parser.add_argument('png', type=Path)
    arguments = parser.parse_args()
    plot(arguments.csv, arguments.png)


if __name__ == '__main__':
    main()
