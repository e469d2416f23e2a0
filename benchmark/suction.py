#!/usr/bin/python3
"""Cells that suction holds: tongues against a closed form and a second solver, the needle's force, the modulus from tongues.

    ./dev bench suction                         # GetFEM where it is installed (./dev setup --peers)
    ./dev bench suction -- --cells 10 --studies 'half-space,modulus'

One table, a row a case; a study is what its cases ask:
  half-space     a small mouth on a large cell: Phi of L/a = 3 Phi dp / (2 pi E), which is 2.0 to 2.1 for a flat mouth that touches all
                 over (Theret and others, J. Biomech. Eng. 110, 1988); compared with a half-space of a sphere's and a lip's gap,
                 which knows how much of the wall does (benchmark/peers/half_space_mouth.py)
  second solver  tongue of six cells by this project and by GetFEM, each with its own error
  needle         force on a needle of a held cell, over that of the cell glued to a ring of the seal's radius
  modulus        found from six tongues with the noise of an image, of random cells
  joined         found from six tongues, from a needle's force with the noise of a sensor, and from both; with a sensor that is
                 exact but for that, and with one whose calibration has a deviation of 5 %
  breaks         random cells whose membrane the controller draws into the needle until it breaks: which breaks it tells, how
                 soon the suction ends, and how much was drawn in too much; by force, by images of the interface and by both
  families       random cells that no family has solved: tongues and surfaces of the family and solved, and the needle's force
                 on held cells as it is served and solved
  hard           cells at the limits of the model: a tongue or a reason
  slip           ./dev bench slip: what a hold bears
  motion         ./dev bench cell_motion: rest on the dish, energy, drag, hard cases
"""
import argparse
import csv
import importlib.util
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy

from cell_microinjection import Cell, ConfigError, Scene, _core, aspirate, combine_moduli, identify, identify_tongue, indent, tongue_family

sys.path.insert(0, str(Path(__file__).resolve().parent / 'peers'))
import half_space_mouth  # noqa: E402

PEER = Path(__file__).resolve().parent / 'peers' / 'getfem_held_cell.py'
LINES = ('study', 'case', 'value', 'error', 'other', 'other error', 'unit', 's')
MODULUS = 5e3   # Pa
HELD_ERROR = 0.015  # of the ratio of a held cell's force to a glued one's, by the family of held forces: 1.5 % in nine of ten
CALIBRATION = 0.05  # deviation of a force sensor's gain, relative
PEER_SIZE = 1.4  # of the second solver's coarsest mesh: it has a quarter of the lip's edge there at 1
# Radii of cell, bore, pipette and lip's edge, um; Poisson's ratio; suctions over the modulus.
CELLS = ((40, 12, 32, 2, 0.49, (0.01, 0.05, 0.1, 0.2)), (40, 12, 32, 4, 0.49, (0.01, 0.05, 0.1, 0.2)), (40, 20, 45, 3, 0.49, (0.01, 0.05, 0.1)),
         (60, 8, 20, 2, 0.45, (0.01, 0.05, 0.1, 0.2)), (28, 7, 25, 1.5, 0.49, (0.01, 0.05, 0.1, 0.2)), (75, 30, 60, 6, 0.4, (0.01, 0.05, 0.1)))


def held_scene(radius, inner, outer, edge, poisson_ratio, modulus=MODULUS, model='neo_hookean', pressure=-1.0):
    """@returns the Scene of a homogeneous cell at a mouth without friction; lengths in um"""
    return Scene({
        'cell': {'diameter': 2e-6 * radius, 'material': {'model': model, 'young_modulus': modulus, 'poisson_ratio': poisson_ratio}},
        'holding_pipette': {'mouth': {'inner_radius': 1e-6 * inner, 'outer_radius': 1e-6 * outer, 'edge_radius': 1e-6 * edge,
                                      'pressure': pressure, 'contact': {'mode': 'sliding'}}},
        'needle': {'tip': {'shape': 'hemisphere', 'radius': 0.08e-6 * radius}}})


