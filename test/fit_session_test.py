"""A session's numbers follow its cell, and what does not fit is refused with its reason."""

import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import yaml

PACKAGE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(PACKAGE / 'launch'))
from fit_session import LENGTHS, NODES, Misfit, find, fit_session, read  # noqa: E402

OOCYTE = {'cell': {'diameter': 56e-6, 'material': {'young_modulus': 17.9e3}, 'puncture': {'force': 7.5e-6}},
          'holding_pipette': {'contact_radius': 10e-6}, 'needle': {'tip': {'shape': 'hemisphere', 'radius': 3e-6}}}


def large(factor, modulus=17.9e3):
    """A cell of another size, in proportion."""
    return {'cell': {'diameter': factor * 56e-6, 'material': {'young_modulus': modulus}},
            'holding_pipette': {'contact_radius': factor * 10e-6},
            'needle': {'tip': {'shape': 'hemisphere', 'radius': factor * 3e-6}}}


class FitSessionTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)

    def file(self, name, content):
        path = Path(self._folder.name) / name
        path.write_text(content if isinstance(content, str) else yaml.safe_dump(content), encoding='utf-8')
        return str(path)

    def fit(self, scene, overrides=None, **arguments):
        return fit_session({
            'scene': self.file('scene.yaml', scene), 'urdf': str(PACKAGE / 'urdf/rig.urdf'), 'haptic_config': '',
            'overrides': self.file('overrides.yaml', overrides) if overrides is not None else '',
            'sensor': 'simulated', 'camera': 'none', 'force_sources': 'predicted', **arguments})

    def refused(self, *arguments, **more):
        with self.assertRaises(Misfit) as context:
            self.fit(*arguments, **more)
        return str(context.exception)

    def test_the_files_are_for_the_oocyte_of_the_paper(self):
        text, parameters = self.fit(OOCYTE)
        self.assertEqual(parameters, {})
        self.assertIn('56 um: the needle starts at 60 um, stops at 15 uN', text)

    def test_the_virtual_microscope_shows_a_cell_of_any_size_alike(self):
        large = {**OOCYTE, 'cell': {**OOCYTE['cell'], 'diameter': 112e-6}}
        _, parameters = self.fit(large, camera='sim')
        self.assertAlmostEqual(parameters['microscope']['camera']['pixel_size'], 0.5e-6)
        self.assertEqual(parameters['vision']['pixel_size'], parameters['microscope']['camera']['pixel_size'])
        _, parameters = self.fit(large, camera='device')  # its pixel size is known to a calibration only
        self.assertNotIn('vision', parameters)

    def test_keys_are_those_of_the_files(self):
        for node in NODES:
            for path in LENGTHS[node]:
                self.assertIsNotNone(find(read(PACKAGE / f'config/{node}.yaml'), path), f'{node}/{path}')
        for path in LENGTHS['haptic_device']:
            self.assertIsNotNone(find(read(PACKAGE / 'config/haptic/marker.yaml')['haptic_device'], path), path)

    def test_the_hand_feels_a_cell_in_proportion_alike(self):
        for factor, modulus in ((2, 17.9e3), (0.5, 17.9e3), (1, 5e3), (2.5, 1e3)):
            bridge = self.fit(large(factor, modulus))[1]['haptic_bridge']
            stiffness = factor * modulus / 17.9e3  # of the cell, against the oocyte's
            scale = bridge.get('position_scale', 1e-3) * bridge.get('force_gain', 2e5)
            self.assertAlmostEqual(stiffness * scale, 1e-3 * 2e5, delta=1e-2)

    def test_a_soft_inside_is_felt(self):
        def gain(moduli):
            layers = [{'outer_radius': radius, 'material': {'young_modulus': modulus}}
                      for radius, modulus in zip((28e-6, 24e-6, 10e-6), moduli)]
            scene = {**large(1), 'cell': {'layers': layers[:len(moduli)]}}
            return self.fit(scene)[1].get('haptic_bridge', {}).get('force_gain', 2e5)

        self.assertEqual(gain([17.9e3]), 2e5)
        self.assertEqual(gain([17.9e3, 17.9e3, 17.9e3]), 2e5)
        self.assertAlmostEqual(2e5 / gain([17.9e3, 1e3]), (1 + 16.9 * (1 - (24 / 28)**3)**2) / 17.9, 5)
        self.assertGreater(gain([17.9e3, 1e3]), gain([17.9e3, 1e3, 5e3]))

    def test_times_stay(self):
        controller = self.fit(large(3))[1]['injection_controller']
        self.assertAlmostEqual(controller['motion']['travel_limit'] / controller['motion']['approach_speed'], 3, 4)

    def test_the_rig_follows(self):
        root = ElementTree.fromstring(self.fit(large(3))[1]['robot_description'])

        def height(joint):
            return float(root.find(f"joint[@name='{joint}']/origin").get('xyz').split()[2])

        self.assertAlmostEqual(height('world_to_manipulator_base'), 180e-6)
        self.assertAlmostEqual(height('world_to_holding_pipette'), -84e-6)
        self.assertAlmostEqual(height('world_to_dish'), -120e-6)  # the floor is 60 um below it
        self.assertAlmostEqual(float(root.find("joint[@name='manipulator_z']/limit").get('lower')), -600e-6)
        pipette = root.find("link[@name='holding_pipette']/collision/geometry/cylinder")
        self.assertAlmostEqual(float(pipette.get('radius')), 90e-6)
        self.assertAlmostEqual(float(root.find("link[@name='cell']/visual/geometry/sphere").get('radius')), 84e-6)

    def test_the_guard_follows_the_puncture_force(self):
        layers = {'layers': [{'name': 'a', 'force': 1e-6}, {'name': 'b', 'force': 2e-6, 'stiffness': 1}]}
        scene = {**OOCYTE, 'cell': {**OOCYTE['cell'], 'puncture': layers}}
        self.assertEqual(self.fit(scene)[1], {'injection_controller': {'force_limit': 4e-6}})

    def test_speeds_stay_within_those_of_the_axes(self):
        parameters = self.fit(large(20))[1]
        self.assertEqual(parameters['micromanipulator']['servo_speed_limit'], 2e-3)
        self.assertEqual(parameters['injection_controller']['motion']['stab_speed'], 2e-3)

    def test_a_small_cell_is_not_touched_by_noise(self):
        self.assertNotIn('detection', self.fit(large(0.5))[1]['injection_controller'])

    def test_a_device_s_own_numbers_are_scaled(self):
        joy = str(PACKAGE / 'config/haptic/joy.yaml')
        rate = self.fit(large(2), haptic_config=joy)[1]['haptic_bridge']['rate_mode']
        self.assertEqual(rate['gain'], 2e-3)
        self.assertEqual(rate['speed_limit'], 40e-6)

    def test_the_user_has_the_last_word(self):
        parameters = self.fit(large(2), 'injection_controller: {force_limit: 2e-6, motion: {approach_speed: 9e-6}}\n'
                                        'cell_simulator: {rate: 500}\nrig: {floor_height: -500e-6}')[1]
        controller = parameters['injection_controller']
        self.assertEqual((controller['force_limit'], controller['motion']['approach_speed']), (2e-6, 9e-6))
        self.assertAlmostEqual(controller['motion']['travel_limit'], 120e-6)
        self.assertEqual(parameters['cell_simulator'], {'rate': 500})
        self.assertIn('-0.00044', parameters['robot_description'])

    def test_names_what_does_not_fit(self):
        for overrides, reason in (
                ('rig: {start_height: 20e-6}', 'rig/start_height = 2e-05 m: the needle starts in the cell'),
                ('rig: {travel: 30e-6}', 'rig/travel = 3e-05 m: the needle does not reach'),
                ('rig: {mouth_height: 0}', 'rig/mouth_height = 0 m: the holding pipette does not hold the cell'),
                ('rig: {floor_height: -10e-6}', 'rig/floor_height = -1e-05 m: the cell lies in the dish'),
                ('rig: {start_height: high}', 'rig/start_height = high: must be a number'),
                ('rig: {roof: 1}', 'unknown key rig/roof; allowed: floor_height, '),
                ('injection_controller: {force_limit: 7e-6}', 'must be above the puncture force 7.5e-06 N'),
                ('injection_controller: {force_limit: much}', 'force_limit = much: must be a number'),
                ('injection_controller: {speed_limit: 5e-3}', "speed_limit = 0.005 m/s: must be at most the axes' 0.002"),
                ('injection_controller: {goal: {depth: 60e-6}}', 'goal/depth = 6e-05 m: must be at most depth_limit'),
                ('injection_controller: {motion: {travel_limit: 10e-6}}', 'the needle starts 32 um above the cell'),
                ('controller: {a: 1}', 'unknown key controller; allowed: rig, '),
                ('display: 3', 'display = 3: must be keys with values'), ('{', 'overrides.yaml: '),
                ('- 1', 'must be keys with values')):
            with self.subTest(overrides):
                self.assertIn(reason, self.refused(OOCYTE, overrides))

    def test_a_force_beyond_the_sensor_s_range_is_refused_where_it_is_used(self):
        stiff = large(12)
        self.assertIn('must be at most the range of the force sensor', self.refused(stiff, force_sources='predicted measured'))
        self.fit(stiff)
        self.fit(stiff, force_sources='measured', sensor='topic')

    def test_a_scene_without_a_cell_is_named(self):
        for scene in ('{}', 'cell: {}', 'cell: {diameter: big}', 'cell: {diameter: 0, material: {young_modulus: 1}}\n'
                      'needle: {tip: {radius: 1e-6}}', 'a', 'cell: [', {**OOCYTE, 'needle': {}}):
            with self.subTest(scene):
                self.assertIn('scene.yaml: ', self.refused(scene))


if __name__ == '__main__':
    unittest.main()
