#!/usr/bin/python3
"""Plots the recorder's force_depth.csv: forces against depth, and over time the force at the hand and what was injected.
Marks where the cell was touched, where each membrane gave way, the injection and the withdrawal.

    plot_force_depth.py CSV PNG [--layers zona,oolemma]
"""
import argparse
import csv
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before
import numpy  # noqa: E402
from output_files import check_outputs  # noqa: E402

TEXTS = ('phase', 'injection_state')  # columns
OUTWARD = ('retract', 'done')  # phases; in all others the needle goes in or rests
WITHDRAWS = ('withdraw',)      # state of an injection without a hand
HAND, VOLUME, MARK = '#3d7a4d', '#7a4d9a', '0.35'
# Label, whether inwards, and (colour, width) of the predicted and of the measured force.
BRANCHES = (('on the way in', True, '-', ('#f0a04b', 3.0), ('#8fb8de', 0.9)),
            ('on the way out', False, '--', ('#8a3b00', 1.4), ('#1f4e79', 0.9)))
MOST_POINTS = 4000  # a line; more would make the picture slow, not better
LATE = 0.05  # s, by which the cell may tell later that a membrane gave way


def read(path):
    """Returns the columns of the CSV file by name: text or numbers, NaN where a field is empty.
    @raises ValueError when there are no rows."""
    with open(path, encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise ValueError(f'{path}: no rows')
    return {name: numpy.array([row[name] for row in rows]) if name in TEXTS else
            numpy.array([float(row[name] or 'nan') for row in rows]) for name in rows[0]}


def thinned(mask):
    """Returns at most MOST_POINTS indices at which `mask` holds, evenly spread."""
    indices = numpy.flatnonzero(mask)
    return indices[::max(1, -(-indices.size // MOST_POINTS))]


def punctures(table):
    """Returns the row of each membrane's failure: the largest force within LATE before the cell told of it."""
    told = table.get('layers_punctured', table['punctured'])
    rows = []
    for row in numpy.flatnonzero(numpy.diff(told, prepend=0) > 0):
        force = numpy.where(table['time_s'] >= table['time_s'][row] - LATE, table['predicted_axial_N'], -numpy.inf)
        before = numpy.nan_to_num(force[:row + 1], nan=-numpy.inf)
        rows += [int(numpy.argmax(before))] * int(told[row] - (told[row - 1] if row else 0))
    return rows


def spans(mask):
    """Returns (first, last) row of each run in which `mask` holds."""
    edges = numpy.flatnonzero(numpy.diff(mask.astype(int), prepend=0, append=0))
    return [(int(begin), int(end) - 1) for begin, end in zip(edges[::2], edges[1::2])]


def injections(table):
    """Returns (first row, last row, volume in m^3) of each injection; the volume is NaN where it is not known."""
    if 'injection_state' not in table:
        return []
    volume = table['injected_volume_m3']
    return [(first, last, volume[min(last + 1, volume.size - 1)] - volume[first])
            for first, last in spans(table['injection_state'] == 'inject')]


def goes_out(table):
    outward = numpy.isin(table['phase'], OUTWARD)
    if not (table['phase'] != '').any() and 'injection_state' in table:
        outward = numpy.isin(table['injection_state'], WITHDRAWS)
    return outward


def events(table, layers):
    """Returns (row, what happened) in order of time."""
    found = []
    touched = numpy.flatnonzero(table['in_contact'] == 1)
    if touched.size:
        found.append((int(touched[0]), 'contact'))
    for number, row in enumerate(punctures(table)):
        found.append((row, f'{layers[number] if number < len(layers) else f"membrane {number + 1}"} punctured'))
    for first, _, volume in injections(table):
        found.append((first, 'injection' if numpy.isnan(volume) else f'injection: {1e15 * volume:.2g} pL'))
    inside = table['in_contact'] == 1
    for first, _ in spans(goes_out(table) & inside)[:1]:
        found.append((first, 'withdrawal'))
    return sorted(found)


def plot_force(axes, table, marks):
    depth, force = 1e6 * table['depth_m'], 1e6 * table['predicted_axial_N']
    touched = table['in_contact'] == 1
    outward = goes_out(table)
    for label, inward, style, predicted, measured in BRANCHES:
        rows = thinned(touched & (outward != inward))
        for source, (colour, width) in (('predicted', predicted), ('measured', measured)):
            if rows.size:
                axes.plot(depth[rows], 1e6 * table[f'{source}_axial_N'][rows], style, color=colour, linewidth=width,
                          label=f'{source}, {label}')
    top = numpy.nanmax(force) if numpy.isfinite(force).any() else 1.0
    deepest = numpy.nanmax(depth) if numpy.isfinite(depth).any() else 1.0
    for number, (row, text) in enumerate(marks):
        if not (numpy.isfinite(depth[row]) and numpy.isfinite(force[row])):
            continue
        axes.plot(depth[row], force[row], 'o', color=MARK, markersize=4, zorder=5)
        axes.annotate(text, (depth[row], force[row]), xytext=(depth[row], top * (1.12 + 0.09 * (number % 3))),
                      fontsize=8, color=MARK, ha='right' if depth[row] > 0.93 * deepest else 'center',
                      arrowprops={'arrowstyle': '-', 'color': '0.75', 'lw': 0.7})
    axes.set_title('Force of the cell on the needle')
    axes.set_xlabel('depth past the touch (µm)')
    axes.set_ylabel('axial force (µN)')
    # The touch is at 0; what is marked there needs room for its words.
    axes.set_xlim(left=-1)
    if marks:
        axes.set_ylim(top=1.4 * top)
    if touched.any():
        axes.legend(loc='center', bbox_to_anchor=(0.55, 0.35), frameon=False, fontsize=8)


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


def plot_course(axes, table, marks):
    """Depth, and what has left the pipette, over time."""
    time = table['time_s'] - table['time_s'][0]
    rows = thinned(numpy.ones(time.size, bool))
    axes.plot(time[rows], 1e6 * table['depth_m'][rows], color='#b5651d', linewidth=1.2)
    axes.set_ylabel('depth (µm)')
    for row, text in marks:
        axes.axvline(time[row], color='0.8', linewidth=0.8, zorder=0)
        axes.annotate(text.split(':')[0], (time[row], 0), xycoords=('data', 'axes fraction'), xytext=(2, 3),
                      textcoords='offset points', fontsize=7, color=MARK, rotation=90)
    axes.set_xlim(0, max(time[-1], 1e-3))
    axes.set_title('Course of the injection')
    axes.set_xlabel('time (s)')
    volume = table.get('injected_volume_m3')
    if volume is None or not numpy.isfinite(volume).any():
        return
    beside = axes.twinx()
    start = volume[numpy.isfinite(volume)][0]
    beside.plot(time[rows], 1e15 * (volume[rows] - start), color=VOLUME, linewidth=1.2)
    beside.set_ylabel('left the pipette (pL)', color=VOLUME)
    beside.spines['top'].set_visible(False)


def plot_difference(axes, table):
    rows = thinned(table['in_contact'] == 1)
    difference = 1e9 * (table['measured_axial_N'] - table['predicted_axial_N'])
    axes.plot(1e6 * table['depth_m'][rows], difference[rows], '.', color='#4a7fb5', markersize=2)
    axes.set_title('What the sensor adds: measured less predicted')
    axes.set_xlabel('depth past the touch (µm)')
    axes.set_ylabel('force (nN)')
    axes.set_xlim(left=-1)


def plot(csv_path, png, layers=()):
    """Writes the picture; `layers`: names of the membranes, outermost first.
    @raises ValueError or KeyError when the file has no rows or lacks a column."""
    table = read(csv_path)
    marks = events(table, layers)
    figure, (force, course, difference, hand) = plt.subplots(4, 1, figsize=(7.5, 11.5), constrained_layout=True,
                                                             gridspec_kw={'height_ratios': (3, 1.4, 1, 1)})
    plot_force(force, table, marks)
    plot_course(course, table, marks)
    plot_difference(difference, table)
    plot_hand(hand, table)
    for axes in (force, course, difference, hand):
        axes.spines['top'].set_visible(False)
        axes.grid(color='0.92')
        axes.set_axisbelow(True)
    for axes in (force, difference, hand):
        axes.spines['right'].set_visible(False)
    figure.savefig(png, dpi=150)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('csv', type=Path)
    parser.add_argument('png', type=Path)
    parser.add_argument('--layers', default='', help='names of the membranes, outermost first, with commas')
    arguments = parser.parse_args()
    try:
        check_outputs({'CSV': arguments.csv}, {'PNG': arguments.png})
    except ValueError as error:
        parser.exit(1, f'plot_force_depth.py: {error}\n')
    plot(arguments.csv, arguments.png, [name for name in arguments.layers.split(',') if name])


if __name__ == '__main__':
    main()
