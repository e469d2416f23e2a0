#!/usr/bin/python3
"""Everything that the paper has, produced by this code, beside what the paper reported.

    report.py --programs DIRECTORY --out DIRECTORY [--jobs N]

Runs the programs behind the report, each with a time limit (what fails or takes too long is left out, and the report
says so), and writes OUT/report.md, its pictures, OUT/summary.csv (item,quantity,paper,ours,unit,verdict) and the
tables that they are made of, OUT/data/*.csv.
"""
import argparse
import concurrent.futures
import csv
import importlib
import os
import subprocess
import sys
import time
from pathlib import Path

from common import VERDICTS, table

ROOT = Path(__file__).resolve().parent.parent.parent
COLUMNS = ('item', 'quantity', 'paper', 'ours', 'unit', 'verdict')

# In the order of the report. Each is a module of this folder with
#   items(data_dir, out_dir) -> [dict(item, quantity, paper, ours, unit, verdict, why)]
#   section(data_dir, out_dir) -> markdown; its pictures are PNGs of out_dir, named relatively
# and, if it needs programs run,
#   tasks(programs, root, data_dir) -> [(name, command, seconds that it may take)]
# without which paper_MODULE --csv DATA/MODULE.csv is run where there is such a program.
SECTIONS = ('table_1', 'table_3', 'force_depth', 'identified', 'stages', 'dynamics', 'prestretch', 'membrane',
            'puncture', 'withdrawal', 'tensegrity')
DEFAULT_LIMIT = 600  # s


class Programs:
    """Finds the built programs, wherever the build put them."""

    def __init__(self, directory):
        self.directory = Path(directory)

    def __contains__(self, name):
        return self.find(name) is not None

    def find(self, name):
        found = [path for path in self.directory.rglob(name) if path.is_file() and os.access(path, os.X_OK)]
        return str(found[0]) if found else None

    def __getitem__(self, name):
        found = self.find(name)
        if found is None:
            raise SystemExit(f'report.py: no program {name} below {self.directory}')
        return found


def load_sections():
    """The modules that there are, by name."""
    folder = Path(__file__).parent
    return {name: importlib.import_module(name) for name in SECTIONS if (folder / f'{name}.py').is_file()}


def tasks_of(name, module, programs, data):
    if hasattr(module, 'tasks'):
        return module.tasks(programs, ROOT, data)
    if f'paper_{name}' in programs:
        return [(name, [programs[f'paper_{name}'], '--csv', str(data / f'{name}.csv')], DEFAULT_LIMIT)]
    return []


def run(task, data):
    """Runs one program. Returns what is to be said about it."""
    name, command, limit = task
    start = time.monotonic()
    environment = dict(os.environ, OPENBLAS_NUM_THREADS='1', OMP_NUM_THREADS='1')
    with open(data / f'{name}.log', 'w', encoding='utf-8') as log:
        log.write(' '.join(map(str, command)) + '\n')
        log.flush()
        try:
            status = subprocess.run(command, stdout=log, stderr=log, timeout=limit, env=environment,
                                    check=False).returncode
            # 3 and 4 of `indent`: some depth has no converged solution, or not to the tolerance, as its table says.
            how = 'done' if status in (0, 3, 4) else f'ended with status {status}'
        except subprocess.TimeoutExpired:
            how = f'stopped after its {limit} s'
    return name, f'{how}, {time.monotonic() - start:.0f} s'


def run_all(tasks, data, jobs):
    """Runs the programs, those that measure times alone and first. Returns {name: how it ended}."""
    ended, start = {}, time.monotonic()

    def tell(outcome):
        ended[outcome[0]] = outcome[1]
        print(f'[{len(ended)}/{len(tasks)}] {time.monotonic() - start:5.0f} s  {outcome[0]}: {outcome[1]}', flush=True)

    alone = [task for task in tasks if task[0] in ('meshes', 'dynamics')]
    for task in alone:
        tell(run(task, data))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        waiting = [pool.submit(run, task, data) for task in tasks if task not in alone]
        for done in concurrent.futures.as_completed(waiting):
            tell(done.result())
    return ended


def write_summary(items, path):
    for row in items:
        if row['verdict'] not in VERDICTS:
            raise ValueError(f'{row["item"]}: verdict = {row["verdict"]}: must be one of {", ".join(VERDICTS)}')
    with open(path, 'w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, COLUMNS, extrasaction='ignore')
        writer.writeheader()
        writer.writerows(items)


def summary_of(items):
    """Markdown: a row for every item, why where it is not simply reproduced."""
    rows = [[row[column] for column in COLUMNS] + [row.get('why', '')] for row in items]
    return table(COLUMNS + ('why',), rows)


def write_report(modules, items, ended, data, out):
    parts = ['# The paper, reproduced', __doc__.splitlines()[0],
             'H. Ladjal, J.-L. Hanus and A. Ferreira, *Micro-to-Nano Biomechanical Modeling for Assisted Biological '
             'Cell Injection*. Made by `./dev paper`; only values that the text of the paper gives are compared, none '
             'is read off its plots.', '## Summary', summary_of(items)]
    parts += [module.section(data, out) for module in modules.values()]
    parts += ['## What was run', table(('program', 'outcome'), sorted(ended.items()))]
    (out / 'report.md').write_text('\n\n'.join(parts) + '\n', encoding='utf-8')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--programs', type=Path, required=True, help='folder below which the built programs are')
    parser.add_argument('--out', type=Path, required=True, help='folder to write to')
    parser.add_argument('--jobs', type=int, default=2, help='programs at a time; default 2')
    parser.add_argument('--keep-data', action='store_true', help='run nothing: report what OUT/data has')
    arguments = parser.parse_args()
    data = arguments.out / 'data'
    data.mkdir(parents=True, exist_ok=True)
    modules, programs, ended = load_sections(), Programs(arguments.programs), {}
    if not arguments.keep_data:
        tasks = [task for name, module in modules.items() for task in tasks_of(name, module, programs, data)]
        ended = run_all(tasks, data, arguments.jobs)
    items = [row for module in modules.values() for row in module.items(data, arguments.out)]
    write_summary(items, arguments.out / 'summary.csv')
    write_report(modules, items, ended, data, arguments.out)
    print(f'{len(items)} items; {arguments.out / "report.md"}')
    failed = [f'{name} ({how})' for name, how in ended.items() if not how.startswith('done')]
    if failed:
        print('incomplete: ' + ', '.join(failed), file=sys.stderr)
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
