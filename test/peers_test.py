"""./dev bench peers: the text of cases and results, the table's arithmetic, and a program that joins, however it ends."""
import argparse
import csv
import math
import os
import stat
import sys
import textwrap
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'benchmark'))
sys.path.insert(0, str(ROOT / 'benchmark' / 'peers'))
sys.path.insert(0, str(ROOT / 'test'))

import peer_cases  # noqa: E402
import peer_format  # noqa: E402
import peer_process  # noqa: E402
import peer_programs  # noqa: E402
import peer_table  # noqa: E402
import peers  # noqa: E402
from in_folder import InFolder  # noqa: E402
from peer_case import CASE  # noqa: E402

# What --peer starts: reads the case, and answers with 0.1 N/m times the depth, or not.
PEER = '''
import os, sys, time
mode, case, result = sys.argv[1:]
steps = []
lines = open(case).read().split('\\n')
at = next(k for k, line in enumerate(lines) if line.startswith('motion'))
for line in lines[at + 1:at + 1 + int(lines[at].split()[1])]:
    steps.append(-float(line.split()[2]))
if mode == 'hangs':
    time.sleep(60)
if mode == 'crashes':
    os.abort()
if mode == 'fails':
    sys.exit('no licence')
if mode == 'silent':
    sys.exit()
forces = [f'0 0 {"nan" if mode == "not_finite" and k else 0.1 * d} {100 if mode == "slow" else 0}' for k, d in enumerate(steps)]
if mode == 'short':
    forces.pop()
if mode == 'words':
    forces[-1] = '0 0 much 0'
text = ['peer_result 1', 'program Fake 2.1', 'model spring', 'element none', 'law same']
text += ['declined only springs'] if mode == 'declines' else [f'steps {len(steps)}', *forces]
open(result, 'w').write('\\n'.join(text + ([] if mode == 'cut' else ['end', ''])))
'''

# Stands for peer_write_case, with one node.
WRITER = '''
import sys
options = dict(word.lstrip('-').split('=') if '=' in word else (word.lstrip('-'), after)
               for word, after in zip(sys.argv[1:], sys.argv[2:] + ['']) if word.startswith('--'))
depths = options['depths'].split(',')
open(options['out'], 'w').write('nodes 1 1\\nelements 0\\nmotion %d\\n' % len(depths)
                                + ''.join('0 0 -%s\\n' % depth for depth in depths) + 'end\\n')
'''


class InAFolder(InFolder):
    def command(self, mode):
        return f'{sys.executable} {self.write("peer.py", PEER)} {mode}'


class TheFormat(InAFolder):
    def test_of_a_case(self):
        case = peer_format.read_case(self.write('case', CASE))
        self.assertEqual(case.layers, [('linear', 17900.0, 0.45)])
        self.assertEqual(case.nodes[3], [0, 0, 1e-6])
        self.assertEqual(case.elements, [(0, [0, 1, 2, 3])])
        self.assertEqual((case.held, case.glued, case.surface), ([0], [3], [[0, 2, 1]]))
        self.assertEqual(case.motion[1], [0, 0, -2e-7])

    def test_of_a_broken_case(self):
        for piece, other in (('peer_case 1', 'peer_case 9'), ('0 0 1 2 3', '0 0 1 2'), ('held 1', 'held x'), ('end', '')):
            with self.subTest(other), self.assertRaises(peer_format.FormatError):
                peer_format.read_case(self.write('case', CASE.replace(piece, other)))

    def test_of_a_result_is_read_as_written(self):
        result = peer_format.Result('Peer 1.2', 'equilibrium, fast', 'p1', 'same', '', [(0, 0, 1 / 3e7), (0, 0, math.nan)],
                                    [0.001, 0.002])
        found = peer_format.read_result(peer_format.result_text(result), 2)
        self.assertEqual((found.program, found.model, found.times), (result.program, result.model, result.times))
        self.assertEqual(found.forces[0], result.forces[0])
        self.assertTrue(math.isnan(found.forces[1][2]))

    def test_of_a_result_that_declines(self):
        text = peer_format.result_text(peer_format.Result('P', 'm', 'e', declined='no contact'))
        self.assertEqual(peer_format.read_result(text, 5).declined, 'no contact')


