#!/usr/bin/python3
"""This project's models and other programs on equal meshes and scenes: force, error, time of a step, stability.

Bullet, CalculiX and GetFEM are optional: ./dev setup --peers installs them. Any other program joins by --peer.
"""
import argparse
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'benchmark' / 'peers'))

import peer_process  # noqa: E402
import peer_programs  # noqa: E402
import peer_table  # noqa: E402
from peer_cases import CaseWriter, read_counts  # noqa: E402
from peer_programs import CONVERGED, EQUAL, STABILITY  # noqa: E402

STEPS, WARM_UP = 20, 5  # of a case of equal meshes, and those of them whose time is left out


class Bench:
    """Runs the studies and keeps the rows of the table."""

    def __init__(self, arguments, scenes, programs):
        self.arguments, self.scenes, self.programs = arguments, scenes, programs
        self.cases = CaseWriter(arguments.programs / 'peer_write_case', arguments.out / 'peers', ROOT / 'config' / 'cells',
                                scenes['scenes'])
        self.rows = []
        self.converged = {}  # (scene, depth) -> (N, N), force and its error

    def add(self, **row):
        self.rows.append(row)
        print(peer_table.line(row), flush=True)

    def run(self, program, case, steps):
        if program.missing:
            return peer_process.Outcome(f'not installed: {program.missing}')
        return peer_process.run(program.command, case, steps, self.arguments.time_limit, self.arguments.core)

    def of(self, study):
        return [program for program in self.programs if study in program.studies]

    def solve_converged(self, name):
        """The forces of a scene on finer and finer meshes of its section, with errors of their own."""
        scene = self.scenes['scenes'][name]
        levels = scene['levels'] if not self.arguments.quick else [level - 1 for level in scene['levels']]
        paths = [self.cases.write(name, 'section', level, scene['depths']) for level in levels]
        for program in self.of(CONVERGED):
            outcomes = []
            for path in paths:
                outcomes.append(self.run(program, path, len(scene['depths'])))
                if outcomes[-1].verdict != peer_process.DONE:
                    break
            common = {'study': CONVERGED, 'scene': name, 'mesh': f'section {levels[-1]}', **read_counts(paths[-1])}
            if outcomes[-1].verdict != peer_process.DONE:
                self.add(program=program.name, **common, verdict=outcomes[-1].verdict)
                continue
            effects = self.law_effects(outcomes[-1].result.law, paths[-1], scene['depths'])
            for k, depth in enumerate(scene['depths']):
                self.add_converged(program, common, [outcome.result for outcome in outcomes], k, depth, effects[k])

    def law_effects(self, law, path, depths):
        """Returns by how much the force of another law is larger, at each depth; 0 for the case's own.

        With the element of the peer, quadratic without pressure: mixed elements approximate the pressure, whose part in
        the energy differs from law to law.
        """
        getfem = [program for program in self.programs if program.name == 'GetFEM p2' and not program.missing]
        if law == 'same':
            return [0.0] * len(depths)
        found = []
        for command in (getfem[0].command, peer_programs.law_command(law)) if getfem else ():
            outcome = peer_process.run(command, path, len(depths), self.arguments.time_limit, self.arguments.core)
            found.append([force[2] for force in outcome.result.forces] if outcome.result else [math.nan] * len(depths))
        return [other / own - 1 for own, other in zip(*found)] if found else [math.nan] * len(depths)

    def add_converged(self, program, common, results, k, depth, effect):
        forces = [result.forces[k][2] for result in results]
        error = peer_table.mesh_error(forces)
        row = {'program': results[-1].program, 'model': results[-1].model, 'element': results[-1].element, **common,
               'depth_um': depth, 'steps': len(results[-1].forces), 'force_N': forces[-1], 'law': results[-1].law,
               'error_estimate': abs(error / forces[-1]), 'law_effect': effect, 'verdict': peer_process.DONE}
        if not math.isfinite(forces[-1]):
            self.add(**{**row, 'verdict': 'no solution'})
            return
        own = program is self.of(CONVERGED)[0]
        if own:
            self.converged[common['scene'], depth] = (forces[-1], error)
        reference, reference_error = self.converged.get((common['scene'], depth), (math.nan, math.nan))
        row.update(converged_N=reference, converged_error=abs(reference_error / reference))
        # Forces of two energies are not compared: without the effect of the law nothing is said of them.
        if not own and math.isfinite(effect):
            same_law = forces[-1] / (1 + effect)
            row['force_error'] = peer_table.relative_error(same_law, reference)
            if math.isfinite(error) and math.isfinite(reference_error):
                row['agrees'] = peer_table.agree(same_law, error, reference, reference_error)
        self.add(**row)

    def reference(self, scene, depth):
        """Returns our converged force and its error in N."""
        if (scene, depth) not in self.converged:
            program = self.of(CONVERGED)[0]
            levels = self.scenes['scenes'][scene]['levels']
            forces = []
            for level in levels:
                outcome = self.run(program, self.cases.write(scene, 'section', level, [depth]), 1)
                forces.append(outcome.result.forces[0][2] if outcome.result else math.nan)
            self.converged[scene, depth] = (forces[-1], peer_table.mesh_error(forces))
        return self.converged[scene, depth]

    def solve_equal(self, equal):
        """Time and error of a step of every program on the same meshes."""
        depths = [equal['depth'] * (k + 1) / STEPS for k in range(STEPS)]
        levels = equal['levels'][:1] if self.arguments.quick else equal['levels']
        for level in levels:
            path = self.cases.write(equal['scene'], equal['mesh'], level, depths)
            for program in self.of(EQUAL):
                self.prepare(program, equal['scene'], path)
                outcome = self.run(program, path, STEPS)
                common = {'study': EQUAL, 'scene': equal['scene'], 'mesh': f'{equal["mesh"]} {level}', **read_counts(path)}
                if outcome.verdict.startswith(peer_process.DECLINED):
                    continue
                if outcome.verdict != peer_process.DONE:
                    self.add(program=program.name, **common, verdict=outcome.verdict)
                else:
                    self.add_equal(outcome, common, depths)

    def prepare(self, program, scene, path):
        """What a program needs once for a rounded tip, on all processors and without a limit: it takes minutes."""
        if program.preparation and program.preparation[0].exists() and 'glued 0\n' in path.read_text(encoding='utf-8'):
            subprocess.run([*program.preparation, self.cases.scene_file(scene)], check=False)

    def add_equal(self, outcome, common, depths):
        result = outcome.result
        times = [1e3 * time for time in result.times[WARM_UP:]]
        force, (converged, error) = result.forces[-1][2], self.reference(common['scene'], depths[-1])
        lost = next((depth for depth, found in zip(depths, result.forces) if not all(map(math.isfinite, found))), None)
        self.add(program=result.program, model=result.model, element=result.element, **common,
                 time_ms_median=peer_table.quantile(times, 0.5), time_ms_low=peer_table.quantile(times, 0.1),
                 time_ms_high=peer_table.quantile(times, 0.9), depth_um=depths[-1], steps=len(depths), force_N=force,
                 force_error=peer_table.relative_error(force, converged), converged_N=converged,
                 converged_error=abs(error / converged), law=result.law, process_s=outcome.process_time,
                 verdict=peer_process.DONE if lost is None else f'no solution from {lost:g} um')

    def solve_stability(self):
        """The largest step that keeps the force, and the depth to which there is one."""
        study = self.scenes['stability']
        deep = [study['step'] * (k + 1) for k in range(round(study['deepest'] / study['step']))]
        paths = {step: self.cases.write(study['scene'], study['mesh'], study['level'],
                                        [step * (k + 1) for k in range(round(study['depth'] / step))])
                 for step in study['steps']}
        deep_path = self.cases.write(study['scene'], study['mesh'], study['level'], deep)
        for program in self.of(STABILITY):
            outcomes = {step: self.run(program, path, round(study['depth'] / step)) for step, path in paths.items()}
            outcome = self.run(program, deep_path, len(deep))
            common = {'study': STABILITY, 'scene': study['scene'], 'mesh': f'{study["mesh"]} {study["level"]}',
                      **read_counts(deep_path)}
            if outcome.verdict != peer_process.DONE:
                self.add(program=program.name, **common, verdict=outcome.verdict)
                continue
            forces = {step: found.result.forces[-1][2] if found.result else math.nan for step, found in outcomes.items()}
            self.add(program=outcome.result.program, model=outcome.result.model, element=outcome.result.element, **common,
                     largest_step_um=peer_table.largest_step(forces), law=outcome.result.law,
                     largest_depth_um=peer_table.largest_depth(deep, [force[2] for force in outcome.result.forces]),
                     verdict=peer_process.DONE)

    def run_all(self):
        for name in self.scenes['scenes'] if CONVERGED in self.arguments.studies else ():
            self.solve_converged(name)
        for equal in self.scenes['equal'] if EQUAL in self.arguments.studies else ():
            self.solve_equal(equal)
        if STABILITY in self.arguments.studies and self.scenes['stability']:
            self.solve_stability()


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, required=True, help='folder of peers.csv and, in peers, of the cases')
    parser.add_argument('--peer', action='append', default=[], metavar='NAME=COMMAND',
                        help='another program, called with a case and a result behind COMMAND; repeatable')
    parser.add_argument('--studies', default=f'{CONVERGED},{EQUAL},{STABILITY}', help='default %(default)s')
    parser.add_argument('--scenes', help='only these scenes of benchmark/peers/scenes.yaml, separated by commas')
    parser.add_argument('--without', default='', help='names of programs to leave out, separated by commas; the reference, ours p2_p0, stays')
    parser.add_argument('--time-limit', type=float, default=600, help='s, for a program on one case (default %(default)s)')
    parser.add_argument('--quick', action='store_true', help='coarser meshes of the section, one equal mesh of each kind')
    parser.add_argument('--core', type=int, default=max(os.sched_getaffinity(0)),
                        help='the processor that all programs run on (default: the last)')
    parser.add_argument('--programs', type=Path, default=ROOT / 'catkin_ws' / 'devel' / 'lib' / 'cell_microinjection',
                        help='folder of the built programs')
    return parser.parse_args()


