#!/usr/bin/python3
"""Tasks that anybody's program can enter: a tool's force, a cell's modulus, an injection, and what an image shows.

    ./dev bench field                                  # all entries that are here
    ./dev bench field -- --entry mine.py --seed 7      # and a stranger's, on cells that nobody has seen

The cells are drawn from the seed, so that nobody can tune to them, and the reference of each force is solved here, on
finer and finer meshes until it is known to 0.3 %. The images are the virtual microscope's, which knows their truth. An
entry is a Python file with any of

    def force(scene, depths):             scene: a dict as a scene file; depths: m, (n,)
        return forces                     # N, along the pipette, (n,); nan where there is none
    def modulus(scene, depths, forces):   forces: N, (n,), with a sensor's noise
        return modulus                    # Pa, of the cell
    def policy(observation):              names in cell_microinjection.gym.OBSERVATION; asked each 10 ms
        return vx, vy, vz, inject         # m/s, and whether to inject
    def prepare(scenes): ...              # once, before any force; its time is told
    def tip(image, scale):                image: (height, width), uint8; scale: m/px
        return x, y                       # px, of the injection pipette's tip; nan where it is not sure
    def cell(image, scale):
        return x, y, diameter             # px, of the cell without its dimple; nan where it is not sure

Bullet, CalculiX and GetFEM enter where ./dev setup --peers has installed them. They are programs, which are started for each
cell: the time of a force is that of the steps to it, as the program states it.
"""
import argparse
import copy
import csv
import importlib.util
import os
import platform
import sys
import tempfile
import time
from pathlib import Path

import matplotlib
import numpy

from cell_microinjection import (Cell, ConfigError, Scene, __version__, find_tip, gym, identify, indent, measure_cell,
                                 render_specimen)

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen before

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'benchmark' / 'peers'))

import peer_entries  # noqa: E402

REFERENCE = 0.003           # relative error that a reference may have
SHARES = numpy.linspace(0.02, 0.2, 10)  # depths of a reference, over the diameter
NOISE = 0.01                # of the largest force, standard deviation of a reading
PERIOD = 10                 # ms, of a policy
GAINS = 8, 40               # electrons a grey level, of the images' sensors: noisy to usual
SHOWN = 8                   # px within the image, of what is to be found in it
MARKERS = 'os^Dv*P'         # of the picture
TASKS = 'force', 'modulus', 'policy', 'tip', 'cell'
LINES = ('task', 'entry', 'cases', 'median', 'nine of ten', 'worst', 'failed', 'us a force', 'ms a cell or image', 'prepared in s', 'broke even')


def drawn_scenes(count, seed):
    """Oocytes and other round cells under a hemisphere: size, modulus, tip, holder and Poisson's ratio at random."""
    random = numpy.random.default_rng(seed)
    base = Scene.load('mouse_oocyte_injection')
    scenes = []
    for _ in range(count):
        diameter = random.uniform(30e-6, 150e-6)
        scenes.append(base.replace({
            'cell/diameter': diameter, 'cell/material/young_modulus': numpy.exp(random.uniform(*numpy.log([2e3, 45e3]))),
            'cell/material/poisson_ratio': random.uniform(0.455, 0.498), 'needle/tip/radius': diameter * random.uniform(0.022, 0.095),
            'holding_pipette/contact_radius': diameter * random.uniform(0.12, 0.24)}))
    return scenes


class Ours:
    """A cell by the same choice as a session, or by a named model."""

    def __init__(self, model):
        self._model, self._cell, self._scene = model, None, None

    def force(self, scene, depths):
        if self._scene != scene:
            self._cell, self._scene = Cell(Scene(scene), self._model), scene
        return self._cell.force(self._cell.tips(depths), along=True)[:, 2]


class Family(Ours):
    """A member of a shipped family, and `identify` with it."""

    def __init__(self):
        super().__init__('surrogate')

    @staticmethod
    def modulus(scene, depths, forces):
        return identify({'position_m': depths, 'force_N': forces}, Scene(scene), intervals=False)['young_modulus'].value


