"""The report of ./dev paper: its sections, and what they say when their programs left nothing, or something."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / 'benchmark' / 'paper'))

import dynamics  # noqa: E402
import force_depth  # noqa: E402
import identified  # noqa: E402
import prestretch  # noqa: E402
import report  # noqa: E402
import table_3  # noqa: E402
import tensegrity  # noqa: E402
import withdrawal  # noqa: E402
from common import DIFFERENCE, NOT_REPRODUCIBLE, REPRODUCED, VERDICTS  # noqa: E402

MESHES = '''paper_vertices,paper_tetrahedra,vertices,tetrahedra,tip_vertices,linear_force_1um_N,''' \
    '''tensors_off_line_us,tensors_on_line_us,kernel_off_line_us,kernel_on_line_us,kernel_off_line_least_us,''' \
    '''kernel_on_line_least_us
123,379,126,373,1,1.9e-7,400,40,100,4,100,4
1093,4819,1053,4882,14,1.2e-7,4000,400,1000,40,900,30
123,379,130,357,11,2.9e-7,400,40,100,4,100,4
'''

TENSEGRITY = {'strut_vertices': 1002, 'strut_tetrahedra': 1764, 'residual_N': 1e-18, 'prestress_N': 2e-7,
              'step_s': 7e-10, 'single_filament_step_s': 1e-11, 'force_median_s': 1e-6, 'force_99_s': 4e-6,
              'solution_median_s': 0.1, 'invalid_share': 0}


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

    def test_the_measured_puncture_has_a_modulus_with_an_interval(self):
        def write(name, value):
            (self.data / f'{name}.csv').write_text(
                'model,quantity,value,low,high,unit,bounded\n'
                f'solution,young_modulus,{value},{0.95 * value},{1.05 * value},Pa,1\n', encoding='utf-8')

        write('identified', 17.5e3)
        write('identified_tip_4', 15e3)
        row, = identified.items(self.data, self.out)
        self.assertEqual((row['ours'], row['verdict']), ('17.5 [16.6, 18.4]', REPRODUCED))
        self.assertIn('from 15.0 to 17.5', row['why'])
        write('identified', 15e3)
        self.assertEqual(identified.items(self.data, self.out)[0]['verdict'], DIFFERENCE)

    def test_the_scenes_of_the_puncture_differ_in_one_length(self):
        root = Path(__file__).resolve().parent.parent
        own = identified.scene_of('identified', root, self.data).read_text(encoding='utf-8').splitlines()
        for name in identified.VARIANTS:
            lines = identified.scene_of(name, root, self.data).read_text(encoding='utf-8').splitlines()
            self.assertEqual(sum(a != b for a, b in zip(own, lines)), 0 if name == 'identified' else 1, name)

    def test_table_3_compares_times_and_sizes(self):
        (self.data / 'meshes.csv').write_text(MESHES, encoding='utf-8')
        rows = {(row['item'], row['quantity']): row for row in table_3.items(self.data, self.out)}
        last = rows['Table III, 1093/4819', 'on-line time']
        self.assertEqual((last['paper'], last['ours'], last['verdict']), ('0.703', '0.0400', REPRODUCED))
        self.assertIn('17.6 times quicker', last['why'])
        errors = {key[1].split('ours of ')[1][:7]: row for key, row in rows.items() if key[0] == 'Section V.B'}
        self.assertEqual({mesh: (row['ours'], row['verdict']) for mesh, row in errors.items()},
                         {'126/373': ('+63', NOT_REPRODUCIBLE), '130/357': ('+148', NOT_REPRODUCIBLE)})
        self.assertAlmostEqual(table_3.exponent([1, 2, 4], [3, 6, 12]), 1)
        self.assertTrue((table_3.section(self.data, self.out), (self.out / 'figure_14.png').is_file())[1])

    def test_table_3_says_when_times_are_not_linear(self):
        rows = [{'tetrahedra': n, 'kernel_off_line_us': n, 'kernel_on_line_us': n} for n in (300, 1000, 5000)]
        for power, verdict in ((1, REPRODUCED), (1.16, DIFFERENCE), (1.4, DIFFERENCE)):
            changed = [dict(row, kernel_on_line_us=row['tetrahedra']**power) for row in rows]
            on_line = table_3.growth_items(changed)[1]
            self.assertEqual((on_line['ours'], on_line['verdict']), (f'{power:.2f}', verdict))

    def test_both_times_have_to_be_linear(self):
        for place, stage in enumerate(('off_line', 'on_line')):
            for power, verdict in ((0.9, REPRODUCED), (1.1, REPRODUCED), (1.2, DIFFERENCE), (0.8, DIFFERENCE)):
                rows = [{'paper_tetrahedra': 0, 'tetrahedra': n, 'kernel_off_line_least_us': n,
                         'kernel_on_line_least_us': n} for n in (300, 1000, 5000)]
                for row in rows:
                    row[f'kernel_{stage}_least_us'] = row['tetrahedra']**power
                found = [REPRODUCED, REPRODUCED]
                found[place] = verdict
                self.assertEqual([row['verdict'] for row in table_3.aim_items(rows)], found)

    def test_ten_times_quicker_is_judged_by_the_least_time(self):
        times = {'paper_tetrahedra': 4819, 'kernel_off_line_us': 9e3, 'kernel_off_line_least_us': 8.87e3,
                 'kernel_on_line_us': 78, 'kernel_on_line_least_us': 70}
        for least, verdicts in ((70, [REPRODUCED, REPRODUCED]), (71, [REPRODUCED, DIFFERENCE])):
            rows = table_3.aim_items([dict(times, kernel_on_line_least_us=least)])
            self.assertEqual([row['verdict'] for row in rows], verdicts)
        self.assertIn('by the median 9.0', rows[1]['why'])
        slow = table_3.aim_items([dict(times, kernel_off_line_least_us=8.88e3)])
        self.assertEqual([row['verdict'] for row in slow], [DIFFERENCE, REPRODUCED])

    def verdicts_of_tensegrity(self, **changed):
        rows = ''.join(f'{key},{value}\n' for key, value in dict(TENSEGRITY, **changed).items())
        (self.data / 'tensegrity_numbers.csv').write_text('quantity,value\n' + rows, encoding='utf-8')
        return [row['verdict'] for row in tensegrity.items_of_mesh(self.data)]

    def test_verdicts_on_the_tensegrity_cell_follow_the_numbers(self):
        good = [REPRODUCED, REPRODUCED, DIFFERENCE, REPRODUCED]  # mesh, balance, explicit step, force update
        self.assertEqual(self.verdicts_of_tensegrity(), good)
        for place, changed in ((0, {'strut_vertices': 900}), (1, {'residual_N': 1e-15}), (3, {'force_99_s': 2e-3}),
                               (3, {'invalid_share': 0.1})):
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

    def write_indent(self, name, rows):
        lines = [f'{depth}e-6,{force}e-6,1,{error}' for depth, force, error in rows]
        (self.data / f'{name}.csv').write_text('\n'.join(['depth_m,force_z_N,converged,error_estimate'] + lines),
                                               encoding='utf-8')

    def test_the_linear_law_is_held_against_each_other_one(self):
        self.write_indent('linear_disc', [(1, 1, 0)])
        self.write_indent('disc', [(1, 1, 0), (2, 2 / 1.04, 0), (3, 3 / 1.06, 0)])
        self.write_indent('st_venant_kirchhoff', [(0.1, 0.1, 0), (0.3, 0.3 / 1.1, 0), (0.5, 0.4, 0.03)])
        rows = [row for row in force_depth.linear_items(self.data) if 'above' in row['quantity']]
        self.assertEqual([(row['ours'], row['verdict']) for row in rows],
                         [('at 0.2 um, 0.4 % of the diameter', DIFFERENCE),
                          ('at 2.5 um, 4.5 % of the diameter', DIFFERENCE)])

    def test_forces_worse_than_the_bound_are_shown_but_not_used(self):
        self.write_indent('st_venant_kirchhoff', [(0.5, 0.05, 0.005), (1, 0.09, 0.03)])
        self.assertIn('none to 2 % beyond 0.5 um', force_depth.nonlinear_items(self.data)[0]['ours'])
        text = force_depth.section(self.data, self.out)
        self.assertIn('(0.09 +- 3.0 %)', text)
        self.assertIn('St-Venant-Kirchhoff, disc 3.0 % (at 1 um)', text)

    def write_way(self, name, loss, pull):
        """A way in and out, the way out `loss` uN below the way in, and a pull in uN at the last point but one."""
        ways = [(depth, 0.1 * depth) for depth in withdrawal.IN] + [(depth, 0.1 * depth - loss if depth > 0 else 0)
                                                                   for depth in withdrawal.OUT]
        ways[-2] = (ways[-2][0], -pull)
        self.write_indent(f'withdrawal_{name}', [(depth, force, 0) for depth, force in ways])

    def test_an_effect_is_held_against_the_same_contact_without_it(self):
        for _, name, without in withdrawal.EFFECTS:
            mode, other = (withdrawal.RUNS[run][1].split(',')[0] for run in (name, without))
            self.assertEqual(mode, other, name)
        self.write_way('smooth', 0, 0)
        self.write_way('sticking', 0, 0.002)
        self.write_way('viscous', 0.01, 0.003)
        viscosity = withdrawal.items(self.data, self.out)[2]
        self.assertIn('sticking (friction without bound)', viscosity['why'])
        self.assertIn(' 2 nN', viscosity['why'])
        self.assertEqual(viscosity['verdict'], DIFFERENCE)
        self.write_way('viscous', 0, 0.002)
        self.assertEqual(withdrawal.items(self.data, self.out)[2]['verdict'], NOT_REPRODUCIBLE)

    def test_the_price_of_the_mass_is_read_between_the_scalings_that_were_run(self):
        errors = {1: 0.01, 1e2: 0.1, 1e4: 0.4}
        for scale, text in ((1e2, '10 %'), (1e3, '20 %'), (0.5, '1 %'), (1e5, 'more than 40 %')):
            self.assertEqual(dynamics.price(errors, scale), text)
        theirs, ours = dynamics.slowness([{'tetrahedra': 373, 'exact_step_s': 0.5e-6, 'step_cost_s': 5e-6}])
        self.assertAlmostEqual(ours[0], 10)
        self.assertAlmostEqual(theirs[0], 94)
        self.assertEqual(dynamics.span([155, 10816]), '160 to 11000')

    def test_stretching_tells_each_depth_and_the_range_of_the_forces(self):
        header = 'material,stretch,tetrahedra,force_1um_N,depth_reached_m\n'
        (self.data / 'prestretch.csv').write_text(header + '\n'.join(
            f'st_venant_kirchhoff,{stretch},976,{force}e-7,{depth}e-6'
            for stretch, force, depth in ((1, 2, 5), (1.5, 1.8, 8), (3, 2.3, 4))), encoding='utf-8')
        row = prestretch.items(self.data, self.out)[0]
        self.assertIn('stretch 1, 1.5, 3 reaches 5.00, 8.00, 4.00 um (976', row['ours'])
        self.assertIn('-10 % to +15 %', row['why'])
        self.assertEqual(row['verdict'], DIFFERENCE)

    def test_the_microtubule_is_held_against_the_printed_diameter(self):
        for radius, verdict in ((12.9, DIFFERENCE), (2.5, REPRODUCED)):
            (self.data / 'tensegrity_members.csv').write_text(
                'kind,young_modulus_Pa,bending_stiffness_Nm2,filament_radius_m,filament_euler_N\n'
                f'microtubule,1.2e9,2.6e-23,{radius}e-9,1e-13', encoding='utf-8')
            row = tensegrity.items_of_table(self.data)[0]
            self.assertEqual((row['paper'], row['verdict']), ('D = 5', verdict))
            self.assertIn('706 times', row['why'])

    def test_strain_hardening_needs_curves_that_get_steeper(self):
        for forces, verdict in (((0, 1, 3), REPRODUCED), ((0, 2, 3), DIFFERENCE)):
            rows = [f'figure_12,end,{prestrain},{depth}e-6,{force}e-9,{depth}' for prestrain, curve in
                    ((0, (0, 1, 3)), (0.2, forces)) for depth, force in zip((0, 5, 10), curve)]
            (self.data / 'tensegrity_curves.csv').write_text(
                '\n'.join(['curve,where,prestrain,depth_m,force_z_N,slack'] + rows), encoding='utf-8')
            row = tensegrity.items_of_hardening(self.data)[0]
            self.assertEqual((row['ours'], row['verdict']),
                             ('2 (0 %), 2 (20 %)' if verdict == REPRODUCED else '2 (0 %), 0.5 (20 %)', verdict))
            self.assertIn('10 (0 %), 10 (20 %) of 36', row['why'])

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
