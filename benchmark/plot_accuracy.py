"""Picture of the accuracy benchmark: error of the force against time, for every element and model. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

PANELS = [('linear_disc', 1e-6), ('neo_hookean_disc', 5e-6), ('hemisphere_sticking', 10e-6)]
COLOUR = {'p1': '#e45756', 'mini': '#f58518', 'p1_p1': '#b279a2', 'p2': '#9d755d', 'p2_p0': '#4c78a8', 'p2_p1': '#54a24b'}
STYLE = {'axisymmetric': ('-', 'o'), 'spatial': ('--', 's'), 'live': (':', '^')}


def curves(rows, scene, depth):
    """(model, element) -> [(time, error in %)] on finer and finer meshes."""
    found = {}
    for row in rows:
        error = abs(float(row['error']))
        if row['scene'] == scene and abs(float(row['depth_m']) - depth) < 1e-9 and error == error:
            found.setdefault((row['model'], row['element']), []).append((float(row['time_s']), 100 * error))
    return found


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    figure, all_axes = plt.subplots(1, len(PANELS), figsize=(13, 4.6), sharey=True)
    labels = {}
    for axes, (scene, depth) in zip(all_axes, PANELS):
        for (model, element), points in sorted(curves(rows, scene, depth).items()):
            line, marker = STYLE[model]
            drawn, = axes.plot(*zip(*points), line, marker=marker, markersize=4, color=COLOUR[element])
            labels[f'{element}, {model}'] = drawn
        axes.set(xscale='log', yscale='log', xlabel='time, meshing included (s)',
                 title=f'{scene.replace("_", " ")}, {1e6 * depth:g} µm')
        axes.axhline(1, color='0.6', linewidth=0.8)
        axes.grid(color='0.92')
    all_axes[0].set_ylabel('error of the force (%)')
    figure.legend(labels.values(), labels.keys(), loc='center right', frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, 0, 0.86, 1))
    figure.savefig(picture, dpi=120)


if __name__ == '__main__':
    main(*sys.argv[1:3])
