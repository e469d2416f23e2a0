#!/usr/bin/python3
"""Makes a page of a notebook of injections: what happened, how stiff the cells were, and how well punctures were predicted.

    injection_report.py NOTEBOOK_CSV [--out REPORT_HTML] [--day YYYY-MM-DD]
"""
import argparse
import base64
import collections
import csv
import html
import io
import statistics
import sys
from pathlib import Path

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before
from output_files import check_outputs  # noqa: E402

HEADER = ('time', 'cell', 'diameter_m', 'modulus_Pa', 'outcome')
# Column, factor, digits, heading of the table.
COLUMNS = (('time', None, 0, 'time'), ('cell', None, 0, 'cell'), ('diameter_m', 1e6, 1, 'diameter (µm)'),
           ('modulus_Pa', 1e-3, 2, 'modulus (kPa)'), ('verdict', None, 0, 'verdict'),
           ('expected_force_N', 1e6, 2, 'expected force (µN)'), ('puncture_force_N', 1e6, 2, 'puncture force (µN)'),
           ('expected_depth_m', 1e6, 1, 'expected depth (µm)'), ('puncture_depth_m', 1e6, 1, 'puncture depth (µm)'),
           ('deepest_m', 1e6, 1, 'deepest (µm)'), ('volume_m3', 1e15, 2, 'volume (pL)'), ('outcome', None, 0, 'outcome'),
           ('reason', None, 0, 'reason'))
STYLE = ('body{font-family:sans-serif;margin:2em;max-width:75em}table{border-collapse:collapse;font-size:85%}'
         'td,th{border:1px solid #ccc;padding:.2em .5em;text-align:right}td.text{text-align:left}img{max-width:100%}')


def number(row, column):
    """The value of a column, None where nobody knew it."""
    return float(row[column]) if row[column] else None


def read(path, day=None):
    """@returns the rows of a day, or all. @raises ValueError when the file is no notebook, or has no such row."""
    with open(path, encoding='utf-8', newline='') as file:
        reader = csv.DictReader(file)
        missing = [name for name in HEADER if name not in (reader.fieldnames or ())]
        if missing:
            raise ValueError(f'{path}: is not a notebook of injections: it has no column {", ".join(missing)}')
        rows = list(reader)
    kept = [row for row in rows if not day or row['time'].startswith(day)]
    if not kept:
        days = sorted({row['time'][:10] for row in rows})
        raise ValueError(f'{path}: no rows' + (f' of {day}; there are: {", ".join(days) or "none"}' if day else ''))
    return kept


def picture(figure):
    data = io.BytesIO()
    figure.savefig(data, format='png', dpi=110, bbox_inches='tight')
    plt.close(figure)
    return f'<img alt="" src="data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}">'


def plot_moduli(rows):
    """Modulus with its interval, cell by cell; None when none was estimated."""
    known = [(place, row) for place, row in enumerate(rows, 1) if row['modulus_Pa']]
    if not known:
        return None
    figure, axes = plt.subplots(figsize=(8, 3))
    places = [place for place, _ in known]
    middle = [1e-3 * float(row['modulus_Pa']) for _, row in known]
    below = [m - 1e-3 * float(row['modulus_low_Pa']) for m, (_, row) in zip(middle, known)]
    above = [1e-3 * float(row['modulus_high_Pa']) - m for m, (_, row) in zip(middle, known)]
    axes.errorbar(places, middle, yerr=[below, above], fmt='o', capsize=3, color='#4c78a8')
    axes.set(xlabel='cell', ylabel='modulus (kPa)', xlim=(0.5, len(rows) + 0.5), ylim=(0, None))
    return picture(figure)


