"""The module for Python without ROS: a cell and its forces, records, images, trials."""
import os
import pickle
import subprocess
import sys
import tempfile
import threading
import unittest
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy

import cell_microinjection as cm
from cell_microinjection import _core, gym

CACHE = tempfile.TemporaryDirectory()  # what this user has prepared serves no test
os.environ['XDG_CACHE_HOME'] = CACHE.name
CELLS = Path(__file__).resolve().parents[2] / 'config/cells'
SCENE = cm.Scene.load(CELLS / 'mouse_oocyte_injection.yaml')


def force_of(arguments):
    scene, tips = arguments
    return cm.Cell(scene).force(tips)


def first_observation(seed):
    env = gym.Inject()
    observation, _ = env.reset(seed=seed)
    return observation


class ASceneTest(unittest.TestCase):
    def test_is_that_of_its_file(self):
        self.assertEqual(SCENE.to_dict()['cell']['diameter'], 56e-6)
        self.assertEqual(SCENE.diameter, 56e-6)
        again = cm.Scene(SCENE.to_dict())
        self.assertEqual(again, SCENE)
        self.assertEqual(cm.Scene.load('mouse_oocyte_injection'), SCENE)

    def test_does_not_change(self):
        other = SCENE.replace({'cell/diameter': 60e-6, 'needle/tip/radius': numpy.float64(2e-6)})
        self.assertEqual((SCENE.diameter, other.diameter), (56e-6, 60e-6))
        self.assertNotEqual(other, SCENE)

    def test_says_what_is_wrong(self):
        self.assertEqual(cm.Scene.problems(SCENE.to_dict()), '')
        keys = SCENE.to_dict()
        keys['cell']['diametre'] = 1
        self.assertIn('cell/diametre: unknown key', cm.Scene.problems(keys))
        with self.assertRaisesRegex(cm.ConfigError, 'young_modulus = -1'):
            SCENE.replace({'cell/material/young_modulus': -1})
        with self.assertRaisesRegex(ValueError, 'nowhere.yaml'):
            cm.Scene.load('/nowhere.yaml')

    def test_is_saved_and_read_as_it_was(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name) / 'scene.yaml'
        SCENE.save(path)
        self.assertEqual(cm.Scene.load(path), SCENE)
        with self.assertRaises(OSError):
            SCENE.save('/dev/null/scene.yaml')

    def test_goes_to_other_processes(self):
        self.assertEqual(pickle.loads(pickle.dumps(SCENE)), SCENE)


