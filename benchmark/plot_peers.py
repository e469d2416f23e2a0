"""Picture of the peers benchmark: error against time of a step on equal meshes; converged forces. Usage: CSV PNG."""
import csv
import math
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = {'cell_microinjection': '#111111', 'Bullet': '#e45756', 'CalculiX': '#4c78a8', 'GetFEM': '#54a24b'}
MARKERS = {'p1': '^', 'p2': 's', 'p2_p0': 'o', 'p2_p1': 'D', 'energy': '*'}
OTHERS = ['#f58518', '#b279a2', '#9d755d', '#ff9da6']  # of programs that joined


def colours(rows):
    """Returns the colour of each program, whatever its version."""
    names = sorted({row['program'].split(' ')[0] for row in rows})
    others = [name for name in names if name not in COLOURS]
    return {**COLOURS, **{name: OTHERS[k % len(OTHERS)] for k, name in enumerate(others)}}


def number(row, column):
    return float(row[column]) if row[column] else math.nan


def equal_curves(rows):
    """(program, model, element, scene, mesh) -> [(ms, error in %, low and high ms)] on finer and finer meshes."""
    found = {}
    for row in rows:
        if row['study'] == 'equal' and math.isfinite(number(row, 'force_error')):
            key = (row['program'], row['model'], row['element'], row['scene'], row['mesh'].split(' ')[0])
            error = max(number(row, 'force_error'), number(row, 'converged_error'))  # nothing less is known
            found.setdefault(key, []).append((number(row, 'time_ms_median'), 100 * error,
                                              number(row, 'time_ms_low'), number(row, 'time_ms_high')))
    return found


def draw_equal(axes, rows, colour):
    for (program, model, element, scene, mesh), points in equal_curves(rows).items():
        times, errors, lows, highs = zip(*sorted(points))
        own = colour[program.split(' ')[0]]
        axes.plot(times, errors, '-' if model == 'equilibrium' else '--', color=own, marker=MARKERS.get(element, 'x'),
                  markersize=12 if element == 'energy' else 6, label=f'{program}, {model}, {element}: {scene}, {mesh}')
        axes.hlines(errors, lows, highs, color=own, linewidth=0.8, alpha=0.7)
    axes.axvline(1, color='0.5', linewidth=0.8, linestyle='--')
    axes.set(xscale='log', yscale='log', xlabel='processor time of a step (ms): median, line from 10 to 90 %',
             ylabel='error of the force (%), at least that of the converged one', title='Equal meshes and motion')
    axes.grid(color='0.92')
    if axes.lines[1:]:
        axes.legend(fontsize=7, loc='upper left', bbox_to_anchor=(0, -0.14), frameon=False, ncol=2)


def draw_converged(axes, rows, colour):
    """Each force over ours, with both errors."""
    rows = [row for row in rows if row['study'] == 'converged' and math.isfinite(number(row, 'converged_N'))
            and math.isfinite(number(row, 'law_effect'))]
    places = list(dict.fromkeys((row['scene'], row['depth_um']) for row in rows))
    for row in rows:
        name = row['program'].split(' ')[0]
        shift = 0.2 * list(colour).index(name) - 0.3
        force = number(row, 'force_N') / (1 + number(row, 'law_effect'))
        axes.errorbar(100 * (force / number(row, 'converged_N') - 1), places.index((row['scene'], row['depth_um'])) + shift,
                      xerr=100 * number(row, 'error_estimate'), color=colour[name], marker=MARKERS.get(row['element'], 'x'),
                      markersize=5, capsize=2, label=name)
    axes.set_yticks(range(len(places)))
    axes.set_yticklabels([f'{scene}, {depth} µm' for scene, depth in places], fontsize=8)
    axes.invert_yaxis()
    axes.axvline(0, color='0.5', linewidth=0.8)
    axes.set(xlabel='difference from our converged force (%), with the error of the mesh', title='Converged forces')
    axes.grid(color='0.92')
    handles = dict(zip(*reversed(axes.get_legend_handles_labels())))
    if handles:
        axes.legend(handles.values(), handles.keys(), fontsize=8)


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(1, 2, figsize=(16, 9), gridspec_kw={'width_ratios': [1.2, 1]})
    colour = colours(rows)
    draw_equal(axes[0], rows, colour)
    draw_converged(axes[1], rows, colour)
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == '__main__':
    main(*sys.argv[1:3])
