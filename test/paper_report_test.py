"""The report of ./dev paper: its sections, and what they say when their programs left nothing, or something."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / 'src' / 'paper'))

import report  # noqa: E402
import table_3  # noqa: E402
from common import NOT_REPRODUCIBLE, REPRODUCED, VERDICTS  # noqa: E402

MESHES = '''paper_vertices,paper_tetrahedra,vertices,tetrahedra,tip_vertices,linear_force_1um_N,''' \
    '''tensors_off_line_us,tensors_on_line_us,kernel_off_line_us,kernel_on_line_us
123,379,126,373,1,1.2e-7,400,40,100,4
1093,4819,1053,4882,14,1.2e-7,4000,400,1000,40
123,379,130,357,11,2.9e-7,400,40,100,4
'''


class ReportTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = Path(self.folder.name)
        self.data = self.out / 'data'
        self.data.mkdir()

    def tearDown(self):
        self.folder.cleanup()

    def test_without_data_nothing_is_reproduced_but_what_needs_none(self):
        for name, module in report.load_sections().items():
            for row in module.items(self.data, self.out):
                with self.subTest(section=name, quantity=row['quantity']):
                    self.assertIn(row['verdict'], VERDICTS)
                    self.assertTrue(set(report.COLUMNS) <= set(row))
                    if row['ours'] == 'none':
                        self.assertEqual(row['verdict'], NOT_REPRODUCIBLE)
                        self.assertIn('left no result', row['why'])
            self.assertTrue(module.section(self.data, self.out).startswith('## '), name)

    def test_table_3_compares_times_and_sizes(self):
        (self.data / 'meshes.csv').write_text(MESHES, encoding='utf-8')
        rows = {(row['item'], row['quantity']): row for row in table_3.items(self.data, self.out)}
        last = rows['Table III, 1093/4819', 'on-line time']
        self.assertEqual((last['paper'], last['ours'], last['verdict']), ('0.703', '0.0400', REPRODUCED))
        self.assertIn('17.6 times quicker', last['why'])
        error = next(row for key, row in rows.items() if key[0] == 'Section V.B')
        self.assertEqual((error['ours'], error['verdict']), ('+148', NOT_REPRODUCIBLE))
        self.assertAlmostEqual(table_3.exponent([1, 2, 4], [3, 6, 12]), 1)
        self.assertTrue((table_3.section(self.data, self.out), (self.out / 'figure_14.png').is_file())[1])

    def test_a_verdict_that_is_none_is_refused(self):
        with self.assertRaisesRegex(ValueError, 'verdict = perfect'):
            report.write_summary([{'item': 'x', 'verdict': 'perfect'}], self.out / 'summary.csv')

    def test_a_program_that_hangs_or_fails_ends_nothing_else(self):
        tasks = [('slow', ['sleep', '600'], 1), ('bad', ['false'], 60), ('good', ['true'], 60)]
        ended = report.run_all(tasks, self.data, 2)
        self.assertRegex(ended['slow'], 'stopped after its 1 s')
        self.assertRegex(ended['bad'], 'ended with status 1')
        self.assertRegex(ended['good'], 'done')


if __name__ == '__main__':
    unittest.main()
