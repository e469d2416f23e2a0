"""Picture of the p1_locking benchmark: error of the force against the number of vertices. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

DEPTH = {'linear': 1.0, 'st_venant_kirchhoff': 0.5, 'neo_hookean': 5.0}  # um, one curve a material
COLOUR = {'linear': '#4c78a8', 'st_venant_kirchhoff': '#54a24b', 'neo_hookean': '#e45756'}
LINE = {'uniform': '--', 'refined_5x': '-'}


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(figsize=(7.5, 4.5))
    for material, depth in DEPTH.items():
        for mesh, style in LINE.items():
            chosen = [(int(row['vertices']), float(row['error_percent'])) for row in rows
                      if (row['material'], row['mesh'], float(row['depth_um'])) == (material, mesh, depth)]
            axes.plot(*zip(*sorted(chosen)), style, marker='o', color=COLOUR[material],
                      label=f'{material.replace("_", " ")}, {depth:g} µm, {mesh.replace("_", " ")}')
    axes.axhline(0, color='black', linewidth=0.8)
    axes.set(xscale='log', xlabel='vertices', ylabel='error of the force (%)',
             title='Plain P1 tetrahedra lock at ν = 0.49')
    axes.set_xticks([100, 200, 500, 1000, 2000], ['100', '200', '500', '1000', '2000'])
    axes.minorticks_off()
    axes.grid(color='0.9')
    axes.legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=130)


if __name__ == '__main__':
    main(*sys.argv[1:3])
