"""Picture of the puncture benchmark: the force on the needle of the whole cell and along the hole that grows. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402


def ways(table):
    """cell -> [(depth, force, hole, force of the whole cell)], and cell -> the row of its onset."""
    found, onsets = {}, {}
    with open(table, encoding='utf-8') as file:
        for row in csv.reader(file):
            if row[0] == 'way':
                found.setdefault(row[1], []).append([float(value) for value in row[2:]])
            elif row[0] == 'branches' and len(row) > 10:
                onsets[row[1]] = row
    return found, onsets


def main(table, picture):
    found, onsets = ways(table)
    if not found:
        print('plot: the table has no way of a needle; run the study branches', file=sys.stderr)
        return
    figure, all_axes = plt.subplots(1, len(found), figsize=(3.6 * len(found), 3.8), squeeze=False)
    for axes, (name, points) in zip(all_axes[0], sorted(found.items())):
        depth, force, hole, whole = zip(*points)
        _, _, law, parameter, radius, _, toughness, *_ = onsets[name]
        onset, steady = float(onsets[name][9]), float(onsets[name][13])
        outside = [i for i, length in enumerate(hole) if length == 0]
        inside = [i for i, length in enumerate(hole) if length > 0]
        limit = [i for i in range(len(depth)) if whole[i] < 1.6 * max(force)]
        axes.plot([depth[i] for i in limit], [whole[i] for i in limit], '--', color='#4c78a8', label='whole cell')
        axes.plot([depth[i] for i in outside], [force[i] for i in outside], color='#4c78a8')
        axes.plot([onset, depth[inside[0]]], [force[outside[-1]], force[inside[0]]], color='#e45756')
        axes.plot([depth[i] for i in inside], [force[i] for i in inside], color='#e45756', label='with the hole')
        axes.axhline(steady, color='0.6', linewidth=0.8)
        axes.set(xlabel='depth over R', ylim=(0, None),
                 title=f'{name}: {law.replace("_", "-")}{" " + parameter if parameter != "0" else ""}, '
                       f'J/(µR) = {toughness}, cell {radius} R')
        axes.title.set_fontsize(8)
        axes.grid(color='0.92')
    all_axes[0][0].set_ylabel('force over π R² µ')
    all_axes[0][0].legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == '__main__':
    main(*sys.argv[1:])