class ACellTest(unittest.TestCase):
    CELL = cm.Cell(SCENE)

    def test_is_served_as_in_a_session(self):
        self.assertEqual((self.CELL.model, self.CELL.family), ('surrogate', 'homogeneous'))
        self.assertLess(self.CELL.expected_error[0], 0.02)
        value, low, high = self.CELL.place['tip_radius']
        self.assertAlmostEqual(value, 3 / 28, 3)
        self.assertTrue(low < value < high)
        self.assertIn('family homogeneous', self.CELL.description)

    def test_has_the_converged_force(self):
        """Against a solution of the equations, which knows nothing of the surrogate."""
        depths = [2e-6, 6e-6]
        solved = cm.indent(SCENE, depths, tolerance=0.01)
        self.assertTrue(solved['converged'].all())
        forces = self.CELL.force(self.CELL.tips(depths))
        numpy.testing.assert_allclose(forces[:, 2], solved['force'][:, 2], rtol=0.03)

    def test_a_tongue_gives_back_the_modulus(self):
        scene = cm.Scene.load('mouse_oocyte_held')
        drawn = cm.aspirate(scene, [-300, -900, -1500, -2100], tolerance=0.02)
        self.assertTrue(drawn['converged'].all())
        self.assertTrue((numpy.diff(drawn['tongue_length']) > 0).all())
        outline = drawn['outline'][-1]
        self.assertEqual(outline.shape[1], 2)
        self.assertAlmostEqual(outline[0, 0], 0, delta=1e-12)  # from the pole in the mouth
        self.assertLess(outline[0, 1], outline[-1, 1])
        found = cm.identify_tongue(drawn['pressure'], drawn['tongue_length'] + 2e-6, scene)
        modulus = found['young_modulus']
        self.assertAlmostEqual(modulus.value / 17.9e3, 1, delta=0.01)
        self.assertLess(modulus.low, 17.9e3)
        self.assertLess(17.9e3, modulus.high)
        self.assertAlmostEqual(found['offset'].value, 2e-6, delta=0.1e-6)
        with self.assertRaisesRegex(cm.ConfigError, 'holding_pipette/mouth: is missing'):
            cm.aspirate(SCENE, [-300])
        with self.assertRaisesRegex(cm.ConfigError, 'at most 0'):
            cm.identify_tongue([1, 2, 3, 4], [1, 2, 3, 4], scene)

    def test_a_family_has_the_tongue_at_once(self):
        scene = cm.Scene.load('mouse_oocyte_held')
        tongue = cm.tongue_family(scene)
        drawn, told = cm.aspirate(scene, [-300, -2100], tolerance=0.02), tongue.at([-300, -2100])
        numpy.testing.assert_allclose(told['tongue_length'], drawn['tongue_length'], rtol=0.02)
        numpy.testing.assert_allclose(told['clamping_force'], drawn['clamping_force'], rtol=0.1)
        self.assertTrue((told['length_slope'] < 0).all())  # the pressure falls as the tongue grows
        outline = tongue.outline(-2100)
        self.assertAlmostEqual(outline[0, 1], drawn['outline'][-1][0, 1], delta=0.1e-6)
        self.assertTrue(tongue.end < tongue.strongest < -2100)
        self.assertTrue(numpy.isnan(tongue.at([1.01 * tongue.strongest])['tongue_length']).all())
        self.assertIsNone(tongue.outline(1.0))
        with self.assertRaisesRegex(cm.ConfigError, 'bore_radius = 0.714.*must be from 0.02 to 0.5'):
            cm.tongue_family(scene.replace({'holding_pipette/mouth/inner_radius': 20e-6}))
        with self.assertRaisesRegex(cm.ConfigError, 'has no mouth'):
            cm.tongue_family(SCENE)

    def test_stiffness_is_the_derivative_of_the_force(self):
        tip = self.CELL.tips([5e-6], (3e-6, 0))[0]
        stiffness = self.CELL.stiffness(tip)
        step = 1e-9
        for axis in range(3):
            ahead, behind = tip.copy(), tip.copy()
            ahead[axis] += step
            behind[axis] -= step
            pair = self.CELL.force(numpy.array([tip, ahead]), along=True)[1] - self.CELL.force(
                numpy.array([tip, behind]), along=True)[1]
            numpy.testing.assert_allclose(-pair / (2 * step), stiffness[:, axis], atol=0.03 * numpy.abs(stiffness).max())

    def test_arrays_are_as_single_tips(self):
        tips = self.CELL.tips(numpy.linspace(-1e-6, 10e-6, 50))
        all_at_once = self.CELL.force(tips)
        numpy.testing.assert_array_equal(all_at_once, [self.CELL.force(tip) for tip in tips])
        self.assertEqual(self.CELL.force(tips[0]).shape, (3,))
        self.assertEqual(self.CELL.force(tips[:0]).shape, (0, 3))
        numpy.testing.assert_array_equal(self.CELL.force(numpy.asfortranarray(tips)), all_at_once)
        numpy.testing.assert_array_equal(self.CELL.force(tips.tolist()), all_at_once)
        numpy.testing.assert_array_equal(all_at_once[tips[:, 2] > self.CELL.touch()[2]], 0)

    def test_has_no_force_where_none_is_valid(self):
        self.assertTrue(numpy.isnan(self.CELL.force(self.CELL.tips([50e-6], (20e-6, 0)))).all())

    def test_refuses_what_is_no_tip(self):
        for wrong, part in (([1, 2], r'shape \(2,\)'), (numpy.zeros((2, 4)), r'shape \(2, 4\)'),
                            ([[0, 0, 0], [0, numpy.nan, 0]], 'row 1 is not finite'), ('text', 'array of numbers'),
                            (None, 'shape'), (numpy.zeros((1, 1, 3)), 'shape')):
            with self.subTest(wrong=wrong), self.assertRaisesRegex(cm.ConfigError, f'tip: .*{part}'):
                self.CELL.force(wrong)
        with self.assertRaisesRegex(cm.ConfigError, 'axis: must be within 2.5 degrees'):
            self.CELL.force([0, 0, 0], axis=[1, 0, 1])
        with self.assertRaisesRegex(cm.ConfigError, 'model = best: must be one of'):
            cm.Cell(SCENE, 'best')

    def test_surface_has_the_dimple(self):
        tip = self.CELL.tips([8e-6])[0]
        surface = self.CELL.surface(tip)
        moved = numpy.linalg.norm(surface['vertices'] - surface['at_rest'], axis=1)
        self.assertAlmostEqual(moved.max(), 8e-6, delta=0.5e-6)
        self.assertEqual(surface['triangles'].max(), len(surface['vertices']) - 1)

    def test_threads_disturb_each_other_as_little_as_replacing_the_scene(self):
        tips = self.CELL.tips(numpy.linspace(0, 9e-6, 20000))
        expected = self.CELL.force(tips)
        results = [None] * 4

        def work(index):
            results[index] = self.CELL.force(tips)
            SCENE.replace({'cell/diameter': 40e-6})

        threads = [threading.Thread(target=work, args=(index,)) for index in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            numpy.testing.assert_array_equal(result, expected)

    def test_other_processes_have_the_same_bits(self):
        tips = self.CELL.tips([1e-6, 5e-6])
        with ProcessPoolExecutor(2, mp_context=get_context('spawn')) as pool:
            for forces in pool.map(force_of, [(SCENE, tips)] * 2):
                numpy.testing.assert_array_equal(forces, self.CELL.force(tips))
        again = pickle.loads(pickle.dumps(self.CELL))
        numpy.testing.assert_array_equal(again.force(tips), self.CELL.force(tips))

    def test_a_live_cell_is_solved(self):
        live = cm.Cell(SCENE, 'live')
        self.assertEqual((live.model, live.expected_error), ('live', None))
        tips = live.tips([1e-6, 2e-6])
        numpy.testing.assert_allclose(live.force(tips, along=True)[:, 2], self.CELL.force(tips)[:, 2], rtol=0.25)

    def test_a_live_cell_is_in_equilibrium_however_it_relaxes(self):
        relaxing = SCENE.replace({'cell/material/viscoelasticity': {'prony': [{'modulus_ratio': 1, 'relaxation_time': 1}]}})
        tips = self.CELL.tips([0.6e-6, 0.6e-6])
        forces = cm.Cell(relaxing, 'live').force(tips, along=True)
        numpy.testing.assert_allclose(forces, cm.Cell(SCENE, 'live').force(tips, along=True), rtol=0.01, atol=1e-13)

    def test_shows_no_surface_where_no_force_is_valid(self):
        with self.assertRaisesRegex(cm.ConfigError, 'tip: the cell has no valid force'):
            self.CELL.surface(self.CELL.tips([50e-6], (20e-6, 0))[0])

    def test_ctrl_c_ends_a_long_call(self):
        program = ('import os, signal, threading, cell_microinjection as cm\n'
                   'cell = cm.Cell("mouse_oocyte_injection", "live")\n'
                   'threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n'
                   'import numpy\n'
                   'try:\n'
                   '    cell.force(cell.tips(numpy.linspace(0, 8e-6, 100000)), along=True)\n'
                   'except KeyboardInterrupt:\n'
                   '    print("interrupted")\n')
        done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, 'interrupted\n', done.stderr)


