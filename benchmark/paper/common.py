"""What the sections of the report share: tables from files, pictures in one style, rows of the summary."""
import csv
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before

REPRODUCED = 'reproduced'
DIFFERENCE = 'reproduced with a difference'
NOT_REPRODUCIBLE = 'not reproducible'
VERDICTS = (REPRODUCED, DIFFERENCE, NOT_REPRODUCIBLE)

MEASURED_DEPTH, MEASURED_FORCE, BAND = 45e-6, 7.5e-6, 0.05  # m, N, relative: section V.A of the paper
DIAMETER = 56e-6                                            # m, Table I
BOUND = 0.02  # relative: forces that `indent` itself thinks to be further off are shown, but not used


def item(name, quantity, paper, ours, unit, verdict, why=''):
    """A row of the summary; paper and ours are text."""
    return {'item': name, 'quantity': quantity, 'paper': str(paper), 'ours': str(ours), 'unit': unit,
            'verdict': verdict, 'why': why}


def verdict(ours, paper, within):
    """Reproduced where a number is the paper's to `within`, relative."""
    return REPRODUCED if abs(ours / paper - 1) <= within else DIFFERENCE


def missing(name, quantity, paper, unit, what):
    """The row of something that this run did not find out."""
    return item(name, quantity, paper, 'none', unit, NOT_REPRODUCIBLE, f'{what} left no result in this run')


def read(path):
    """Rows of a CSV file, numbers where a cell is one; none when there is no file."""
    if not Path(path).is_file():
        return []
    with open(path, encoding='utf-8', newline='') as file:
        return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return text


def is_good(row):
    """Whether a row of `indent` is converged, to BOUND by its own estimate."""
    return row['converged'] == 1 and not row.get('error_estimate', 0) > BOUND  # nan, of a formula, is good


def converged(path):
    """(depths in m, forces in N) of the good rows of a table of `indent`."""
    rows = [row for row in read(path) if is_good(row)]
    return [row['depth_m'] for row in rows], [row['force_z_N'] for row in rows]


def at_depth(path, depth):
    """The converged force at a depth, N, or None."""
    for found, force in zip(*converged(path)):
        if abs(found - depth) < 1e-9:
            return force
    return None


def figure(width=7.5, height=4.6, columns=1):
    made, axes = plt.subplots(1, columns, figsize=(width, height), constrained_layout=True)
    for one in axes if columns > 1 else [axes]:
        one.spines[['top', 'right']].set_visible(False)
        one.grid(color='0.92')
        one.set_axisbelow(True)
    return made, axes


def save(made, path):
    made.savefig(path, dpi=130)
    plt.close(made)


def micro(values):
    return [1e6 * value for value in values]


def table(header, rows):
    """Markdown."""
    lines = ['| ' + ' | '.join(header) + ' |', '|' + '---|' * len(header)]
    return '\n'.join(lines + ['| ' + ' | '.join(str(cell) for cell in row) + ' |' for row in rows])
