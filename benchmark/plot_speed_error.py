"""Picture of the speed_error benchmark: error of the force against the time of one on-line force. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

ELEMENT_COLOUR = {'p1': '#e45756', 'mini': '#f58518', 'p1_p1': '#b279a2', 'p2': '#9d755d', 'p2_p0': '#4c78a8',
                  'p2_p1': '#54a24b'}
# model in the table -> label, colour (None: the element's), line, marker
MODELS = {
    'linear_disc': ('P1 linear (disc)', '#777777', '-', 'v'),
    'st_venant_kirchhoff_disc quasi-static': ('P1 St-Venant-Kirchhoff, quasi-static (disc)', '#c51b8a', '-', 's'),
    'st_venant_kirchhoff_disc explicit step': ('P1 St-Venant-Kirchhoff, one explicit step (disc)', '#c51b8a', ':', 'D'),
    'st_venant_kirchhoff_disc explicit to rest':
        ('P1 St-Venant-Kirchhoff, explicit, to rest (disc)', '#f7a6d3', ':', 'd'),
    'neo_hookean_disc live': ('P1 neo-Hookean, live (disc)', '#111111', '-', '^'),
    'neo_hookean_disc axisymmetric': ('{}, section (disc)', None, '-', 'o'),
    'neo_hookean_disc spatial': ('{}, space (disc)', None, '--', 'P'),
    'hemisphere_sticking axisymmetric': ('{}, section (hemisphere)', '#00a5b5', '-', 'h'),
    'hemisphere_sticking spatial': ('{}, space (hemisphere)', '#00a5b5', '--', 'X'),
    'hemisphere_sticking prepared': ('surrogate cell (hemisphere)', '#d8a300', '', '*'),
    'hemisphere_sticking family': ('cell of a family (hemisphere)', '#8a5a00', '', 'P'),
}


def curves(rows):
    """(model, element) -> [(time in us, median and largest error in %)] on finer and finer meshes."""
    found = {}
    for row in rows:
        error = float(row['force_error_median'])
        if error == error:
            found.setdefault((row['model'], row['element']), []).append(
                (float(row['time_us_median']), 100 * error, 100 * float(row['force_error_max'])))
    return found


def draw_kernel(axes, rows):
    """Has no error of its own: along the foot of the picture."""
    kernel = [row for row in rows if row['model'] == 'kernel']
    times = [float(row['time_us_median']) for row in kernel]
    drawn, = axes.plot(times, [0.035] * len(times), 'k|', markersize=14, markeredgewidth=2,
                       transform=axes.get_xaxis_transform())
    for row, time in zip(kernel, times):
        count = int(row['tetrahedra'])
        axes.annotate(f'{count / 1000:.0f} k' if count >= 1000 else str(count), (time, 0.055),
                      xycoords=axes.get_xaxis_transform(), ha='center', va='bottom', fontsize=8)
    return drawn


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(figsize=(13, 7))
    labels = {}
    for (model, element), points in curves(rows).items():
        label, colour, line, marker = MODELS.get(model, (model + ' {}', None, '-', 'x'))
        times, medians, largest = zip(*points)
        drawn, = axes.plot(times, medians, line, marker=marker, markersize=14 if marker == '*' else 6,
                           color=colour or ELEMENT_COLOUR.get(element, '0.4'))
        axes.vlines(times, medians, largest, color=drawn.get_color(), linewidth=0.7, alpha=0.6)
        labels[label.format(element.upper().replace('_', '-'))] = drawn
    labels['explicit kernel alone, tetrahedra as marked'] = draw_kernel(axes, rows)
    axes.set(xscale='log', yscale='log', xlabel='CPU time of one on-line force, median (µs)',
             ylabel='error of the force (%): median over depths, thin line to the largest',
             title='Error of the force against the time of one on-line force')
    axes.axvline(1000, color='0.5', linewidth=0.8, linestyle='--')
    axes.annotate('1 kHz', (1000, 1), xycoords=('data', 'axes fraction'), xytext=(3, -10), textcoords='offset points',
                  fontsize=8, color='0.3')
    axes.axhline(1, color='0.5', linewidth=0.8)
    axes.grid(color='0.92')
    figure.legend(labels.values(), labels.keys(), loc='center right', frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, 0, 0.74, 1))
    figure.savefig(picture, dpi=120)


if __name__ == '__main__':
    main(*sys.argv[1:3])