def half_space():
    """Phi, by how the tongue grows between two suctions, for mouths of other sizes on one cell, whose wall is as wide as the bore."""
    edge = 0.02
    for inner in (2.0, 4.0, 20.0, 36.0):
        begin = time.perf_counter()
        scene = held_scene(400, inner, 2 * inner, edge * inner, 0.499, model='linear')
        suctions = numpy.array([0.02, 0.04, 0.05])
        drawn = aspirate(scene, -MODULUS * suctions, tolerance=0.02)
        took = (time.perf_counter() - begin) / 2
        lengths, errors = drawn['tongue_length'] / (1e-6 * inner), drawn['error_estimate']
        fine, coarse = ([half_space_mouth.tongue(p, 400 / inner, edge, 2.0, rings) for p in suctions] for rings in (400, 200))
        for i in (0, 1):
            # The closed form's radius is where contact begins, which the lip's edge puts a little outside of the bore.
            begins, ends = ((fine[i][k] + fine[i + 1][k]) / 2 for k in (1, 2))
            slope = 2 * numpy.pi / 3 / (suctions[i + 1] - suctions[i]) / begins
            phi, other, coarser = (slope * (length[i + 1] - length[i]) for length in (lengths, *([each[0] for each in mesh] for mesh in (fine, coarse))))
            flat = half_space_mouth.flat_phi(ends / begins - 1, True)
            print(f'suction: half-space: a/R = {inner / 400:g}: the wall is in contact from {begins:.3f} to {ends:.2f} a; a flat wall of that width has '
                  f'Phi = {flat:.4g}')
            yield ('half-space', f'a/R = {inner / 400:g}, p/E = {suctions[i]:g} to {suctions[i + 1]:g}', phi, phi * errors[i:i + 2].max(), other,
                   abs(other - coarser), 'Phi', took)


def peer_tongues(scene, pressures, folder):
    """@returns [(length, error)], m, by the second solver; nan where it has none."""
    scene.save(folder / 'scene.yaml')
    subprocess.run([sys.executable, '-B', PEER, folder / 'scene.yaml', ','.join(f'{p:g}' for p in pressures), folder / 'peer.csv',
                    '--size-factor', str(PEER_SIZE)], check=True, stdout=subprocess.DEVNULL)
    with (folder / 'peer.csv').open(encoding='utf-8') as file:
        return [(float(row['tongue_length_m']), float(row['tongue_error_m'])) for row in csv.DictReader(file)]


def second_solver():
    missing = importlib.util.find_spec('getfem') is None
    for number, (radius, inner, outer, edge, poisson_ratio, suctions) in enumerate(CELLS, 1):
        begin = time.perf_counter()
        scene = held_scene(radius, inner, outer, edge, poisson_ratio)
        pressures = [-MODULUS * suction for suction in suctions]
        drawn = aspirate(scene, pressures, tolerance=0.002)
        took = (time.perf_counter() - begin) / len(suctions)
        with tempfile.TemporaryDirectory() as folder:
            peer = [(numpy.nan, numpy.nan)] * len(suctions) if missing else peer_tongues(scene, pressures, Path(folder))
        for i, (length, error) in enumerate(peer):
            own = drawn['tongue_length'][i]
            yield ('second solver', f'cell {number}, p/E = {suctions[i]:g}', 1e6 * own, 1e6 * abs(own) * drawn['error_estimate'][i],
                   1e6 * length, 1e6 * error, 'um', took)


def needle():
    for suction in (0.0, 0.02, 0.05, 0.1, 0.2):
        begin = time.perf_counter()
        held = held_scene(40, 12, 32, 2, 0.49, pressure=-MODULUS * suction)
        keys = held.to_dict()
        seal = aspirate(held)['seal_radius'][0]
        keys['holding_pipette'] = {'contact_radius': float(seal)}
        depths = numpy.array([2e-6, 4e-6, 8e-6, 12e-6])
        own, glued = indent(held, depths), indent(Scene(keys), depths)
        took = time.perf_counter() - begin
        for i, depth in enumerate(depths):
            yield ('needle', f'p/E = {suction:g}, {1e6 * depth:g} um', 1e6 * own['force'][i, 2], 1e6 * own['force'][i, 2] * own['error_estimate'][i],
                   1e6 * glued['force'][i, 2], 1e6 * glued['force'][i, 2] * glued['error_estimate'][i], 'uN', took)


