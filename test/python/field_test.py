"""./dev bench field with a stranger's entry: it is scored beside ours, and what is no entry is refused."""
import csv
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FIELD = Path(__file__).resolve().parents[2] / 'benchmark/field.py'
LITTLE = ('--cells', '2', '--injections', '2', '--network', '0', '--without', 'live,shell', '--seed', '3')
MINE = '''
import numpy


def force(scene, depths):
    """Twice Hertz on a half space."""
    material, tip = scene['cell']['material'], scene['needle']['tip']['radius']
    return 8 / 3 * material['young_modulus'] / (1 - material['poisson_ratio'] ** 2) * numpy.sqrt(tip) * depths ** 1.5


def policy(observation):
    return 0, 0, -20e-6 if observation[0] < 1 else 100e-6, 0
'''


class TheField(unittest.TestCase):
    def run_field(self, entry, text):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name) / entry
        path.write_text(text, encoding='utf-8')
        done = subprocess.run([sys.executable, '-B', FIELD, '--out', folder.name, '--entry', path, *LITTLE],
                              capture_output=True, text=True, check=False)
        table = Path(folder.name) / 'field.csv'
        rows = list(csv.DictReader(table.open(encoding='utf-8'))) if table.exists() else []
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
        self.assertIn('seed 3', done.stdout)

    def test_refuses_what_is_no_entry(self):
        for name, text, part in (('mine.py', 'x = 1', 'none of the functions force, modulus and policy'),
                                 ('mine.txt', MINE, 'is no Python file'), ('mine.py', 'def force(:', 'invalid syntax')):
            with self.subTest(part=part):
                done, rows = self.run_field(name, text)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(part, done.stderr)
                self.assertEqual(rows, {})


if __name__ == '__main__':
    unittest.main()