def choose(scenes, names):
    """Returns the studies of some scenes only. Raises ValueError for a name that there is not."""
    unknown = set(names) - set(scenes['scenes'])
    if unknown:
        raise ValueError(f'no scene {", ".join(sorted(unknown))}; there are: {", ".join(scenes["scenes"])}')
    return {**scenes, 'scenes': {name: scenes['scenes'][name] for name in scenes['scenes'] if name in names},
            'equal': [equal for equal in scenes['equal'] if equal['scene'] in names],
            'stability': scenes['stability'] if scenes['stability']['scene'] in names else None}


def main():
    arguments = parse_arguments()
    arguments.studies = arguments.studies.split(',')
    arguments.out, arguments.programs = arguments.out.resolve(), arguments.programs.resolve()
    scenes = yaml.safe_load((ROOT / 'benchmark' / 'peers' / 'scenes.yaml').read_text(encoding='utf-8'))
    try:
        programs = peer_programs.programs(arguments.programs) + [peer_programs.joined(peer) for peer in arguments.peer]
        if arguments.scenes:
            scenes = choose(scenes, arguments.scenes.split(','))
    except ValueError as error:
        print(f'peers: {error}', file=sys.stderr)
        return 2
    # The first program's converged forces are what all others are compared with.
    programs = programs[:1] + [program for program in programs[1:] if program.name not in arguments.without.split(',')]
    if not (arguments.programs / 'peer_write_case').exists():
        print(f'peers: {arguments.programs} has no peer_write_case: build the workspace first', file=sys.stderr)
        return 2
    missing = sorted({program.missing for program in programs if program.missing})
    if missing:
        print(f'Not installed: {", ".join(missing)}. ./dev setup --peers installs them.', flush=True)
    shutil.rmtree(arguments.out / 'peers', ignore_errors=True)
    bench = Bench(arguments, scenes, programs)
    try:
        bench.run_all()
    finally:
        peer_table.write(bench.rows, arguments.out / 'peers.csv')
    return 0


if __name__ == '__main__':
    sys.exit(main())
