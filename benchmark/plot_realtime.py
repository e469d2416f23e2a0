"""Picture of the real-time benchmark: how late periods were, cell simulator and bare loop. Usage: CSV PNG."""
import csv
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402

LOOKS = {'bare_timer_loop': ('bare timer loop', '#8fb8de'), 'cell_simulator': ('cell simulator', '#c8553d')}
NEAR = numpy.arange(-1, 3.01, 0.05)        # ms, lateness around the limit
SHORTEST, LONGEST = 0.02, 1e4              # ms, of the tail


def late_share(uppers, counts, limits):
    """Share of the periods that were later than each of `limits`."""
    return numpy.array([counts[uppers > limit].sum() for limit in limits]) / max(1, counts.sum())


def main(table, picture):
    with open(table, encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    shares = next(row for row in rows if row['what'] == 'share_late_by_more')
    bins = [row for row in rows if row['what'] == 'bin_up_to']
    uppers = numpy.array([float(row['lateness_ms']) for row in bins])
    figure, (near, tail) = plt.subplots(1, 2, figsize=(11, 4.2))
    for source, (label, colour) in LOOKS.items():
        counts = numpy.array([int(row[source]) for row in bins])
        middle = uppers - 0.01 * (uppers + 1)  # bins are 2 % of the interval wide
        near.hist(numpy.clip(middle, NEAR[0], NEAR[-1] - 1e-9), NEAR, weights=counts, histtype='stepfilled', alpha=0.45,
                  color=colour, label=f'{label}: {100 * float(shares[source]):.3g} % later than 1 ms')
        limits = numpy.geomspace(SHORTEST, LONGEST, 400)
        share = late_share(uppers, counts, limits)
        tail.plot(limits[share > 0], share[share > 0], color=colour, label=label)
    near.set(yscale='log', xlabel='lateness of a period (ms); the last bin holds all later ones', ylabel='periods')
    tail.set(xscale='log', yscale='log', xlabel='lateness (ms)', ylabel='share of the periods that is later')
    for axes in (near, tail):
        axes.axvline(1, color='0.5', linewidth=0.8, linestyle=':')
        axes.grid(color='0.92')
        axes.set_axisbelow(True)
        axes.spines[['top', 'right']].set_visible(False)
        axes.legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=120)


if __name__ == '__main__':
    main(*sys.argv[1:3])
