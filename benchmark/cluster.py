#!/usr/bin/python3
"""Work as files: speed-up from one to two workers, overhead of Snakemake, and a sweep on a real Slurm with faults.

- `prepare`: paths of a family's first members, by one and by two workers, in turn. Each task's results are the same bytes.
- `snakemake`: a sweep of tasks of some seconds by the engine, and by `sweep --jobs` alone, on the same number of cores.
- `slurm`: a sweep of many short tasks as an array of jobs on a Slurm with two nodes on the loopback. Meanwhile a task is
  killed, a node is drained and comes back, and the controller is restarted. The table has to be the same bytes as that of
  one machine. The same by Snakemake with its profile for Slurm.

Needs the packages of src/workflow/dependencies.txt: ./dev setup --cluster.
"""
import argparse
import csv
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'benchmark' / 'common'))

sys.path.insert(0, str(ROOT / 'src' / 'workflow'))

import programs  # noqa: E402
from local_slurm import LocalSlurm, missing_programs  # noqa: E402

PROGRAMS = programs.find('sweep', {}).parent
WORKFLOW = ROOT / 'src/workflow'
PROFILES = ROOT / 'config/workflow'
PARTS = ('prepare', 'snakemake', 'slurm')
SHORT = ROOT / 'test/commands/membrane.yaml'  # a scene whose tasks take no time
SWEEP = """scene: {scene}
design: random
samples: {tasks}
seed: 1
keys:
  - {{key: cell/material/young_modulus, from: 10e3, to: 40e3, scale: log}}
  - {{key: needle/tip/radius, from: 2e-6, to: 4e-6}}
indentation: {{depths: {depths}, model: {model}{more}}}
"""


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of cluster.csv')
    parser.add_argument('--only', choices=PARTS, help='of the parts')
    parser.add_argument('--repeats', type=int, default=3, help='of each time (default %(default)s)')
    parser.add_argument('--paths', type=int, default=24, help='of prepare (default %(default)s)')
    parser.add_argument('--tasks', type=int, default=24, help='of the engine (default %(default)s)')
    parser.add_argument('--short-tasks', type=int, default=10000, help='of the sweep on Slurm (default %(default)s)')
    parser.add_argument('--block', type=int, default=50, help='short tasks of a job (default %(default)s)')
    return parser.parse_args()