def modulus(count, noise, seed):
    """Of random cells; the tongues are those of a converged solution, read from any place with an image's noise."""
    random = numpy.random.default_rng(seed)
    for number in range(count):
        begin = time.perf_counter()
        radius = random.uniform(25, 80)
        inner, edge, true = radius * random.uniform(0.15, 0.4), radius * random.uniform(0.03, 0.08), numpy.exp(random.uniform(*numpy.log([1e3, 2e4])))
        scene = held_scene(radius, inner, inner + 4 * edge, edge, random.uniform(0.4, 0.49), true)
        pressures = -true * random.uniform(0.1, 0.2) * numpy.linspace(1 / 6, 1, 6)
        lengths = aspirate(scene, pressures)['tongue_length'] + random.uniform(-2e-6, 2e-6) + random.normal(0, noise, 6)
        told = scene.replace({'cell/material/young_modulus': 5e3})
        try:
            found = identify_tongue(pressures, lengths, told)['young_modulus']
            half = (found.high - found.low) / 2
        except ConfigError as error:
            print(f'suction: cell {number + 1}: {error}', file=sys.stderr)
            found, half = None, numpy.nan
        yield 'modulus', f'cell {number + 1}', found.value if found else numpy.nan, half, true, 0, 'Pa', time.perf_counter() - begin


def identify_held(height, force, held, calibration_error):
    """`identify` knows glued cells, so it gets the force divided by what the family of held forces says of held over glued, which
    depends on the modulus: from the modulus of the force as it is, twice.
    @param height m, of the tip below a place near the surface, (n,). @param force N, (n,). @param held the Scene, of any modulus
    @param calibration_error of the force, relative, half of its interval of 95 %
    @returns the Identification of the outermost layer's modulus, whose interval holds the family's error, too"""
    keys = held.to_dict()
    mouth, radius = keys['holding_pipette']['mouth'], held.diameter / 2
    touch = radius * (mouth['inner_radius'] + mouth['edge_radius']) / (radius + mouth['edge_radius'])  # where a sphere meets the lip
    glued = Scene({**keys, 'holding_pipette': {'contact_radius': touch}})
    depths, ratio = radius * numpy.linspace(0.01, 0.4, 40), numpy.ones(40)
    for last in (False, False, True):
        record = {'time_s': numpy.arange(len(height)) * 1e-3, 'depth_um': 1e6 * height, 'force_nN': 1e9 * force / numpy.interp(height, depths, ratio)}
        curve = identify(record, glued, calibration_error=numpy.hypot(calibration_error, HELD_ERROR))
        if not last:
            cells = [Cell(scene.replace({'cell/material/young_modulus': curve['young_modulus'].value}), 'surrogate') for scene in (held, glued)]
            on_held, on_glued = (cell.force(cell.tips(depths))[:, 2] for cell in cells)
            ratio = on_held / on_glued
    return curve


def joined(count, noise, seed):
    """Of random cells that suction holds: the modulus from tongues, from a needle's force, and from both. The force is that of the
    held cell, solved, with the noise of a sensor."""
    random = numpy.random.default_rng(seed + 1000)
    for number in range(1, count + 1):
        begin = time.perf_counter()
        radius = random.uniform(30, 70)
        inner, edge, true = radius * random.uniform(0.25, 0.35), radius * random.uniform(0.05, 0.08), log_uniform(random, 8e3, 3e4)
        strongest = -true * random.uniform(0.05, 0.15)
        scene = held_scene(radius, inner, inner + 4 * edge, edge, 0.49, true, pressure=strongest / 2).replace({'needle/tip/radius': 1e-6 * radius * 0.1})
        pressures = strongest * numpy.linspace(1 / 6, 1, 6)
        told = scene.replace({'cell/material/young_modulus': 5e3})
        drawn, depths = aspirate(scene, pressures), 0.02e-6 * radius * numpy.arange(1, 13)
        solved = indent(scene, depths, tolerance=0.02)
        good = solved['converged']
        if good.sum() < 6 or not drawn['converged'].all():
            print(f'suction: cell {number}: no solution', file=sys.stderr)
            continue
        lengths = drawn['tongue_length'] + random.uniform(-2e-6, 2e-6) + random.normal(0, noise, 6)
        height = numpy.concatenate([numpy.linspace(-8e-6, 0, 800), numpy.linspace(0, depths[good][-1], 800)])
        # The force grows nearly as depth^(3/2), so its power of 2/3 is what lines join well.
        force = numpy.interp(height, numpy.concatenate([[-1, 0], depths[good]]), numpy.concatenate([[0, 0], solved['force'][good, 2]**(2 / 3)]))**1.5
        force += random.normal(0, 10e-9, len(height))
        gain = numpy.exp(random.normal(0, CALIBRATION))
        try:
            tongue = identify_tongue(pressures, lengths, told)
            curves = {'': identify_held(height, force, told, 0), ', calibrated to 5 %': identify_held(height, gain * force, told, 1.96 * CALIBRATION)}
        except ConfigError as error:
            print(f'suction: cell {number}: {error}', file=sys.stderr)
            continue
        found = {'tongues': tongue}
        for sensor, curve in curves.items():
            found[f'force{sensor}'], found[f'both{sensor}'] = curve, combine_moduli(curve, tongue)
        for name, modulus in ((name, each['young_modulus']) for name, each in found.items()):
            yield (f'modulus by {name}', f'cell {number}', modulus.value, (modulus.high - modulus.low) / 2, true, 0, 'Pa', time.perf_counter() - begin)


