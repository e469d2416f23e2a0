"""Tests of the demo's tools below src/tools: pictures, plots, the summary and the taking down of child processes."""
import os
import sys
import unittest
from pathlib import Path
from types import SimpleNamespace

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'src' / 'tools'))
sys.path.insert(0, str(Path(__file__).resolve().parent))

import matplotlib.image  # noqa: E402
import numpy  # noqa: E402

import demo_summary  # noqa: E402
import plot_force_depth  # noqa: E402
import plot_training  # noqa: E402
import processes  # noqa: E402
import screenshot  # noqa: E402
import session_monitor  # noqa: E402
from in_folder import InFolder  # noqa: E402

HEADER = ('time_s,phase,depth_m,predicted_axial_N,measured_axial_N,measured_lateral_N,hand_force_N,in_contact,'
          'punctured\n')


class TrainingPlotTest(InFolder):
    COLUMNS = [column for column, *_ in plot_training.MEASURES + plot_training.SHARES]

    def history(self, *operators):
        rows = [','.join(['trainee', 'session', 'outcome', 'score'] + self.COLUMNS)]
        rows += [','.join([name, str(number), 'aborted' if number % 3 == 2 else 'complete', '50'] +
                          ['1'] * len(self.COLUMNS)) for number, name in enumerate(operators)]
        return self.write('history.csv', '\n'.join(rows) + '\n')

    def test_sessions_are_those_of_one_operator(self):
        path = self.history('ada', 'bob', 'ada')
        name, rows = plot_training.read(path)
        self.assertEqual((name, [row['session'] for row in rows]), ('ada', ['0', '2']))
        self.assertEqual(plot_training.read(path, 'bob')[0], 'bob')
        with self.assertRaisesRegex(ValueError, 'there are: ada, bob'):
            plot_training.read(path, 'eve')
        with self.assertRaisesRegex(ValueError, 'no sessions'):
            plot_training.read(self.history())

    def test_draws_one_session_and_many(self):
        for operators in (['ada'], ['bob', 'bob', 'ada'], ['ada'] * 40):
            picture = self.folder / 'picture.png'
            plot_training.plot(self.history(*operators), picture)
            self.assertGreater(matplotlib.image.imread(picture).std(), 0.05)


class PaceRecordTest(unittest.TestCase):
    @staticmethod
    def array(**levels):
        """A DiagnosticArray of the statuses `NODE: cycle`, and one of another name."""
        statuses = [SimpleNamespace(name=f'{node}: cycle', level=level) for node, level in levels.items()]
        return SimpleNamespace(status=[*statuses, SimpleNamespace(name='microscope: images', level=2)])

    def test_a_node_is_slow_by_most_of_its_reports(self):
        pace = session_monitor.PaceRecord()
        self.assertEqual((pace.reports(), pace.slow()), (0, []))
        for a, b in ((0, 1), (1, 1), (0, 0)):
            pace.add(self.array(a=a, b=b))
        pace.add(self.array(a=0))
        self.assertEqual((pace.reports(), pace.slow()), (3, ['b']))

    def test_only_what_came_since_the_beginning_counts(self):
        pace = session_monitor.PaceRecord()
        pace.add(self.array(a=1))
        pace.begin()
        pace.add(self.array(b=0))
        self.assertEqual((pace.reports(), pace.slow()), (0, []), 'one that was there is silent')
        pace.add(self.array(a=0))
        self.assertEqual((pace.reports(), pace.slow()), (1, []))


class ScreenshotTest(InFolder):
    def picture(self, cell_size):
        """Returns a dark picture with a blue square of `cell_size` pixels among 100 x 100."""
        pixels = numpy.full((100, 100, 3), (24, 27, 34), numpy.uint8)
        pixels[:cell_size, :cell_size] = (58, 100, 150)
        path = self.folder / 'picture.png'
        matplotlib.image.imsave(path, pixels)
        return path

    def test_a_coloured_cell_is_seen(self):
        self.assertTrue(screenshot.shows_cell(self.picture(30)))
        self.assertAlmostEqual(screenshot.coloured_share(self.picture(30)), 0.09)

    def test_an_empty_view_is_not_taken_for_one(self):
        self.assertFalse(screenshot.shows_cell(self.picture(0)))
        self.assertFalse(screenshot.shows_cell(self.picture(5)))

    def test_without_a_picture_the_file_stays_as_it_was(self):
        path = self.folder / 'scene.png'
        environment = {**os.environ, 'DISPLAY': ':no-such-display'}
        self.assertFalse(screenshot.take_scene(path, env=environment, timeout=0))
        self.assertEqual(list(self.folder.iterdir()), [])