class TheTable(InAFolder):
    def test_quantiles(self):
        self.assertEqual(peer_table.quantile([3, 1, 2], 0.5), 2)
        self.assertAlmostEqual(peer_table.quantile([0, 10], 0.1), 1)
        self.assertTrue(math.isnan(peer_table.quantile([], 0.5)))

    def test_errors(self):
        self.assertAlmostEqual(peer_table.relative_error(1.2, 1), 0.2)
        self.assertAlmostEqual(peer_table.mesh_error([1.3, 1.1, 1.05]), 0.2)  # the larger of two changes
        self.assertAlmostEqual(peer_table.mesh_error([9, 1.1, 1.11, 1.0]), 0.11)
        self.assertTrue(math.isnan(peer_table.mesh_error([1.1, 1.0])))
        self.assertTrue(math.isnan(peer_table.mesh_error([1.1, math.nan, 1.0])))

    def test_agreement(self):
        self.assertTrue(peer_table.agree(1, 0.02, 1.04, 0.03))
        self.assertFalse(peer_table.agree(1, 0.02, 1.06, 0.03))
        self.assertFalse(peer_table.agree(1, math.nan, 1, 0.03))

    def test_largest_step(self):
        self.assertEqual(peer_table.largest_step({0.25: 1, 0.5: 1.04, 1: 1.06, 2: math.nan}), 0.5)
        self.assertTrue(math.isnan(peer_table.largest_step({0.25: math.nan, 0.5: 1})))

    def test_largest_depth(self):
        self.assertEqual(peer_table.largest_depth([1, 2, 3, 4], [1, 2, 1.7, math.nan]), 3)
        self.assertEqual(peer_table.largest_depth([1, 2, 3, 4], [1, 2, 1.5, 3]), 2)
        self.assertEqual(peer_table.largest_depth([1], [math.nan]), 0)

    def test_is_written(self):
        path = self.folder / 'peers.csv'
        peer_table.write([{'program': 'Fake', 'force_N': 1e-7, 'agrees': True, 'verdict': 'done'}], path)
        with path.open(encoding='utf-8') as file:
            row, = csv.DictReader(file)
        self.assertEqual((row['force_N'], row['agrees'], row['depth_um'], row['verdict']), ('1e-07', 'yes', '', 'done'))
        self.assertEqual(list(row)[:8], ['program', 'model', 'element', 'vertices', 'tetrahedra', 'time_ms_median', 'force_N',
                                         'force_error'])


class AProgram(InAFolder):
    def verdict(self, mode, time_limit=30):
        return peer_process.run(self.command(mode), self.write('case', CASE), 2, time_limit)

    def test_that_answers(self):
        outcome = self.verdict('right')
        self.assertEqual(outcome.verdict, peer_process.DONE)
        self.assertEqual(outcome.result.forces, [(0, 0, 0.1 * 1e-7), (0, 0, 0.1 * 2e-7)])

    def test_that_finds_no_solution(self):
        outcome = self.verdict('not_finite')
        self.assertEqual(outcome.verdict, peer_process.DONE)
        self.assertTrue(math.isnan(outcome.result.forces[1][2]))

    def test_that_does_not(self):
        for mode, verdict in (('declines', 'declined: only springs'), ('crashes', 'crashed: SIGABRT'),
                              ('fails', 'failed: exit status 1: no licence'), ('silent', 'no result')):
            with self.subTest(mode):
                self.assertEqual(self.verdict(mode).verdict, verdict)
        for mode in ('short', 'words', 'cut', 'slow'):
            with self.subTest(mode):
                self.assertTrue(self.verdict(mode).verdict.startswith(peer_process.WRONG), self.verdict(mode).verdict)

    def test_that_hangs_is_ended(self):
        self.assertEqual(self.verdict('hangs', 0.2).verdict, 'out of time: 0.2 s')

    def test_that_is_not_there(self):
        self.assertTrue(peer_process.run('/no/such/program', 'case', 2, 1).verdict.startswith('not started'))

    def test_joins_by_name_and_command(self):
        program = peer_programs.joined('Mine=./solve --fast=1')
        self.assertEqual((program.name, program.command), ('Mine', './solve --fast=1'))
        path = self.write('solve', '')
        relative = os.path.relpath(path)
        self.assertEqual(peer_programs.joined(f'Mine={relative} 1').command, f'{path.resolve()} 1')
        for text in ('Mine', '=./solve', 'Mine='):
            with self.subTest(text), self.assertRaises(ValueError):
                peer_programs.joined(text)


class Impatient(peers.Bench):
    """Waits for the program that hangs less long than for the others, which may be slow to start."""

    def run(self, program, case, steps):
        self.arguments.time_limit = 0.2 if program.name == 'hangs' else 60
        return super().run(program, case, steps)