class Hertz:
    """Paraboloid on a sphere (Johnson, Contact Mechanics, 4.2)."""

    @staticmethod
    def force(scene, depths):
        cell, tip = scene['cell'], scene['needle']['tip']
        radius = 1 / (1 / tip['radius'] + 2 / cell['diameter'])
        plane = cell['material']['young_modulus'] / (1 - cell['material']['poisson_ratio'] ** 2)
        return 4 / 3 * plane * numpy.sqrt(radius) * numpy.maximum(depths, 0) ** 1.5

    @staticmethod
    def modulus(scene, depths, forces):
        return identify({'position_m': depths, 'force_N': forces}, Scene(scene), 'hertz', intervals=False)['young_modulus'].value


class Shell:
    """A point load on a thin shell of a tenth of the radius (Reissner 1946): what a cell with a stiff border would be."""

    @staticmethod
    def force(scene, depths):
        cell = scene['cell']
        radius, nu = cell['diameter'] / 2, cell['material']['poisson_ratio']
        thickness = 0.1 * radius
        return 4 * cell['material']['young_modulus'] * thickness**2 * depths / (radius * numpy.sqrt(3 * (1 - nu**2)))


class Network:
    """A small neural network, trained on forces of the same kind of cell that are solved here (PyTorch)."""

    def __init__(self, count, seed):
        self._count, self._seed, self._net = count, seed, None

    @staticmethod
    def _inputs(scene, depths):
        cell = scene['cell']
        ratios = [scene['needle']['tip']['radius'] / cell['diameter'], scene['holding_pipette']['contact_radius'] / cell['diameter'],
                  cell['material']['poisson_ratio']]
        return numpy.column_stack([numpy.tile(ratios, (len(depths), 1)), numpy.asarray(depths) / cell['diameter']])

    @staticmethod
    def _scale(scene):
        return scene['cell']['material']['young_modulus'] * scene['cell']['diameter'] ** 2

    def prepare(self, _):
        import torch
        torch.manual_seed(self._seed)
        torch.set_num_threads(1)
        inputs, outputs = [], []
        for scene in drawn_scenes(self._count, self._seed + 1):
            depths = numpy.linspace(0.01, 0.21, 12) * scene.diameter
            solved = indent(scene, depths, tolerance=0.01)
            good = solved['converged']
            keys = scene.to_dict()
            inputs.append(self._inputs(keys, depths)[good])
            outputs.append(numpy.log(solved['force'][good, 2] / self._scale(keys)))
        inputs, outputs = numpy.concatenate(inputs), numpy.concatenate(outputs)
        self._mean, self._deviation = inputs.mean(0), inputs.std(0)
        self._power = numpy.polyfit(numpy.log(inputs[:, -1]), outputs, 1)
        x = torch.tensor((inputs - self._mean) / self._deviation, dtype=torch.float64)
        y = torch.tensor(outputs - numpy.polyval(self._power, numpy.log(inputs[:, -1])), dtype=torch.float64)
        self._net = torch.nn.Sequential(torch.nn.Linear(4, 48), torch.nn.Tanh(), torch.nn.Linear(48, 48), torch.nn.Tanh(),
                                        torch.nn.Linear(48, 1)).double()
        steps = torch.optim.LBFGS(self._net.parameters(), max_iter=1500, history_size=50, line_search_fn='strong_wolfe')

        def loss():
            steps.zero_grad()
            value = ((self._net(x)[:, 0] - y) ** 2).mean() + 1e-7 * sum((p**2).sum() for p in self._net.parameters())
            value.backward()
            return value

        steps.step(loss)

    def force(self, scene, depths):
        import torch
        inputs = self._inputs(scene, depths)
        with torch.no_grad():
            rest = self._net(torch.tensor((inputs - self._mean) / self._deviation))[:, 0].numpy()
        return self._scale(scene) * numpy.exp(rest + numpy.polyval(self._power, numpy.log(inputs[:, -1])))


class Proportional:
    """Down until a membrane has given way, deeper until all have, the pulse, and out: 20 lines, as a stranger would begin."""

    @staticmethod
    def policy(observation):
        seen = dict(zip(gym.OBSERVATION, observation))
        state, diameter = gym.STATES[int(seen['state'])], seen['diameter_m']
        if seen['volume_m3'] > 1.5e-14:
            return 0, 0, 0.5 * diameter, 0
        if state in ('punctured', 'inject') and seen['punctures'] >= 1:
            return 0, 0, 0, 1
        speed = 0.25 if state in ('idle', 'approach') else 0.08
        return 0, 0, -speed * diameter, 0