class PlotTest(InFolder):
    def test_empty_fields_are_not_numbers(self):
        path = self.write('f.csv', HEADER + '0,approach,,0,,,,0,0\n0.005,indent,1e-6,2e-6,2.1e-6,0,0.4,1,0\n')
        table = plot_force_depth.read(path)
        self.assertTrue(numpy.isnan(table['depth_m'][0]))
        self.assertEqual(table['depth_m'][1], 1e-6)
        self.assertEqual(list(table['phase']), ['approach', 'indent'])

    def test_a_session_without_contact_can_be_plotted(self):
        path = self.write('f.csv', HEADER + '0,,,,,,,0,0\n0.005,,,0,0,0,,0,0\n')
        plot_force_depth.plot(path, self.folder / 'f.png')
        self.assertGreater((self.folder / 'f.png').stat().st_size, 0)

    def injected(self):
        """A session that goes in, through two membranes at 1 and 2 s, injects at 2.5 s and comes out from 3 s on. The
        cell tells of a puncture 15 ms late."""
        rows = []
        for i in range(800):
            time = 0.005 * i
            layers = int(time >= 1.015) + int(time >= 2.015)
            force = time if time <= 1 else 0.2 + 0.4 * (time - 1) if time <= 2 else 0.3
            state = 'indent' if time < 1 else 'inject' if 2.5 <= time < 2.8 else 'punctured'
            volume = 7e-15 + 1e-14 * min(max(time - 2.5, 0), 0.3)
            rows.append(f'{time},{"retract" if time >= 3 else "indent"},{5e-6 * min(time, 3)},{force * 1e-6},'
                        f'{force * 1e-6},0,0.1,1,{int(layers > 0)},{layers},{state},{volume}')
        return self.write('f.csv', HEADER.strip() + ',layers_punctured,injection_state,injected_volume_m3\n' +
                          '\n'.join(rows) + '\n')

    def test_what_happened_is_found_where_it_happened(self):
        table = plot_force_depth.read(self.injected())
        found = [(table['time_s'][row], text) for row, text in plot_force_depth.events(table, ['zona'])]
        self.assertEqual([text for _, text in found], ['contact', 'zona punctured', 'membrane 2 punctured',
                                                       'injection: 3 pL', 'withdrawal'])
        numpy.testing.assert_allclose([time for time, _ in found], [0, 1, 2, 2.5, 3], atol=1e-9)
        plot_force_depth.plot(self.folder / 'f.csv', self.folder / 'f.png', ['zona'])
        self.assertGreater(matplotlib.image.imread(self.folder / 'f.png').std(), 0.05)

    def test_a_file_without_rows_is_an_error(self):
        with self.assertRaisesRegex(ValueError, 'no rows'):
            plot_force_depth.plot(self.write('f.csv', HEADER), self.folder / 'f.png')

    def test_thinning_keeps_few_points_and_the_first(self):
        rows = plot_force_depth.thinned(numpy.arange(100000) >= 7)
        self.assertLessEqual(rows.size, plot_force_depth.MOST_POINTS)
        self.assertGreater(rows.size, plot_force_depth.MOST_POINTS // 2)
        self.assertEqual(rows[0], 7)


class SummaryTest(InFolder):
    def test_it_knows_the_membranes(self):
        self.assertEqual(demo_summary.layers(self.write('s.yaml', 'layers: [zona, oolemma]\n')), ['zona', 'oolemma'])
        self.assertEqual(demo_summary.layers(self.write('s.yaml', 'layers: []\n')), [])
        self.assertEqual(demo_summary.layers(self.folder / 'nowhere.yaml'), [])

    NODES = ('nodes:\n  - {node: cell_simulator, topic: /cell/predicted_cf, count: 1234, rate_hz: 999.8,'
             ' interval_median_ms: 1.0, interval_p99_ms: 1.5}\n')

    def test_training_says_points_or_why_there_are_none(self):
        told = ('trainee: "ada"\noutcome: complete\nreason: ""\nscore: 87.4\nmeasures:\n'
                '  peak_force_N: {value: 1.5e-6, reference: 1e-06, points: 25, of: 25}\n')
        text = demo_summary.training(self.write('t.yaml', told))
        self.assertIn('Training of ada: 87 of 100 points', text)
        self.assertIn('1.5e-06', text)
        told = told.replace('complete', 'aborted').replace('reason: ""', 'reason: "it ended in indent"')
        self.assertIn('aborted: it ended in indent', demo_summary.training(self.write('t.yaml', told)))

    def test_live_it_has_latency_beside_the_bare_loop(self):
        text = demo_summary.text(self.write('s.yaml', (
            'clock: wall\nduration_s: 12.5\n' + self.NODES +
            'hand_to_force_latency: {count: 10, median_ms: 2.5, p99_ms: 7}\n'
            'bare_timer_loop: {count: 11, median_ms: 1, p99_ms: 3, max_ms: 40}\n')))
        for wanted in ('cell_simulator', '1234', '999.800', 'median 2.500 ms', 'max 40 ms', 'wall time'):
            self.assertIn(wanted, text)

    def test_in_virtual_time_it_has_none(self):
        text = demo_summary.text(self.write('s.yaml', 'clock: virtual\nduration_s: 12.5\n' + self.NODES))
        self.assertIn('virtual time', text)
        self.assertNotIn('hand to force', text)


class ProcessesTest(InFolder):
    def test_a_deaf_child_is_stopped_with_its_grandchild(self):
        log = self.folder / 'log'
        # Both are deaf to polite signals; the grandchild has a session of its own, as the nodes of roslaunch have.
        script = 'trap "" INT TERM; setsid sh -c \'trap "" INT TERM; echo $$; while :; do sleep 1; done\' & wait; wait'
        child = processes.Child(['sh', '-c', script], log)
        self.assertTrue(processes.wait_until(lambda: log.read_text().endswith('\n'), 60))
        grandchild = int(log.read_text())
        child.stop(0.1, force_after=0.1)
        self.assertFalse(child.running())
        self.assertTrue(processes.wait_until(lambda: processes.gone(grandchild), 60))

    def test_stopping_what_has_ended_is_nothing(self):
        child = processes.Child(['true'], self.folder / 'log')
        self.assertTrue(processes.wait_until(lambda: not child.running(), 60))
        child.stop(0)

    def test_its_output_is_kept(self):
        child = processes.Child(['sh', '-c', 'echo one; echo two >&2'], self.folder / 'log')
        self.assertTrue(processes.wait_until(lambda: not child.running(), 60))
        self.assertEqual(child.tail(1), 'two')


if __name__ == '__main__':
    unittest.main()
