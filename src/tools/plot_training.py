#!/usr/bin/python3
"""Plots a trainee's training sessions, one beside the other: score by its shares, and each measure.

    plot_training.py HISTORY_CSV PNG [--trainee NAME]
"""
import argparse
import csv
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before
import numpy  # noqa: E402
from output_files import check_outputs  # noqa: E402

# Column of the points, label, colour.
SHARES = (('force_points', 'peak force', '#4c78a8'), ('deformation_points', 'deformation', '#72b7b2'),
          ('lateral_points', 'lateral error', '#54a24b'), ('time_points', 'time', '#eeca3b'),
          ('punctures_points', 'punctures', '#f58518'), ('volume_points', 'volume', '#b279a2'))
# Column of the measure, factor, label.
MEASURES = (('peak_force_N', 1e6, 'peak force (µN)'), ('deformation_m', 1e6, 'deformation (µm)'),
            ('lateral_error_m', 1e6, 'lateral error (µm)'), ('time_s', 1, 'time (s)'), ('punctures', 1, 'punctures'),
            ('volume_m3', 1e15, 'volume (pL)'))
MOST_SESSIONS = 30  # the newest
FEWEST_SESSIONS = 4  # that the axes are wide enough for


def read(path, name=None):
    """Returns (trainee, rows of that trainee in the order of the file). Without a name: the trainee of the last row.
    @raises ValueError when there is no session of that trainee."""
    with open(path, encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise ValueError(f'{path}: no sessions')
    name = name or rows[-1]['trainee']
    own = [row for row in rows if row['trainee'] == name]
    if not own:
        raise ValueError(f'{path}: no sessions of {name}; there are: {", ".join(sorted({r["trainee"] for r in rows}))}')
    return name, own[-MOST_SESSIONS:]


def complete(rows):
    """Which of the rows are sessions that count; of the others there are measures, but no points."""
    return numpy.array([row['outcome'] == 'complete' for row in rows])


def column(rows, name):
    return numpy.array([float(row[name]) for row in rows])


def plot_score(axes, rows):
    places = numpy.arange(len(rows))
    bottom = numpy.zeros(len(rows))
    for name, label, colour in SHARES:
        points = column(rows, name)
        axes.bar(places, points, 0.7, bottom=bottom, color=colour, label=label)
        bottom += points
    for place, row in zip(places, rows):
        counts = row['outcome'] == 'complete'
        axes.annotate(f'{float(row["score"]):.0f}' if counts else row['outcome'], (place, float(row['score'])),
                      ha='center', va='bottom', fontsize=8, rotation=0 if counts else 90, color='k' if counts else '0.5')
    axes.set(xlim=(-0.6, max(len(rows), FEWEST_SESSIONS) - 0.4), ylim=(0, 110), ylabel='score', xticks=places)
    axes.set_xticklabels([row['session'] for row in rows], rotation=30, ha='right', fontsize=7)
    axes.legend(loc='center left', bbox_to_anchor=(1, 0.5), frameon=False, fontsize=8)


def plot_measure(axes, rows, name, factor, label):
    values = factor * column(rows, name)
    places = numpy.arange(1, len(rows) + 1)
    axes.plot(places, values, '-', color='0.7', linewidth=1)
    counts = complete(rows)
    for chosen, face in ((counts, None), (~counts, 'w')):
        before = chosen & (places < len(rows))
        axes.plot(places[before], values[before], 'o', color='#4c78a8', markerfacecolor=face or '#4c78a8', markersize=4)
    axes.plot(places[-1], values[-1], 'o', color='#e45756', markerfacecolor='#e45756' if counts[-1] else 'w',
              markersize=6)
    if counts[:-1].any():
        axes.axhline(numpy.median(values[:-1][counts[:-1]]), color='0.5', linewidth=0.8, linestyle=':')
    axes.set_title(label, fontsize=9)
    axes.set(xlim=(0.4, max(len(rows), FEWEST_SESSIONS) + 0.6), ylim=(0, 1.15 * max(values.max(), 0.01)))
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.tick_params(labelsize=8)


def plot(history, png, name=None):
    """Writes the picture. @raises ValueError or KeyError when there is no session or a column is missing."""
    name, rows = read(history, name)
    figure = plt.figure(figsize=(9, 7), constrained_layout=True)
    grid = figure.add_gridspec(3, 3, height_ratios=(1.6, 1, 1))
    score = figure.add_subplot(grid[0, :])
    plot_score(score, rows)
    score.set_title(f'{name}: {len(rows)} session{"s" if len(rows) > 1 else ""}; '
                    'the last one is red below, the median of those before is dotted')
    all_axes = [score]
    for number, measure in enumerate(MEASURES):
        all_axes.append(figure.add_subplot(grid[1 + number // 3, number % 3]))
        plot_measure(all_axes[-1], rows, *measure)
    for axes in all_axes:
        axes.spines[['top', 'right']].set_visible(False)
        axes.grid(color='0.92', axis='y')
        axes.set_axisbelow(True)
    figure.savefig(png, dpi=120)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('history', type=Path)
    parser.add_argument('png', type=Path)
    parser.add_argument('--trainee', help='whose sessions; default: of the last row')
    arguments = parser.parse_args()
    try:
        check_outputs({'HISTORY': arguments.history}, {'PNG': arguments.png})
        plot(arguments.history, arguments.png, arguments.trainee)
    except (OSError, ValueError, KeyError) as error:
        parser.exit(1, f'plot_training.py: {error}\n')


if __name__ == '__main__':
    main()