def breaks(count):
    """Random cells whose membrane the controller breaks by suction, told by each witness and by both."""
    for witnesses in ('both', 'force', 'image'):
        begin = time.perf_counter()
        trials = [_core.suction_trial(seed, witnesses=witnesses) for seed in range(count)]
        took = (time.perf_counter() - begin) / count
        broken = [trial for trial in trials if trial['broken_by_suction']]
        told = sum(trial['detected'] for trial in broken)
        false = sum(trial['detected'] and not trial['broken'] for trial in trials)
        latency = [1e3 * trial['latency_s'] for trial in broken if numpy.isfinite(trial['latency_s'])]
        print(f'suction: breaks told by {witnesses}: {told} of {len(broken)}; {false} of {count} cells taken for broken that are not; the suction '
              f'ends {statistics.median(latency):.3g} ms after the break (median), {numpy.quantile(latency, 0.99):.3g} (99 of 100), {max(latency):.3g} (worst)')
        for seed, trial in enumerate(trials):
            drawn = 1e15 * trial['drawn_too_much_m3'] if trial['broken_by_suction'] else numpy.nan
            yield f'drawn too much, told by {witnesses}', f'cell {seed}', drawn, numpy.nan, numpy.nan, numpy.nan, 'pL', took


def log_uniform(random, low, high):
    return float(numpy.exp(random.uniform(numpy.log(low), numpy.log(high))))


def unseen_scene(random, family):
    """@returns the Scene of a random cell of a family of tongues, or of held forces, as the borders in its file are"""
    zona, force = family == 'zona', family == 'force'
    radius = random.uniform(25, 80)
    bore = log_uniform(random, *((0.1, 0.45) if zona else (0.2, 0.4) if force else (0.02, 0.5)))
    edge = log_uniform(random, *((0.15, 0.5) if zona else (0.1, 0.4) if force else (0.1, 0.5)))
    wall = 3 if zona else log_uniform(random, 1.5 if force else 1, 6)
    poisson_ratio = 0.49 if zona or force else random.uniform(0.45, 0.499)
    suction = random.uniform(0, 0.55)**2 if force else 0.0
    scene = held_scene(radius, bore * radius, bore * radius * (1 + 2 * wall * edge), bore * edge * radius, poisson_ratio, pressure=-MODULUS * suction)
    if zona:
        material = {'model': 'neo_hookean', 'poisson_ratio': 0.49}
        shell = {'name': 'shell', 'outer_radius': 1e-6 * radius, 'material': {**material, 'young_modulus': MODULUS}}
        core = {'name': 'core', 'outer_radius': 1e-6 * radius * (1 - log_uniform(random, 0.08, 0.25)),
                'material': {**material, 'young_modulus': MODULUS * log_uniform(random, 0.05, 1)}}
        scene = Scene({**scene.to_dict(), 'cell': {'layers': [shell, core]}})
    # Away from a tongue; its radius is the length of the solution's steps.
    return scene.replace({'needle/tip/radius': 1e-6 * radius * (log_uniform(random, 0.05, 0.2) if force else 0.4)})