def plot_punctures(rows):
    """Puncture forces and depths, met against expected with the interval; None without any."""
    known = [row for row in rows if row['expected_force_N'] and row['puncture_force_N']]
    if not known:
        return None
    figure, both = plt.subplots(1, 2, figsize=(8, 3.6))
    for axes, quantity, unit in zip(both, ('force', 'depth'), ('N', 'm')):
        expected = [1e6 * float(row[f'expected_{quantity}_{unit}']) for row in known]
        low = [1e6 * float(row[f'expected_{quantity}_low_{unit}']) for row in known]
        high = [1e6 * float(row[f'expected_{quantity}_high_{unit}']) for row in known]
        met = [1e6 * float(row[f'puncture_{quantity}_{unit}']) for row in known]
        spread = [[e - a for e, a in zip(expected, low)], [b - e for e, b in zip(expected, high)]]
        axes.errorbar(met, expected, yerr=spread, fmt='o', capsize=3, color='#f58518')
        largest = 1.1 * max(high + met)
        axes.plot((0, largest), (0, largest), color='0.7', linewidth=1)
        axes.set(xlabel=f'{quantity} met (µ{unit})', ylabel=f'{quantity} expected at half depth (µ{unit})',
                 xlim=(0, largest), ylim=(0, largest))
    figure.tight_layout()
    return picture(figure)


def summary(rows):
    """Lines of text."""
    outcomes = collections.Counter(row['outcome'] for row in rows)
    lines = [f'{len(rows)} cells: ' + ', '.join(f'{count} {name}' for name, count in outcomes.most_common())]
    moduli = [number(row, 'modulus_Pa') for row in rows if row['modulus_Pa']]
    if moduli:
        lines.append(f'modulus: median {1e-3 * statistics.median(moduli):.3g} kPa, '
                     f'{1e-3 * min(moduli):.3g} to {1e-3 * max(moduli):.3g} kPa')
    pairs = [(number(row, 'expected_force_N'), number(row, 'puncture_force_N'), number(row, 'expected_force_low_N'),
              number(row, 'expected_force_high_N')) for row in rows if row['expected_force_N'] and row['puncture_force_N']]
    if pairs:
        errors = [abs(expected / met - 1) for expected, met, _, _ in pairs]
        inside = sum(low <= met <= high for _, met, low, high in pairs)
        lines.append(f'puncture force, expected at half depth: {100 * statistics.median(errors):.2g} % off (median), '
                     f'{inside} of {len(pairs)} in the 95 % interval')
    return lines


def cell_of(row, column, factor, digits):
    if factor is None:
        return f'<td class="text">{html.escape(row[column])}</td>'
    value = number(row, column)
    return '<td></td>' if value is None else f'<td>{factor * value:.{digits}f}</td>'


def page(rows, title):
    heading = ''.join(f'<th>{label}</th>' for *_, label in COLUMNS)
    body = ''.join('<tr>' + ''.join(cell_of(row, *column[:3]) for column in COLUMNS) + '</tr>\n' for row in rows)
    pictures = ''.join(f'<p>{plot}</p>' for plot in (plot_moduli(rows), plot_punctures(rows)) if plot)
    lines = ''.join(f'<li>{html.escape(line)}</li>' for line in summary(rows))
    return (f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>'
            f'<style>{STYLE}</style></head><body><h1>{html.escape(title)}</h1><ul>{lines}</ul>{pictures}'
            f'<table><tr>{heading}</tr>\n{body}</table></body></html>\n')


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('notebook', help='CSV file that a session has written (its key notebook)')
    parser.add_argument('--out', help='HTML file; default: beside the notebook')
    parser.add_argument('--day', help='YYYY-MM-DD; default: all rows')
    arguments = parser.parse_args()
    out = Path(arguments.out or Path(arguments.notebook).with_suffix('.html'))
    try:
        check_outputs({'NOTEBOOK': arguments.notebook}, {'--out': out})
        rows = read(arguments.notebook, arguments.day)
        title = f'Injections of {arguments.day or rows[0]["time"][:10] + " to " + rows[-1]["time"][:10]}'
        out.write_text(page(rows, title), encoding='utf-8')
    except (OSError, ValueError) as error:
        print(f'injection_report: {error}', file=sys.stderr)
        return 2
    for line in summary(rows):
        print(line)
    print(f'injection_report: {out}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