class Eyes:
    """What is sure of all that the node `vision` sees in a first image."""

    @staticmethod
    def tip(image, scale):
        found = find_tip(image)
        return found['place'] if found['verdict'] == 'found' else (numpy.nan, numpy.nan)

    @staticmethod
    def cell(image, scale):
        found = measure_cell(image, scale)
        return (*found.centre, found.diameter[0] / scale) if found.verdict == 'found' else [numpy.nan] * 3


def load_entry(path):
    spec = importlib.util.spec_from_file_location(Path(path).stem, path)
    if spec is None:
        raise ConfigError(f'--entry {path}: is no Python file')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not any(hasattr(module, name) for name in TASKS):
        raise ConfigError(f'--entry {path}: has none of the functions {", ".join(TASKS)}')
    return module


def short(number):
    """As text with two digits."""
    return f'{float(f"{number:.2g}"):g}'


def quantiles(errors, scale=100):
    errors = scale * numpy.sort(errors)
    if not len(errors):
        return '', '', ''
    return tuple(short(errors[int(share * (len(errors) - 1))]) for share in (0.5, 0.9, 1))


def references(scenes):
    """@returns [(scene as a dict, depths, forces)], of forces that are known to REFERENCE."""
    known = []
    for number, scene in enumerate(scenes):
        print(f'\rfield: reference {number + 1} of {len(scenes)}', end='', file=sys.stderr)
        depths = SHARES * scene.diameter
        solved = indent(scene, depths, tolerance=REFERENCE)
        good = solved['converged'] & (solved['error_estimate'] <= REFERENCE)
        if good.any():
            known.append((scene.to_dict(), depths[good], solved['force'][good, 2]))
    print(file=sys.stderr)
    return known


def asked(function, *arguments, count):
    """What an entry gives for copies of the arguments: (n,) numbers; nan where it fails.
    @returns (numbers, s)"""
    own = [copy.deepcopy(argument) for argument in arguments]
    begin = time.perf_counter()
    try:
        found = numpy.asarray(function(*own), dtype=float).reshape(-1)
    except peer_entries.Declined:
        raise
    except Exception as error:  # pylint: disable=broad-except  a stranger's program may raise anything
        print(f'field: {type(error).__name__}: {error}', file=sys.stderr)
        found = numpy.full(count, numpy.nan)
    took = time.perf_counter() - begin
    return (found if len(found) == count else numpy.full(count, numpy.nan)), took


def score_force(name, entry, known, solved_in):
    begin = time.perf_counter()
    if hasattr(entry, 'prepare'):
        entry.prepare([copy.deepcopy(scene) for scene, _, _ in known])
    prepared = time.perf_counter() - begin
    is_peer = isinstance(entry, peer_entries.Peer)
    known = known[:entry.cells] if is_peer else known
    errors, failed, costs, first = [], 0, [], []
    for scene, depths, truth in known:
        count = len(depths)
        if not is_peer:
            _, took = asked(entry.force, scene, 0.93 * depths, count=count)   # the first call for a cell may set it up
            _, again = asked(entry.force, scene, 0.97 * depths, count=count)  # other depths: nothing can be remembered
            costs.append(again / count)
            first.append(max(took - again, 0))
        found, took = asked(entry.force, scene, depths, count=count)
        if is_peer:
            costs.extend(entry.times)
            first.append(max(took - sum(entry.times), 0))
        good = numpy.isfinite(found)
        failed += int((~good).sum())
        errors.extend(numpy.abs(found[good] / truth[good] - 1))
    cost = numpy.median(costs)
    even = f'{prepared / (solved_in - cost):.0f}' if prepared > 0.01 and cost < solved_in else ''
    told = f'{prepared:.3g}' if prepared > 0.01 else ''
    return ('force', name, sum(len(depths) for _, depths, _ in known), *quantiles(errors), failed, short(1e6 * cost),
            short(1e3 * numpy.median(first)), told, even)