def distance_from(points, line):
    """@returns the largest distance of points from a polyline, (n, 2) both"""
    begin, along = line[:-1], numpy.diff(line, axis=0)
    offset = points[:, None] - begin
    share = numpy.clip((offset * along).sum(2) / (along**2).sum(1), 0, 1)
    return numpy.linalg.norm(offset - share[..., None] * along, axis=2).min(1).max()


def family_tongues(family, count, seed):
    random = numpy.random.default_rng(seed)
    for number in range(1, count + 1):
        begin = time.perf_counter()
        scene = unseen_scene(random, family)
        tongue = tongue_family(scene)
        pressures = tongue.strongest * numpy.array([0.02, 0.2, 0.5, 0.8, 0.98])
        told, solved = tongue.at(pressures), aspirate(scene, pressures, tolerance=0.02, finest=1)
        took = (time.perf_counter() - begin) / len(pressures)
        for i in numpy.flatnonzero(solved['converged']):
            case = f'{family} {number}, p/E = {-pressures[i] / MODULUS:.3g}'
            length, other = told['tongue_length'][i], solved['tongue_length'][i]
            yield (f'{family} tongues', case, 1e6 * length, 1e6 * length * told['expected_error'][i], 1e6 * other,
                   1e6 * other * solved['error_estimate'][i], 'um', took)
            yield (f'{family} surfaces', case, distance_from(tongue.outline(pressures[i]), solved['outline'][i]) / scene.diameter, numpy.nan, numpy.nan,
                   numpy.nan, 'diameters', took)
        lost = (~solved['converged']).sum()
        if lost > 0:
            print(f'suction: {family} {number}: two meshes do not have {lost} of {len(pressures)} tongues that the family serves', file=sys.stderr)
    many = numpy.linspace(tongue.strongest, 0, 100000)
    begin = time.perf_counter()
    tongue.at(many)
    print(f'suction: {family}: {1e6 * (time.perf_counter() - begin) / len(many):.2g} us for a tongue with its slopes')


def family_forces(count, seed):
    random = numpy.random.default_rng(seed)
    for number in range(1, count + 1):
        begin = time.perf_counter()
        scene = unseen_scene(random, 'force')
        depths = 0.5 * scene.diameter * numpy.array([0.1, 0.2, 0.4])
        cell = Cell(scene, 'surrogate')
        told, solved = cell.force(cell.tips(depths))[:, 2], indent(scene, depths, tolerance=0.02)
        took = (time.perf_counter() - begin) / len(depths)
        for i in numpy.flatnonzero(solved['converged']):
            force = solved['force'][i, 2]
            yield ('held forces', f'cell {number}, {1e6 * depths[i]:.3g} um', 1e6 * told[i], 1e6 * told[i] * cell.expected_error[1], 1e6 * force,
                   1e6 * force * solved['error_estimate'][i], 'uN', took)


def hard():
    """Cells at the limits of the model: each has a tongue, in the bore's radii, or a reason."""
    cell = held_scene(40, 8, 24, 2, 0.49)
    material = {'model': 'neo_hookean', 'poisson_ratio': 0.49}
    stiff = Scene({**cell.to_dict(), 'cell': {'layers': [
        {'name': 'zona', 'outer_radius': 40e-6, 'material': {**material, 'young_modulus': 40 * MODULUS}},
        {'name': 'inside', 'outer_radius': 34e-6, 'material': {**material, 'young_modulus': MODULUS}}]}})
    for name, scene, suctions in (('zona 40 times as stiff as the inside', stiff, (0.1, 1, 4)),
                                  ('tongue of three bore radii and more', cell, (0.2, 0.3, 0.4, 3)),
                                  ('bore of 0.8 radii of the cell', held_scene(40, 32, 60, 4, 0.49), (0.02, 0.1, 0.3))):
        begin = time.perf_counter()
        drawn = aspirate(scene, -MODULUS * numpy.array(suctions), tolerance=0.05, finest=2)
        took = (time.perf_counter() - begin) / len(suctions)
        bore = scene.to_dict()['holding_pipette']['mouth']['inner_radius']
        for i, suction in enumerate(suctions):
            length = drawn['tongue_length'][i] / bore if drawn['converged'][i] else numpy.nan
            if not drawn['converged'][i]:
                print(f'suction: hard: {name}, p/E = {suction:g}: {drawn["reason"][i]}')
            yield 'hard', f'{name}, p/E = {suction:g}', length, length * drawn['error_estimate'][i], numpy.nan, numpy.nan, 'bore radii', took