class TheBench(InAFolder):
    SCENES = {'scenes': {'spring': {'cell': 'spring', 'depths': [1, 2], 'levels': [0, 1, 2]}},
              'equal': [{'scene': 'spring', 'mesh': 'paper', 'levels': [0], 'depth': 2}],
              'stability': {'scene': 'spring', 'mesh': 'paper', 'level': 0, 'depth': 2, 'steps': [1, 2], 'deepest': 3,
                            'step': 1}}

    def rows(self, *modes, reference='right'):
        """The rows of a first program, which is the reference, and of some others."""
        (self.folder / 'cells').mkdir()
        self.write('cells/spring.yaml', 'cell: {}')
        writer = self.write('write_case', f'#!{sys.executable}\n' + textwrap.dedent(WRITER))
        writer.chmod(writer.stat().st_mode | stat.S_IXUSR)
        studies = (peer_programs.CONVERGED, peer_programs.EQUAL, peer_programs.STABILITY)
        programs = [peer_programs.Program(mode, self.command(mode), studies) for mode in (reference, *modes)]
        arguments = argparse.Namespace(out=self.folder, programs=self.folder, quick=False, core=None,
                                       studies=studies)
        bench = Impatient(arguments, self.SCENES, programs)
        bench.cases = peer_cases.CaseWriter(writer, self.folder / 'peers', self.folder / 'cells', self.SCENES['scenes'])
        bench.run_all()
        return bench.rows

    def test_reports_every_program(self):
        rows = self.rows('crashes', 'not_finite', 'hangs', 'right')
        for study in ('converged', 'equal', 'stability'):
            verdicts = [(row['program'], row['verdict']) for row in rows if row['study'] == study]
            with self.subTest(study):
                self.assertIn(('crashes', 'crashed: SIGABRT'), verdicts)
                self.assertIn(('hangs', 'out of time: 0.2 s'), verdicts)
                self.assertEqual(verdicts[-1], ('Fake 2.1', 'done'))  # the last one is not spoilt by those before
        agreeing = [row for row in rows if row['study'] == 'converged' and row.get('agrees')]
        self.assertEqual({row['depth_um'] for row in agreeing}, {1, 2})
        self.assertAlmostEqual(agreeing[0]['force_N'], 0.1e-6)
        equal = [row for row in rows if row['study'] == 'equal' and row['program'] == 'Fake 2.1']
        self.assertEqual([row['verdict'] for row in equal], ['done', 'no solution from 0.2 um', 'done'])
        self.assertEqual(equal[-1]['force_error'], 0)
        stable = [row for row in rows if row['study'] == 'stability' and row['program'] == 'Fake 2.1']
        self.assertEqual((stable[-1]['largest_step_um'], stable[-1]['largest_depth_um']), (2, 3))
        self.assertEqual(stable[1]['largest_depth_um'], 1)

    def test_compares_with_our_force_only(self):
        rows = [row for row in self.rows('right', reference='crashes') if row['study'] == 'converged']
        self.assertEqual([row['verdict'] for row in rows], ['crashed: SIGABRT', 'done', 'done'])
        self.assertTrue(all(math.isnan(row['force_error']) and 'agrees' not in row for row in rows[1:]))

    def test_says_what_is_missing(self):
        missing = peer_programs.programs(self.folder)
        self.assertIn('libbullet-dev', {program.missing for program in missing if program.name.startswith('Bullet')})
        self.assertTrue(all(not program.missing for program in missing if program.name.startswith('ours')))


class TheScenes(unittest.TestCase):
    def test_are_cells_of_the_repository_whose_keys_there_are(self):
        import yaml
        study = yaml.safe_load((ROOT / 'benchmark' / 'peers' / 'scenes.yaml').read_text(encoding='utf-8'))
        self.assertGreaterEqual(len(study['scenes']), 6)
        for name, scene in study['scenes'].items():
            with self.subTest(name):
                tree = yaml.safe_load((ROOT / 'config' / 'cells' / f'{scene["cell"]}.yaml').read_text(encoding='utf-8'))
                peer_cases.changed(tree, scene.get('set', {}))
                self.assertEqual(len(scene['levels']), 3)
        for equal in study['equal']:
            self.assertIn(equal['depth'], study['scenes'][equal['scene']]['depths'])

    def test_are_chosen_by_name(self):
        study = {'scenes': {'a': 1, 'b': 2}, 'equal': [{'scene': 'a'}, {'scene': 'b'}], 'stability': {'scene': 'a'}}
        self.assertEqual(peers.choose(study, ['b']), {'scenes': {'b': 2}, 'equal': [{'scene': 'b'}], 'stability': None})
        self.assertEqual(peers.choose(study, ['a'])['stability'], {'scene': 'a'})
        with self.assertRaises(ValueError):
            peers.choose(study, ['c'])

    def test_change_a_key_that_there_is(self):
        self.assertEqual(peer_cases.changed({'a': {'b': 1}}, {'a.b': 2}), {'a': {'b': 2}})
        with self.assertRaises(KeyError):
            peer_cases.changed({'a': {'b': 1}}, {'a.c': 2})


if __name__ == '__main__':
    unittest.main()