class Bench:
    def __init__(self, arguments, folder):
        self.arguments, self.folder, self.rows = arguments, folder, []

    def add(self, part, what, value, unit, spread=''):
        self.rows.append({'part': part, 'what': what, 'value': f'{value:.4g}', 'unit': unit,
                          'spread': f'{spread:.3g}' if spread != '' else ''})
        print(f'{part}: {what}: {value:.4g} {unit}' + (f', spread {spread:.3g}' if spread != '' else ''), flush=True)

    def write(self):
        with open(self.arguments.out / 'cluster.csv', 'w', newline='', encoding='utf-8') as file:
            table = csv.DictWriter(file, ('part', 'what', 'value', 'unit', 'spread'))
            table.writeheader()
            table.writerows(self.rows)

    def add_ratio(self, part, what, ratios):
        self.add(part, what, statistics.median(ratios), '', max(ratios) - min(ratios))

    def sweep_file(self, name, tasks, scene, depths, model, more=''):
        path = self.folder / name
        path.write_text(SWEEP.format(tasks=tasks, scene=scene, depths=depths, model=model, more=more), encoding='utf-8')
        return path

    def prepare(self):
        """The first tasks of a round are small forces on the axis; the paths behind them are the work."""
        family = self.folder / 'homogeneous.yaml'
        shutil.copy(ROOT / 'config/families/homogeneous.yaml', family)
        plan = self.folder / 'plan.csv'
        run(PROGRAMS / 'prepare', '--family', family, '--members', 4, '--list', plan)
        tasks = [int(line.split(',')[0]) for line in plan.read_text().splitlines()[2:] if ',path,' in line]
        tasks = tasks[:self.arguments.paths]
        ratios, contents = [], set()
        for repeat in range(self.arguments.repeats):
            times = []
            for workers in (1, 2):
                cache = self.folder / f'cache_{repeat}_{workers}'
                commands = [[PROGRAMS / 'prepare', '--family', family, '--plan', plan, '--task', task] for task in tasks]
                times.append(in_turn(commands, workers, {'XDG_CACHE_HOME': str(cache)}))
                contents.add(digest(cache))
                shutil.rmtree(cache)
            ratios.append(times[0] / times[1])
        self.add('prepare', f'{len(tasks)} paths by one worker', times[0], 's')
        self.add_ratio('prepare', 'speed-up by two workers', ratios)
        self.add('prepare', 'different results', len(contents) - 1, '')

    def snakemake(self):
        sweep = self.sweep_file('seconds.yaml', self.arguments.tasks,
                                ROOT / 'config/cells/mouse_oocyte_pipette.yaml', '[2e-6, 4e-6, 6e-6, 8e-6]', 'axisymmetric',
                                ', tolerance: 0.002')
        overheads, seconds, tables = [], [], set()
        for repeat in range(self.arguments.repeats):
            alone, engine = self.folder / f'alone_{repeat}', self.folder / f'engine_{repeat}'
            begin = time.monotonic()
            run(PROGRAMS / 'sweep', '--file', sweep, '--out', alone, '--jobs', 2)
            middle = time.monotonic()
            snakemake(self.folder, 'local', sweep, engine, 1, ('--cores', 2))
            end = time.monotonic()
            seconds.append(2 * (middle - begin) / self.arguments.tasks)
            overheads.append((end - middle) / (middle - begin) - 1)
            tables |= {(folder / 'sweep.csv').read_bytes() for folder in (alone, engine)}
        self.add('snakemake', f'time of a task, {self.arguments.tasks} on two cores', statistics.median(seconds), 's')
        self.add_ratio('snakemake', 'overhead of the engine, share', overheads)
        self.add('snakemake', 'different tables', len(tables) - 1, '')

    def slurm(self):
        tasks, block = self.arguments.short_tasks, self.arguments.block
        sweep = self.sweep_file('short.yaml', tasks, SHORT, '[1e-6, 2e-6]', 'membrane')
        alone = self.folder / 'alone'
        begin = time.monotonic()
        run(PROGRAMS / 'sweep', '--file', sweep, '--out', alone, '--jobs', 2)
        self.add('slurm', f'{tasks} tasks by `sweep --jobs 2`', time.monotonic() - begin, 's')
        expected = (alone / 'sweep.csv').read_bytes()
        with LocalSlurm(self.folder / 'slurm') as slurm:
            for name, begin_work in (('array', self.submit_array), ('snakemake', self.start_snakemake)):
                out = slurm.folder / name
                out.mkdir()
                begin = time.monotonic()
                finish = begin_work(slurm, sweep, out)
                faults = do_faults(slurm)
                finish()
                self.add('slurm', f'{tasks} tasks on two nodes, {name}', time.monotonic() - begin, 's')
                self.add('slurm', f'{name}: faults', faults, '')
                table = (out / 'sweep.csv').read_bytes()
                counted = rows_of(table)
                self.add('slurm', f'{name}: rows lost', len(set(rows_of(expected)) - set(counted)), '')
                self.add('slurm', f'{name}: rows twice', len(counted) - len(set(counted)), '')
                self.add('slurm', f'{name}: the same bytes', float(table == expected), '')

    def submit_array(self, slurm, sweep, out):
        last = -(-self.arguments.short_tasks // self.arguments.block) - 1

        def submit():
            slurm.run('sbatch', f'--array=0-{last}', f'--output={slurm.folder}/log/%A_%a', WORKFLOW / 'slurm_array.sh',
                      PROGRAMS / 'sweep', sweep, out, self.arguments.block)

        def finish():
            for attempt in range(1, 6):
                slurm.wait_for(lambda: slurm.waiting_jobs() == 0, 'an empty queue', 3600)
                if gather(sweep, out):
                    return self.add('slurm', 'array: submitted', attempt, 'times')
                submit()
            raise RuntimeError('tasks are missing after five submissions')

        submit()
        return finish

    def start_snakemake(self, slurm, sweep, out):
        log = open(slurm.folder / 'log/snakemake', 'w', encoding='utf-8')
        engine = subprocess.Popen(snakemake_command('slurm', sweep, out, self.arguments.block), cwd=slurm.folder,
                                  env=slurm.environment, stdout=log, stderr=subprocess.STDOUT)

        def finish():
            if engine.wait(timeout=3600):
                raise RuntimeError(f'snakemake failed: {Path(log.name).read_text()[-2000:]}')

        return finish


def do_faults(slurm):
    """A task is killed, a node is drained and comes back, the controller is restarted. Returns how many were done."""
    slurm.wait_for(lambda: any(kill(pid) for pid in slurm.processes()), 'a task to kill')
    slurm.run('scontrol', 'update', 'NodeName=node1', 'State=DRAIN', 'Reason=trial')
    time.sleep(3)
    slurm.restart_controller(3)
    slurm.wait_for(lambda: 'UNKNOWN' not in slurm.state('node1'), 'node1, which the new controller knows')
    slurm.run('scontrol', 'update', 'NodeName=node1', 'State=RESUME')
    return 3


def kill(pid):
    """Returns whether the process was at work when it was killed, and not at its end."""
    try:
        os.kill(pid, signal.SIGSTOP)
        stopped = Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[0] == 'T'
        os.kill(pid, signal.SIGKILL)
        return stopped
    except (ProcessLookupError, FileNotFoundError):
        return False


def rows_of(table):
    """Returns (task, depth) of each row."""
    return [(line.split(b',')[0], line.split(b',')[3]) for line in table.splitlines()[1:]]


def gather(sweep, out):
    """Returns whether all tasks were there."""
    return subprocess.run([PROGRAMS / 'sweep', '--file', sweep, '--out', out, '--gather'], capture_output=True).returncode == 0


def snakemake_command(profile, sweep, out, block):
    return ['snakemake', '-s', WORKFLOW / 'sweep.smk', '--profile', PROFILES / profile, '--config', f'sweep={sweep}',
            f'out={out}', f'block={block}', f'programs={PROGRAMS}']


def snakemake(folder, profile, sweep, out, block, options=()):
    done = subprocess.run([*map(str, snakemake_command(profile, sweep, out, block)), *map(str, options)], cwd=folder,
                          capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f'snakemake failed: {done.stderr[-2000:]}')


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f'{done.args}: {done.stderr[-2000:]}')