def families(count, seed):
    yield from family_tongues('homogeneous', count, seed)
    yield from family_forces(count, seed)
    yield from family_tongues('zona', count, seed)


def program(name, *options):
    """A benchmark of its own, which prints its own tables."""
    subprocess.run([PEER.parents[2] / 'dev', 'bench', name, *(['--', *options] if options else [])], check=True)
    return ()


def slip():
    program('slip')
    return program('slip', '--loads', 'turned', '--scenes', 'ACDF', '--friction', '0.1', '--beside', '0.6')


def summary(study, rows):
    """One line on the rows of a study."""
    if study.startswith('drawn'):
        volumes = [row[2] for row in rows if numpy.isfinite(row[2])]
        return f'{study}: {len(volumes)} breaks, {statistics.median(volumes):.2g} pL (median), {max(volumes):.2g} (worst)'
    if study.endswith('surfaces'):
        distances = [row[2] for row in rows]
        return f'{study}: {len(rows)} cases, apart by {statistics.median(distances):.2g} diameters (median), {max(distances):.2g} (worst)'
    own, error, other, other_error = (numpy.array([row[k] for row in rows], dtype=float) for k in (2, 3, 4, 5))
    good = numpy.isfinite(own) & numpy.isfinite(other)
    if not good.any():
        return f'{study}: {numpy.isfinite(own).sum()} of {len(rows)} cases solved; nothing to compare with'
    apart = numpy.abs(own / other - 1)[good]
    text = f'{study}: {good.sum()} of {len(rows)} cases, apart by {100 * statistics.median(apart):.2g} % (median), {100 * apart.max():.2g} % (worst)'
    within = numpy.abs(own - other)[good] <= (error + other_error)[good]
    return text + f'; within both errors in {within.sum()}'


def parse_arguments():
    studies = 'half-space,second solver,needle,modulus,joined,breaks,families,hard,slip,motion'
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of suction.csv')
    parser.add_argument('--studies', default=studies, help='default %(default)s')
    parser.add_argument('--cells', type=int, default=30, help='whose modulus is found, and of each family (default %(default)s)')
    parser.add_argument('--trials', type=int, default=400, help='cells whose membrane suction breaks (default %(default)s)')
    parser.add_argument('--noise', type=float, default=0.1e-6, help='m, of a tongue in an image (default %(default)s)')
    parser.add_argument('--seed', type=int, default=1, help='of these cells (default %(default)s)')
    arguments = parser.parse_args()
    arguments.studies = arguments.studies.split(',')
    unknown = set(arguments.studies) - set(studies.split(','))
    if unknown:
        parser.error(f'--studies: no study {", ".join(sorted(unknown))}; there are: {studies}')
    return arguments


def main():
    arguments = parse_arguments()
    studies = {'half-space': half_space, 'second solver': second_solver, 'needle': needle,
               'modulus': lambda: modulus(arguments.cells, arguments.noise, arguments.seed),
               'joined': lambda: joined(arguments.cells, arguments.noise, arguments.seed),
               'breaks': lambda: breaks(arguments.trials),
               'families': lambda: families(arguments.cells, arguments.seed),
               'hard': hard, 'slip': slip, 'motion': lambda: program('cell_motion')}
    lines = []
    with (arguments.out / 'suction.csv').open('w', encoding='utf-8', newline='') as file:
        table = csv.writer(file)
        table.writerow(LINES)
        for study in arguments.studies:
            rows = {}
            for row in studies[study]():
                rows.setdefault(row[0], []).append(row)
                table.writerow([row[0], row[1], *(f'{value:.6g}' for value in row[2:6]), row[6], f'{row[7]:.3g}'])
                file.flush()
                print(f'{row[0]}: {row[1]}: {row[2]:.5g} +- {row[3]:.2g} {row[6]}, other {row[4]:.5g} +- {row[5]:.2g}', flush=True)
            lines += [summary(*each) for each in rows.items()]
    print('\n'.join(lines))


if __name__ == '__main__':
    main()
