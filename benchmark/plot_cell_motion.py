"""Picture of the benchmark cell_motion: a pick-up's course, the hold's limits and the error of a step. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402


def course(axes, of):
    for quantity, label, colour in (('course_mouth', 'mouth', '0.5'), ('course_height', 'cell', '#4c78a8')):
        axes.plot(of(quantity, 'at'), [1e6 * z for z in of(quantity, 'value')], label=label, color=colour)
    axes.set_xlabel('time (s)')
    axes.set_ylabel('height over the dish (µm)')
    pull = axes.twinx()
    pull.plot(of('course_suction', 'at'), [1e9 * f for f in of('course_suction', 'value')], color='#f58518', linewidth=0.9,
              label='suction')
    pull.set_ylabel('suction on the cell (nN)')
    axes.legend(loc='center right', fontsize=8)
    pull.legend(loc='upper right', fontsize=8)
    axes.set_title('picked up from 2 µm, lifted, dropped')


def limits(axes, of):
    for quantity, label, colour in (('pull_off', 'pulled off', '#4c78a8'), ('sideways_off', 'pushed over the lip', '#e45756'),
                                    ('sideways_opens', 'seal opens', '#54a24b')):
        ratio = [value / expected for value, expected in zip(of(quantity, 'value'), of(quantity, 'expected'))]
        axes.semilogx(of(quantity, 'at'), ratio, 'o-', label=label, color=colour)
    axes.axhline(1, color='0.3', linewidth=0.8)
    axes.set_xlabel("cell's modulus (Pa)")
    axes.set_ylabel("force, over the rigid sphere's")
    axes.legend(fontsize=8)
    axes.set_title('limits of the hold')


def order(axes, of):
    steps, errors = of('error_after_0.256_s', 'at'), of('error_after_0.256_s', 'value')
    axes.loglog([1e3 * h for h in steps], [1e9 * e for e in errors], 'o-', color='#4c78a8', label='measured')
    axes.loglog([1e3 * h for h in steps], [1e9 * errors[0] * h / steps[0] for h in steps], '--', color='0.5',
                label='first order')
    axes.set_xlabel('step (ms)')
    axes.set_ylabel('error of the position (nm)')
    axes.legend(fontsize=8)
    axes.set_title('a needle pushes it for 0.256 s')


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    of = lambda quantity, column: [float(row[column]) for row in rows if row['quantity'] == quantity]  # noqa: E731
    figure, axes = plt.subplots(1, 3, figsize=(14, 4.2))
    course(axes[0], of)
    limits(axes[1], of)
    order(axes[2], of)
    for each in axes:
        each.grid(color='0.92')
    figure.tight_layout()
    figure.savefig(picture, dpi=90)


if __name__ == '__main__':
    main(*sys.argv[1:3])