def score_modulus(name, entry, known, seed):
    """The cells are as large as those of the forces, and have other moduli: a force is proportional to it."""
    random = numpy.random.default_rng(seed)
    errors, failed = [], 0
    for scene, depths, truth in known:
        factor = numpy.exp(random.uniform(-1, 1))
        modulus, truth = factor * scene['cell']['material']['young_modulus'], factor * truth
        fine = numpy.concatenate([numpy.linspace(-0.05, 0, 60), numpy.linspace(0, 1, 240)]) * depths[-1]
        into = numpy.maximum(fine, 0)
        # Between known forces a power of the depth; above the first one that of Hertz.
        shallow = into < depths[0]
        force = numpy.exp(numpy.interp(numpy.log(numpy.maximum(into, depths[0])), numpy.log(depths), numpy.log(truth)))
        force[shallow] = truth[0] * (into[shallow] / depths[0]) ** 1.5
        force = force + random.normal(0, NOISE * truth[-1], len(force))
        told = {**scene, 'cell': {**scene['cell'], 'material': {**scene['cell']['material'], 'young_modulus': 10e3}}}
        found = asked(entry.modulus, told, fine, force, count=1)[0][0]
        failed += not numpy.isfinite(found)
        errors.extend([abs(found / modulus - 1)] if numpy.isfinite(found) else [])
    return 'modulus', name, len(known), *quantiles(errors), failed, '', '', '', ''


def score_policy(name, entry, cells):
    scores, injected = [], 0
    for cell in cells:
        env = gym.Inject(steps=PERIOD)
        observation, _ = env.reset(options={'cell': int(cell)})
        over = False
        info = None
        while not over:
            action, _ = asked(entry.policy, observation, count=4)
            if not env.action_space.contains(action):
                break
            observation, _, done, late, info = env.step(action)
            over = done or late
        if not over:
            scores.append(0.0)
            continue
        scores.append(info['score'])
        measures = info['measures']
        injected += info['outcome'] == 'complete' and all(
            measures[key]['value'] >= share * measures[key]['reference'] for key, share in (('punctures', 1), ('volume_m3', 0.5)))
    scores = numpy.sort(scores)
    return ('injection, score', name, len(cells), f'{scores[len(scores) // 2]:.3g}', f'{scores[len(scores) // 10]:.3g}', f'{scores[0]:.3g}',
            len(cells) - injected, '', '', '', '')


def rendered(count, seed):
    """@returns [(image, truth)]"""
    random = numpy.random.default_rng(seed)
    return [render_specimen(int(random.integers(1, 2**31 - 1)), {'sensor': {'gain': random.uniform(*GAINS)}})
            for _ in range(count)]


def score_seeing(name, entry, shown):
    """Errors in px. An image in which the tip, or the cell's centre, is outside is not asked for it."""
    rows = []
    for what, keys in (('tip', ('tip',)), ('cell', ('centre', 'diameter'))):
        off, times = [], []
        for image, truth in shown if hasattr(entry, what) else []:
            wanted = numpy.concatenate([numpy.atleast_1d(truth[key]) for key in keys])
            if not all(SHOWN <= place < size - SHOWN for place, size in zip(wanted, reversed(image.shape))):
                continue
            found, took = asked(getattr(entry, what), image, truth['pixel_size'], count=len(wanted))
            off.append(found - wanted)
            times.append(took)
        if not off:
            continue
        good = numpy.array([each for each in off if numpy.isfinite(each).all()]).reshape(-1, len(off[0]))
        errors = {f'{what}, px': numpy.hypot(good[:, 0], good[:, 1])}
        if what == 'cell':
            errors['diameter, px'] = numpy.abs(good[:, 2])
        rows.extend((task, name, len(off), *quantiles(each, 1), len(off) - len(good), '', short(1e3 * numpy.median(times)), '', '')
                    for task, each in errors.items())
    return rows


