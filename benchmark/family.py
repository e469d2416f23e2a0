#!/usr/bin/python3
"""Families of cells against the converged solution: members at random that were never solved for.

Compares the served forces and surfaces with converged ones at random motions (angle to 56 degrees, depth to 0.3
diameters, sideways to 0.08). The converged places of some members are kept in test/reference/family_NAME.csv. A member
that they lack takes about 2 minutes of two cores, more for `zona`; it is added to the file, so that the benchmark may
be interrupted.
"""
import argparse
import csv
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'tools'))

import full_solution  # noqa: E402

LARGE = 0.02  # of a member's largest force: errors of smaller ones are not counted


def parse_arguments():
    families = sorted(path.stem for path in (ROOT / 'config' / 'families').glob('*.yaml'))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of family.csv')
    parser.add_argument('--families', default=','.join(families), help='default %(default)s')
    parser.add_argument('--members', type=int, help='that are drawn of each (default: those whose places are kept)')
    parser.add_argument('--seed', type=int, default=1, help='of the draw (default %(default)s)')
    return parser.parse_args()


def kept_places(family, arguments):
    """Returns the file of the converged places of a draw: those of the first draw are part of the repository."""
    if arguments.seed == 1:
        return ROOT / 'test' / 'reference' / f'family_{family}.csv'
    return arguments.out / f'places_{family}_{arguments.seed}.csv'


def count_members(kept):
    """Returns how many members' places a file has."""
    if not kept.exists():
        return 0
    lines = kept.read_text(encoding='utf-8').splitlines()[2:]
    return 1 + max((int(line.split(',')[0]) for line in lines), default=-1)


def quantile(values, share):
    return sorted(values)[int(share * (len(values) - 1))]


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for family in arguments.families.split(','):
        table = arguments.out / f'family_{family}.csv'
        kept = kept_places(family, arguments)
        members = arguments.members or count_members(kept)
        if members == 0:
            print(f'{family}: no converged places are kept: choose --members')
            continue
        definition = ROOT / 'config' / 'families' / f'{family}.yaml'
        if not full_solution.check_family(definition, members, arguments.seed, kept, table):
            return 1
        with table.open(encoding='utf-8') as file:
            rows += csv.DictReader(file)
        table.unlink()
    with (arguments.out / 'family.csv').open('w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator='\n')
        writer.writeheader()
        writer.writerows(rows)
    print('family, places, force error in %: median, nine of ten below, largest; surface in diameters: largest')
    for family in sorted({row['family'] for row in rows}):
        own = [row for row in rows if row['family'] == family]
        forces = [100 * float(row['force_error']) for row in own if float(row['force_share']) > LARGE]
        print(f'{family}, {len(forces)}, {quantile(forces, 0.5):.2f}, {quantile(forces, 0.9):.2f}, {max(forces):.2f}; '
              f'{max(float(row["surface_error"]) for row in own):.4f}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
