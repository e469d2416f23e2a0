"""Picture of the convergence_order benchmark: error of the displacement gradient against size. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

PANELS = [('2', 0.3), ('2', 0.499), ('3', 0.3), ('3', 0.499)]
MODEL = {'2': 'axisymmetric', '3': 'spatial'}
COLOUR = {'p1': '#e45756', 'mini': '#f58518', 'p1_p1': '#b279a2', 'p2': '#9d755d', 'p2_p0': '#4c78a8', 'p2_p1': '#54a24b'}


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    figure, all_axes = plt.subplots(1, len(PANELS), figsize=(15, 4.6), sharey=True)
    for axes, (dimension, poisson_ratio) in zip(all_axes, PANELS):
        for element, colour in COLOUR.items():
            points = [(1e6 * float(row['size_m']), 100 * float(row['gradient_error'])) for row in rows
                      if row['dimension'] == dimension and row['element'] == element
                      and abs(float(row['poisson_ratio']) - poisson_ratio) < 1e-9]
            if points:
                axes.plot(*zip(*points), '-o', markersize=4, color=colour, label=element)
        axes.set(xscale='log', yscale='log', xlabel='size of the elements (µm)',
                 title=f'{MODEL[dimension]}, Poisson ratio {poisson_ratio:g}')
        axes.grid(color='0.92', which='both')
    all_axes[0].set_ylabel('error of the displacement gradient (%)')
    all_axes[0].legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=120)


if __name__ == '__main__':
    main(*sys.argv[1:3])