def in_turn(commands, workers, variables):
    """Runs all commands, so many at a time. Returns the wall time, s."""
    environment = {**os.environ, 'OPENBLAS_NUM_THREADS': '1', **variables}
    begin = time.monotonic()
    waiting, running = [[str(word) for word in command] for command in commands], []
    while waiting or running:
        while waiting and len(running) < workers:
            running.append(subprocess.Popen(waiting.pop(0), env=environment))
        os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOWAIT)
        for each in [each for each in running if each.poll() is not None]:
            running.remove(each)
            if each.returncode:
                raise RuntimeError(f'{each.args}: status {each.returncode}')
    return time.monotonic() - begin


def digest(folder):
    """Returns the names and bytes of all results in a cache."""
    return tuple((path.name, path.read_bytes()) for path in sorted(folder.rglob('path_*')))


def main():
    arguments = parse_arguments()
    parts = [arguments.only] if arguments.only else PARTS
    missing = [] if shutil.which('snakemake') or parts == ['prepare'] else ['snakemake']
    missing += missing_programs() if 'slurm' in parts else []
    if missing:
        sys.exit(f'{", ".join(missing)}: not installed; ./dev setup --cluster installs them')
    arguments.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments, Path(folder))
        for part in parts:
            getattr(bench, part)()
            bench.write()


if __name__ == '__main__':
    main()