class ARecordTest(unittest.TestCase):
    def record(self, noise=1e-10):
        cell = cm.Cell(SCENE.replace({'cell/material/young_modulus': 25e3}))
        depths = numpy.concatenate([numpy.zeros(100), numpy.linspace(0, 6e-6, 400)])
        random = numpy.random.default_rng(3)
        force = cell.force(cell.tips(depths))[:, 2] + random.normal(0, noise, len(depths))
        position = numpy.concatenate([numpy.linspace(-2e-6, 0, 100), numpy.linspace(0, 6e-6, 400)])
        return {'time_s': 0.01 * numpy.arange(len(depths)), 'position_um': 1e6 * position, 'force_nN': 1e9 * force}

    def test_gives_the_modulus_that_it_was_made_of(self):
        found = cm.identify(self.record(), SCENE)
        modulus = found['young_modulus']
        self.assertTrue(found.consistent and found.determined, found.warnings)
        self.assertTrue(modulus.low < 25e3 < modulus.high, modulus)
        self.assertAlmostEqual(modulus.value, 25e3, delta=500)
        self.assertEqual(len(found.residuals), len(found.position))

    def test_may_be_a_frame(self):
        try:
            import pandas
        except ImportError:
            self.skipTest('pandas is not installed')
        frame = pandas.DataFrame(self.record())
        self.assertEqual(cm.identify(frame, SCENE)['young_modulus'], cm.identify(self.record(), SCENE)['young_modulus'])

    def test_says_what_it_lacks(self):
        record = self.record()
        with self.assertRaisesRegex(cm.ConfigError, 'shape'):
            cm.identify({**record, 'force_nN': record['force_nN'][:-1]}, SCENE)
        with self.assertRaisesRegex(cm.ConfigError, 'force'):
            cm.identify({'position_um': record['position_um'], 'temperature': record['force_nN']}, SCENE)
        for wrong, part in (({'model': 'hertz', 'free': ['tip_radius']}, 'free'), ({'tip_radius': 1e-6}, 'tip_radius'),
                            ({'prony_terms': -1}, 'prony_terms = -1'), ({'model': 'cone'}, 'model = cone: must be one of')):
            with self.subTest(part=part), self.assertRaisesRegex(cm.ConfigError, part):
                cm.identify(record, SCENE, **wrong)


