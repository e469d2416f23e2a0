"""Picture of the passivity benchmark: least energy and late oscillation of the hand's port. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

CONTROLLERS = {'off': ('controllers off', '#e45756'), 'one_port': ('passivity at the hand', '#f58518'),
               'wave': ('waves', '#54a24b')}
STILL = 50.0  # um, rms, below which the benchmark calls a hand at rest


def scatter(axes, rows, x, y, log_y=False):
    for i, (controller, (label, colour)) in enumerate(CONTROLLERS.items()):
        chosen = [row for row in rows if row['controller'] == controller]
        axes.scatter([x(row) + 0.2 * (i - 1) for row in chosen], [y(row) for row in chosen], s=10, color=colour,
                     alpha=0.6, label=label, linewidths=0)
    axes.set_yscale('log' if log_y else 'symlog', **({} if log_y else {'linthresh': 1e-4}))
    axes.grid(color='0.92')


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = [row for row in csv.DictReader(file) if row['block'] == 'grid']  # the axes are its values
    figure, axes = plt.subplots(2, 2, figsize=(13, 8), sharex='col')
    delays = sorted({(float(row['delay_ms']), float(row['loss'])) for row in rows})
    stiffnesses = sorted({float(row['stiffness_N_per_m']) for row in rows})
    by_delay = lambda row: delays.index((float(row['delay_ms']), float(row['loss'])))  # noqa: E731
    by_stiffness = lambda row: stiffnesses.index(float(row['stiffness_N_per_m']))  # noqa: E731
    tolerance = -float(rows[0]['tolerance_J'])
    for column, x in enumerate((by_delay, by_stiffness)):
        scatter(axes[0][column], rows, x, lambda row: float(row['observed_energy_min_J']))
        axes[0][column].axhline(tolerance, color='0.3', linewidth=0.8)
        axes[0][column].set_ylabel('least observed energy (J)')
        scatter(axes[1][column], rows, x, lambda row: max(0.01, float(row['late_amplitude_um'])), True)
        axes[1][column].axhline(STILL, color='0.3', linewidth=0.8)
        axes[1][column].set_ylabel('late oscillation of the hand, rms (µm)')
    axes[0][0].annotate('tolerance', (0, tolerance), xytext=(0, -11), textcoords='offset points', fontsize=8)
    axes[1][0].set_xticks(range(len(delays)), [f'{delay:g}' + (', 20 % lost' if loss else '') for delay, loss in delays],
                          fontsize=8)
    axes[1][0].set_xlabel('delay one way (ms), jittered by half of it')
    axes[1][1].set_xticks(range(len(stiffnesses)), [f'{stiffness:g}' for stiffness in stiffnesses])
    axes[1][1].set_xlabel('stiffness at the hand (N/m)')
    axes[0][0].legend(fontsize=8, loc='lower left')
    figure.suptitle('Energy taken from the hand and its oscillation while it means to be at rest')
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == '__main__':
    main(*sys.argv[1:3])
