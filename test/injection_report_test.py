"""injection_report.py makes a page of a notebook of injections, and says what is wrong with a file that is none."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[1] / 'src/tools/injection_report.py'
SOURCE = TOOL.parents[2] / 'src/operation/record/injection_notebook.cpp'
HEADER = ('time,cell,diameter_m,modulus_Pa,modulus_low_Pa,modulus_high_Pa,verdict,expected_depth_m,expected_depth_low_m,'
          'expected_depth_high_m,expected_force_N,expected_force_low_N,expected_force_high_N,puncture_depth_m,'
          'puncture_force_N,peak_force_N,deepest_m,punctures,volume_m3,outcome,reason')
ROWS = ('2026-11-25T10:00:00,mouse,5.6e-05,17900,17000,18800,converged,1.4e-05,1e-05,1.8e-05,1.5e-06,1.1e-06,2.1e-06,'
        '1.5e-05,1.6e-06,1.6e-06,1.8e-05,1,4.8e-15,injected,',
        '2026-11-26T10:05:00,<b>,,,,,,,,,,,,,,6e-07,8e-06,0,0,preempted,"the operator, stopped it"')


class ReportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.notebook = Path(folder.name) / 'notebook.csv'
        self.notebook.write_text('\n'.join((HEADER, *ROWS)) + '\n', encoding='utf-8')

    def report(self, *arguments):
        return subprocess.run([sys.executable, TOOL, self.notebook, *arguments], capture_output=True, text=True, check=False)

    def test_its_columns_are_those_that_a_session_writes(self):
        written = ''.join(SOURCE.read_text().split('kNotebookHeader =')[1].split(';')[0].replace('"', '').split())
        self.assertEqual(written, HEADER + r'\n')

    def test_a_page_with_every_row_and_what_was_met(self):
        done = self.report()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('2 cells: 1 injected, 1 preempted', done.stdout)
        self.assertIn('6.2 % off (median), 1 of 1 in the 95 % interval', done.stdout)
        page = self.notebook.with_suffix('.html').read_text(encoding='utf-8')
        self.assertEqual(page.count('<tr>'), 3)
        self.assertEqual(page.count('data:image/png'), 2)
        self.assertIn('the operator, stopped it', page)
        self.assertNotIn('<b>', page)

    def test_one_day(self):
        out = self.notebook.with_name('day.html')
        self.assertEqual(self.report('--day', '2026-11-26', '--out', str(out)).returncode, 0)
        page = out.read_text(encoding='utf-8')
        self.assertEqual((page.count('<tr>'), page.count('data:image/png')), (2, 0))

    def test_says_what_is_wrong(self):
        done = self.report('--day', '2025-01-01')
        self.assertEqual(done.returncode, 2)
        self.assertIn('no rows of 2025-01-01; there are: 2026-11-25, 2026-11-26', done.stderr)
        self.notebook.write_text('a,b\n1,2\n', encoding='utf-8')
        done = self.report()
        self.assertEqual(done.returncode, 2)
        self.assertIn('is not a notebook of injections: it has no column time', done.stderr)
        self.notebook.unlink()
        self.assertEqual(self.report().returncode, 2)


if __name__ == '__main__':
    unittest.main()