class AnImageTest(unittest.TestCase):
    def test_without_anything_shows_nothing(self):
        image = numpy.random.default_rng(1).normal(120, 3, (480, 640)).astype(numpy.uint8)
        measured = cm.measure_cell(image, 0.2e-6)
        self.assertEqual((measured.verdict, measured.diameter), ('not found', None))
        self.assertEqual(cm.find_tip(image)['verdict'], 'not found')

    def test_with_a_disc_has_its_diameter(self):
        """A dark rim about a grey disc, 200 px wide: as geometry alone takes a cell in bright field."""
        y, x = numpy.mgrid[0:480, 0:640]
        distance = numpy.hypot(x - 320.3, y - 239.6)
        grey = 140 - 12 / (1 + numpy.exp(distance - 100)) - 60 * numpy.exp(-0.5 * ((distance - 97) / 3) ** 2)
        noisy = grey + numpy.random.default_rng(2).normal(0, 1.5, grey.shape)
        config = {'eyes': 'geometry', 'cell': {'contrast_mode': 'bright_field'}}
        for image in (noisy.astype(numpy.uint8), (256 * noisy).astype(numpy.uint16),
                      numpy.repeat(noisy.astype(numpy.uint8)[:, :, None], 3, axis=2)):
            with self.subTest(shape=image.shape, dtype=image.dtype):
                measured = cm.measure_cell(image, 0.5e-6, config)
                self.assertNotEqual(measured.verdict, 'not found', measured.reason)
                self.assertAlmostEqual(measured.centre[0], 320.3, delta=0.5)
                self.assertAlmostEqual(measured.centre[1], 239.6, delta=0.5)

    def test_that_is_rendered_has_what_its_truth_says(self):
        image, truth = cm.render_specimen(7)
        self.assertEqual((image.shape, image.dtype), ((1040, 1392), numpy.uint8))
        numpy.testing.assert_array_equal(image, cm.render_specimen(7)[0])
        numpy.testing.assert_allclose(cm.find_tip(image)['place'], truth['tip'], atol=1)
        measured = cm.measure_cell(image, truth['pixel_size'])
        numpy.testing.assert_allclose(measured.centre, truth['centre'], atol=1)
        self.assertAlmostEqual(measured.diameter[0] / truth['pixel_size'], truth['diameter'], delta=1)
        noisy, same = cm.render_specimen(7, {'sensor': {'gain': 2, 'bits': 16}})
        self.assertEqual((noisy.dtype, same), (numpy.uint16, truth))
        with self.assertRaisesRegex(cm.ConfigError, 'unknown key'):
            cm.render_specimen(7, {'sensors': {}})

    def test_must_be_one(self):
        for wrong, part in ((numpy.zeros((4, 4)), 'float64: must be uint8 or uint16'),
                            (numpy.zeros(4, numpy.uint8), 'shape'), ('x', 'image')):
            with self.subTest(part=part), self.assertRaisesRegex(cm.ConfigError, part):
                cm.measure_cell(wrong, 1e-6)
        with self.assertRaisesRegex(cm.ConfigError, 'pixel_size'):
            cm.measure_cell(numpy.zeros((64, 64), numpy.uint8), -1e-6)
        with self.assertRaisesRegex(cm.ConfigError, 'unknown key'):
            cm.measure_cell(numpy.zeros((64, 64), numpy.uint8), 1e-6, {'eye': 'both'})