def draw(rows, path):
    """The picture of a table's forces."""
    figure, axes = plt.subplots(figsize=(7, 4.5))
    forces = [dict(zip(LINES, row)) for row in rows if row[0] == 'force' and row[3] != '']
    for number, row in enumerate(sorted(forces, key=lambda row: float(row['us a force']))):
        cost, middle, common = (float(row[name]) for name in ('us a force', 'median', 'nine of ten'))
        axes.errorbar([cost], [middle], yerr=[[0], [common - middle]], fmt=MARKERS[number % len(MARKERS)], capsize=3, label=row['entry'])
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.margins(x=0.12, y=0.1)
    axes.set_xlabel('time of a force (us)')
    axes.set_ylabel('error of the force (%), median and nine of ten')
    axes.grid(True, which='both', alpha=0.2)
    axes.legend(loc='upper left', bbox_to_anchor=(1, 1), title='the quickest first')
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of field.csv and field.png')
    parser.add_argument('--seed', type=int, default=1, help='of the cells (default %(default)s)')
    parser.add_argument('--cells', type=int, default=24, help='whose force is asked for (default %(default)s)')
    parser.add_argument('--injections', type=int, default=200, help='random cells for policies (default %(default)s)')
    parser.add_argument('--images', type=int, default=100, help='in which tip and cell are searched (default %(default)s)')
    parser.add_argument('--entry', type=Path, action='append', default=[], help='file of an entry; may be repeated')
    parser.add_argument('--network', type=int, default=60, help='cells that the network is trained on; 0: without it')
    parser.add_argument('--without', default='', help='entries that are left out, with commas between them')
    parser.add_argument('--time-limit', type=float, default=300, help='s, for a program on one cell (default %(default)s)')
    parser.add_argument('--programs', type=Path, default=ROOT / 'catkin_ws' / 'devel' / 'lib' / 'cell_microinjection',
                        help='folder of the built programs')
    return parser.parse_args()


def entries_of(arguments, folder):
    """folder: of the peers' cases"""
    left_out = arguments.without.split(',')
    entries = {'family': Family(), 'live': Ours('live'), 'hertz': Hertz, 'shell': Shell, 'proportional': Proportional,
               'eyes': Eyes}
    peers, missing = peer_entries.entries(arguments.programs.resolve(), folder, arguments.time_limit)
    entries.update(peers)
    for name in missing.keys() - set(left_out):
        print(f'field: {name} is left out: {missing[name]}', file=sys.stderr)
    if arguments.network and importlib.util.find_spec('torch'):
        entries['network'] = Network(arguments.network, arguments.seed + 1000)
    for path in arguments.entry:
        if path.stem in entries:
            raise ConfigError(f'--entry {path}: {path.stem} is there already: give it another name')
        entries[path.stem] = load_entry(path)
    return {name: entry for name, entry in entries.items() if name not in left_out}


def scored(name, entry, known, solved_in, shown, arguments):
    """@returns the rows of an entry"""
    rows = []
    if hasattr(entry, 'force'):
        rows.append(score_force(name, entry, known, solved_in))
    if hasattr(entry, 'modulus'):
        rows.append(score_modulus(name, entry, known, arguments.seed))
    if hasattr(entry, 'policy'):
        cells = numpy.random.default_rng(arguments.seed).integers(1, 2**31 - 1, arguments.injections)
        rows.append(score_policy(name, entry, cells))
    return rows + score_seeing(name, entry, shown)


def main():
    arguments = parse_arguments()
    with tempfile.TemporaryDirectory() as folder:
        try:
            entries = entries_of(arguments, Path(folder))
        except (ConfigError, OSError, SyntaxError) as error:
            sys.exit(f'field: {error}')
        run(arguments, entries)


def run(arguments, entries):
    print(f'machine: {platform.machine()}, {os.cpu_count()} cores; version {__version__}; seed {arguments.seed}')
    begin = time.perf_counter()
    known = references(drawn_scenes(arguments.cells, arguments.seed))
    solved_in = (time.perf_counter() - begin) / max(sum(len(depths) for _, depths, _ in known), 1)
    shown = rendered(arguments.images, arguments.seed)
    rows = []
    for name, entry in entries.items():
        print(f'field: {name}', file=sys.stderr)
        try:
            rows.extend(scored(name, entry, known, solved_in, shown, arguments))
        except peer_entries.Declined as reason:
            print(f'field: {name} is left out: {reason}', file=sys.stderr)
    with (arguments.out / 'field.csv').open('w', encoding='utf-8', newline='') as file:
        table = csv.writer(file)
        table.writerow(LINES)
        table.writerows(rows)
    widths = [max(len(str(row[i])) for row in [LINES, *rows]) for i in range(len(LINES))]
    for row in [LINES, *rows]:
        print('  '.join(str(cell).ljust(width) for cell, width in zip(row, widths)))
    draw(rows, arguments.out / 'field.png')


if __name__ == '__main__':
    main()
