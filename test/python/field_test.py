"""./dev bench field with a stranger's entry: it is scored beside ours, and what is no entry is refused; programs that enter."""
import contextlib
import csv
import io
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIELD = ROOT / 'benchmark/field.py'
sys.path[:0] = [str(ROOT / 'benchmark'), str(ROOT / 'benchmark/peers'), str(ROOT / 'test')]

import field  # noqa: E402
import numpy  # noqa: E402
import peer_entries  # noqa: E402
from in_folder import InFolder  # noqa: E402
from peer_cases import CaseWriter  # noqa: E402
from peers_test import PEER, WRITER  # noqa: E402

from cell_microinjection import Scene  # noqa: E402

LITTLE = ('--cells', '2', '--injections', '2', '--images', '3', '--network', '0', '--without', 'live,shell,bullet', '--seed', '3')
MINE = '''
import numpy


def force(scene, depths):
    """Twice Hertz on a half space."""
    material, tip = scene['cell']['material'], scene['needle']['tip']['radius']
    return 8 / 3 * material['young_modulus'] / (1 - material['poisson_ratio'] ** 2) * numpy.sqrt(tip) * depths ** 1.5


def policy(observation):
    return 0, 0, -20e-6 if observation[0] < 1 else 100e-6, 0


def cell(image, scale):
    """The middle, for a cell of 60 um."""
    return image.shape[1] / 2, image.shape[0] / 2, 60e-6 / scale
'''


class TheField(unittest.TestCase):
    def run_field(self, entry, text):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name) / entry
        path.write_text(text, encoding='utf-8')
        done = subprocess.run([sys.executable, '-B', FIELD, '--out', folder.name, '--entry', path, '--programs', folder.name, *LITTLE],
                              capture_output=True, text=True, check=False)
        table = Path(folder.name) / 'field.csv'
        rows = list(csv.DictReader(table.read_text(encoding='utf-8').splitlines())) if table.exists() else []
        return done, {(row['task'], row['entry']): row for row in rows}

    def test_scores_whoever_enters(self):
        done, rows = self.run_field('mine.py', MINE)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLess(float(rows['force', 'family']['median']), 1)
        self.assertGreater(float(rows['force', 'mine']['median']), 20)
        self.assertEqual(rows['force', 'mine']['failed'], '0')
        self.assertLess(float(rows['modulus', 'family']['median']), float(rows['modulus', 'hertz']['median']))
        self.assertEqual(rows['injection, score', 'mine']['failed'], '2')
        self.assertGreater(float(rows['injection, score', 'proportional']['median']), 50)
        self.assertLess(float(rows['cell, px', 'eyes']['worst']), 3)
        self.assertGreater(float(rows['cell, px', 'mine']['median']), 10)
        self.assertEqual(rows['diameter, px', 'mine']['failed'], '0')
        self.assertIn(('tip, px', 'eyes'), rows)
        self.assertNotIn(('tip, px', 'mine'), rows)
        self.assertIn('seed 3', done.stdout)
        self.assertIn('calculix is left out: ', done.stderr)
        self.assertNotIn('bullet', done.stderr)
        self.assertNotIn(('force', 'calculix'), rows)

    def test_refuses_what_is_no_entry(self):
        for name, text, part in (('mine.py', 'x = 1', 'none of the functions force, modulus, policy, tip, cell'),
                                 ('mine.txt', MINE, 'is no Python file'), ('mine.py', 'def force(:', 'invalid syntax')):
            with self.subTest(part=part):
                done, rows = self.run_field(name, text)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(part, done.stderr)
                self.assertEqual(rows, {})


class AProgram(InFolder):
    """The one of the peers' tests: 0.1 N/m, in each step."""
    SCENE = Scene.load('mouse_oocyte').replace({'cell/diameter': 112e-6})
    DEPTHS = numpy.array([1e-6, 3e-6, 4e-6])

    def entry(self, mode, mesh='section', steps=1):
        writer = self.write('write_case.py', f'#!{sys.executable}\n{WRITER}')
        writer.chmod(0o755)
        return peer_entries.Peer(f'{sys.executable} {self.write("peer.py", PEER)} {mode}', CaseWriter(writer, self.folder / mode, None, {}),
                                 30, mesh, 0, {'cell/material/poisson_ratio': 0.3}, steps, None)

    def motion(self, folder):
        """Depths, m, that the program was told for the newest cell."""
        case, = (self.folder / folder).glob('*.case')
        return [-float(line.split()[2]) for line in case.read_text(encoding='utf-8').splitlines() if line.startswith('0 0 -')]

    def test_gives_the_force_of_each_depth(self):
        for steps in (1, 2):
            with self.subTest(steps=steps):
                entry = self.entry(f'right{steps}', steps=steps)
                numpy.testing.assert_allclose(entry.force(self.SCENE.to_dict(), self.DEPTHS), 0.1 * self.DEPTHS, rtol=1e-9)
                self.assertEqual(len(entry.times), 3)
        numpy.testing.assert_allclose(self.motion('right2'), [0.5e-6, 1e-6, 2e-6, 3e-6, 3.5e-6, 4e-6])
        scene = Scene.load(self.folder / 'right2' / '1.yaml').to_dict()
        self.assertEqual((scene['cell']['diameter'], scene['cell']['material']['poisson_ratio']), (112e-6, 0.3))

    def test_has_a_cell_of_the_papers_size_on_its_meshes(self):
        """Half as deep in a cell half as large: forces go with the square of the size."""
        force = self.entry('right', mesh=peer_entries.PAPER).force(self.SCENE.to_dict(), self.DEPTHS)
        numpy.testing.assert_allclose(force, 4 * 0.1 * self.DEPTHS / 2, rtol=1e-9)
        numpy.testing.assert_allclose(self.motion('right'), self.DEPTHS / 2)

    def test_that_declines_is_left_out_and_one_that_fails_has_no_force(self):
        with self.assertRaisesRegex(peer_entries.Declined, 'declined: only springs'):
            field.asked(self.entry('declines').force, self.SCENE.to_dict(), self.DEPTHS, count=3)
        with contextlib.redirect_stderr(io.StringIO()) as told:
            forces, _ = field.asked(self.entry('fails').force, self.SCENE.to_dict(), self.DEPTHS, count=3)
        self.assertTrue(numpy.isnan(forces).all())
        self.assertIn('no licence', told.getvalue())

    def test_is_asked_at_as_many_cells_as_it_is_quick_enough_for(self):
        entry = self.entry('right')
        entry.cells = 1
        row = dict(zip(field.LINES, field.score_force('mine', entry, 2 * [(self.SCENE.to_dict(), self.DEPTHS, 0.2 * self.DEPTHS)], 1)))
        self.assertEqual((row['cases'], row['median'], row['us a force']), (3, '50', '0'))


if __name__ == '__main__':
    unittest.main()
