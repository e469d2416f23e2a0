"""The examples of the page From Python: each runs, and says what it should."""
import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HAS_ROS = importlib.util.find_spec('cell_microinjection._session') is not None
EXAMPLES = Path(__file__).resolve().parents[2] / 'src/python/examples'


def run(name, *arguments, folder=None):
    done = subprocess.run([sys.executable, '-B', str(EXAMPLES / f'{name}.py'), *arguments], capture_output=True, text=True,
                          cwd=folder, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


class TheExamples(unittest.TestCase):
    def test_force_curve(self):
        with tempfile.TemporaryDirectory() as folder:
            said = run('force_curve', 'curve.png', folder=folder)
            self.assertGreater(os.path.getsize(Path(folder) / 'curve.png'), 5000)
        soft, stiff = (float(force) for force in re.findall(r'([\d.]+) uN', said))
        self.assertAlmostEqual(stiff, 2 * soft, delta=0.01)

    def test_family_map(self):
        rows = run('family_map').splitlines()
        self.assertEqual(len(rows), 13)
        self.assertGreater(sum('%' in row for row in rows), 6)

    def test_identify_a_curve(self):
        value, low, high = (float(number) for number in
                            re.search(r'modulus ([\d.]+) kPa, 95 %: ([\d.]+) to ([\d.]+)', run('identify_a_curve')).groups())
        self.assertTrue(low < 11 < high and abs(value - 11) < 0.3, (value, low, high))

    @unittest.skipUnless(HAS_ROS, 'needs ROS')
    def test_own_controller(self):
        force, wished = re.search(r'(\d+) nN of (\d+), indent', run('own_controller')).groups()
        self.assertAlmostEqual(int(force), int(wished), delta=25)

    @unittest.skipUnless(HAS_ROS, 'needs ROS')
    def test_detect_a_tip(self):
        said = run('detect_a_tip')
        self.assertRegex(said, r'tip: (found|uncertain) [\d.]+ [\d.]+ px')
        self.assertRegex(said, 'cell: (found|uncertain)')

    def test_are_short(self):
        for path in EXAMPLES.glob('*.py'):
            self.assertLess(len(path.read_text(encoding='utf-8').splitlines()), 45, path.name)


if __name__ == '__main__':
    unittest.main()
