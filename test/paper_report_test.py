"""The report of ./dev paper: its sections, and what they say when their programs left nothing, or something."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / 'src' / 'paper'))

import force_depth  # noqa: E402
import report  # noqa: E402
import table_3  # noqa: E402
import tensegrity  # noqa: E402
from common import DIFFERENCE, NOT_REPRODUCIBLE, REPRODUCED, VERDICTS  # noqa: E402

MESHES = '''paper_vertices,paper_tetrahedra,vertices,tetrahedra,tip_vertices,linear_force_1um_N,''' \
    '''tensors_off_line_us,tensors_on_line_us,kernel_off_line_us,kernel_on_line_us
123,379,126,373,1,1.2e-7,400,40,100,4
1093,4819,1053,4882,14,1.2e-7,4000,400,1000,40
123,379,130,357,11,2.9e-7,400,40,100,4
'''

TENSEGRITY = {'strut_vertices': 1002, 'strut_tetrahedra': 1764, 'residual_N': 1e-18, 'prestress_N': 2e-7,
              'step_s': 7e-10, 'single_filament_step_s': 1e-11, 'force_median_s': 1e-6, 'force_99_s': 4e-6,
              'solution_median_s': 0.1, 'untrusted_share': 0}


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

    def test_table_3_says_when_times_are_not_linear(self):
        rows = [{'tetrahedra': n, 'kernel_off_line_us': n, 'kernel_on_line_us': n} for n in (300, 1000, 5000)]
        for power, verdict in ((1, REPRODUCED), (1.4, DIFFERENCE)):
            changed = [dict(row, kernel_on_line_us=row['tetrahedra']**power) for row in rows]
            on_line = table_3.growth_items(changed)[1]
            self.assertEqual((on_line['ours'], on_line['verdict']), (f'{power:.2f}', verdict))

    def verdicts_of_tensegrity(self, **changed):
        rows = ''.join(f'{key},{value}\n' for key, value in dict(TENSEGRITY, **changed).items())
        (self.data / 'tensegrity_numbers.csv').write_text('quantity,value\n' + rows, encoding='utf-8')
        return [row['verdict'] for row in tensegrity.items_of_mesh(self.data)]

    def test_verdicts_on_the_tensegrity_cell_follow_the_numbers(self):
        good = [REPRODUCED, REPRODUCED, DIFFERENCE, REPRODUCED]  # mesh, balance, explicit step, force update
        self.assertEqual(self.verdicts_of_tensegrity(), good)
        for place, changed in ((0, {'strut_vertices': 900}), (1, {'residual_N': 1e-15}), (3, {'force_99_s': 2e-3}),
                               (3, {'untrusted_share': 0.1})):
            with self.subTest(changed):
                self.assertEqual(self.verdicts_of_tensegrity(**changed),
                                 good[:place] + [DIFFERENCE] + good[place + 1:])

    def test_stiffening_has_to_be_less_beside_the_struts(self):
        for between, verdict in ((1, DIFFERENCE), (1.5, REPRODUCED), (9, DIFFERENCE)):
            rows = [f'figure_12,{where},{prestrain},{depth}e-6,{force * depth}e-9' for where, ratio in
                    (('end', 4), ('between', between)) for prestrain, force in ((0, 1), (0.2, ratio))
                    for depth in (1, 5)]
            (self.data / 'tensegrity_curves.csv').write_text(
                '\n'.join(['curve,where,prestrain,depth_m,force_z_N'] + rows), encoding='utf-8')
            self.assertEqual([row['verdict'] for row in tensegrity.items_of_prestress(self.data)],
                             [REPRODUCED, verdict])

    def test_st_venant_kirchhoff_is_judged_by_what_it_reaches(self):
        for rows, verdict in (('1e-6,1.1e-7,1\n45e-6,nan,0', NOT_REPRODUCIBLE), ('45e-6,7.6e-6,1', REPRODUCED),
                              ('45e-6,6e-6,1', DIFFERENCE)):
            (self.data / 'st_venant_kirchhoff.csv').write_text('depth_m,force_z_N,converged\n' + rows, encoding='utf-8')
            self.assertEqual(force_depth.nonlinear_items(self.data)[0]['verdict'], verdict)

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