class ATaskTest(unittest.TestCase):
    @staticmethod
    def straight(observation):
        """Down until the force falls or the state says so, the pulse, and out."""
        state = gym.STATES[int(observation[gym.OBSERVATION.index('state')])]
        diameter = observation[gym.OBSERVATION.index('diameter_m')]
        if state in ('idle', 'approach', 'contact', 'indent'):
            return [0, 0, -0.1 * diameter, 0]
        return [0, 0, 0.5 * diameter if observation[gym.OBSERVATION.index('volume_m3')] > 1e-15 else 0, 1]

    def run_through(self, env, seed, steps=200000):
        observation, _ = env.reset(seed=seed)
        total = 0.0
        for _ in range(steps):
            observation, reward, terminated, truncated, info = env.step(self.straight(observation))
            total += reward
            if terminated or truncated:
                return observation, total, info
        self.fail('the trial does not end')

    def test_is_scored_at_its_end(self):
        env = gym.Inject(steps=5)
        observation, reward, info = self.run_through(env, 5)
        self.assertTrue(env.observation_space.contains(observation))
        self.assertEqual(reward, info['score'] / 100)
        self.assertEqual(set(info['measures']), {'peak_force_N', 'deformation_m', 'lateral_error_m', 'time_s', 'punctures', 'volume_m3'})
        with self.assertRaisesRegex(cm.ConfigError, 'is over'):
            env.step([0, 0, 0, 0])

    def test_names_the_state_as_the_controller_does(self):
        trial, seen = _core.Trial(5), set()
        observation = trial.observation
        while not trial.over:
            number = observation[gym.OBSERVATION.index('state')]
            self.assertEqual(gym.STATES[int(number)], trial.state)
            seen.add(trial.state)
            vx, vy, vz, inject = self.straight(observation)
            observation = trial.step(vx, vy, vz, inject > 0.5, 5)
        self.assertLessEqual({'approach', 'contact', 'indent', 'punctured', 'inject', 'withdraw'}, seen)

    def test_has_the_same_bits_for_the_same_seed(self):
        first, again, other = (self.run_through(gym.Inject(steps=5), seed) for seed in (5, 5, 6))
        numpy.testing.assert_array_equal(first[0], again[0])
        self.assertEqual(first[1:], again[1:])
        self.assertFalse(numpy.array_equal(first[0], other[0]))

    def test_in_several_processes_too(self):
        with gym.Vector(gym.Inject, 2) as both:
            observations, _ = both.reset([5, 6])
            numpy.testing.assert_array_equal(observations[0], first_observation(5))
            numpy.testing.assert_array_equal(observations[1], first_observation(6))
            moved = both.step([[0, 0, -1e-5, 0]] * 2)[0]
            alone = gym.Inject()
            alone.reset(seed=6)
            numpy.testing.assert_array_equal(moved[1], alone.step([0, 0, -1e-5, 0])[0])
            with self.assertRaisesRegex(cm.ConfigError, 'velocity'):
                both.step([[0, 0, -1, 0], [0, 0, 0, 0]])
            observations, _ = both.reset([5, 6])  # and no answer to the refused step is left
            numpy.testing.assert_array_equal(observations[1], first_observation(6))
            numpy.testing.assert_array_equal(both.reset_one(0, 6)[0], observations[1])
            for wrong in ([], [5], [5, 6, 7]):
                with self.assertRaisesRegex(cm.ConfigError, 'of 2 environments'):
                    both.reset(wrong)

    def test_to_press_with_a_force_ends_when_it_is_held(self):
        env = gym.IndentToForce(steps=10)
        observation, _ = env.reset(seed=2)
        done = late = False
        while not (done or late):
            wished, force = observation[-1], observation[gym.OBSERVATION.index('force_axial_N')]
            speed = numpy.clip(-20e-6 * (wished - force) / wished, -20e-6, 20e-6)
            observation, _, done, late, _ = env.step([0, 0, speed])
        self.assertTrue(done)

    def test_has_faults_only_where_they_are_asked_for_and_the_same_ones_each_time(self):
        told = {}
        for seed in range(12):
            _, _, info = self.run_through(gym.Inject(steps=10, faults=0.5), seed)
            told[seed] = info['fault']
            if seed < 2:
                self.assertNotIn('fault', self.run_through(gym.Inject(steps=10), seed)[2])
                self.assertEqual(self.run_through(gym.Inject(steps=10, faults=0.5), seed)[2], info)
        faults = [fault for fault in told.values() if fault]
        self.assertTrue(0 < len(faults) < 12, told)
        self.assertTrue(all(set(fault) == {'kind', 'begin_s', 'size'} for fault in faults))
        with self.assertRaisesRegex(cm.ConfigError, 'faults: must be from 0 to 1'):
            gym.Inject(faults=2).reset(seed=1)

    def test_tells_the_fault_at_the_end_of_a_press_too(self):
        env = gym.IndentToForce(steps=1000, faults=1)
        env.reset(seed=3)
        over = False
        while not over:
            _, _, done, late, info = env.step([0, 0, 0])
            over = done or late
            self.assertEqual('fault' in info, over)
        self.assertIn(info['fault']['kind'], ('sensor_frozen', 'sensor_offset', 'sensor_drift', 'commands_lost', 'commands_late',
                                              'needle_drift'))

    def test_to_press_cannot_be_done_by_resting(self):
        for seed in range(20):
            env = gym.IndentToForce(steps=100)
            observation, _ = env.reset(seed=seed)
            self.assertGreaterEqual(observation[-1], 10 * env.RESOLVED)
            for _ in range(10):
                self.assertFalse(env.step([0, 0, 0])[2], seed)

    def test_refuses_what_is_no_action(self):
        env = gym.Inject()
        with self.assertRaisesRegex(cm.ConfigError, r'reset\(\) comes before'):
            env.step([0, 0, 0, 0])
        env.reset(seed=1)
        for wrong in ([0, 0, numpy.nan, 0], [0, 1, 0, 0]):
            with self.assertRaisesRegex(cm.ConfigError, 'velocity'):
                env.step(wrong)
        with self.assertRaises(cm.ConfigError):
            gym.Inject(steps=0.5)


class TheModuleTest(unittest.TestCase):
    def test_is_of_this_package(self):
        package = (Path(__file__).resolve().parents[2] / 'package.xml').read_text(encoding='utf-8')
        self.assertIn(f'<version>{cm.__version__}</version>', package)
        self.assertTrue(os.path.isdir(cm.package_folder() + '/config/families'))

    def test_ends_with_its_interpreter(self):
        program = ('import cell_microinjection as cm, threading, numpy\n'
                   'cell = cm.Cell("mouse_oocyte_injection")\n'
                   'tips = cell.tips(numpy.linspace(0, 9e-6, 200000))\n'
                   'threading.Thread(target=lambda: [cell.force(tips) for _ in range(100)], daemon=True).start()\n'
                   'print("end")\n')
        done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual((done.returncode, done.stdout), (0, 'end\n'), done.stderr)


if __name__ == '__main__':
    unittest.main()
