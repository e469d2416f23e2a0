"""The rviz configurations of the consoles (launch/console_config.py)."""

import re
import sys
import unittest
from pathlib import Path
from xml.etree import ElementTree

import yaml

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'launch'))
from check_session import choices  # noqa: E402
from console_config import configuration, merged  # noqa: E402

TASKS = [name for name in choices()['console'] if name != 'none']


class ConsoleConfigTest(unittest.TestCase):
    def test_overrides_by_key_and_by_name(self):
        base = {'a': 1, 'b': {'c': 2, 'd': 3}, 'list': [{'Name': 'x', 'on': True, 'k': 4}, {'Name': 'y'}]}
        task = {'b': {'c': 5}, 'list': [{'Name': 'z'}, {'Name': 'x', 'on': False}], 'e': 6}
        self.assertEqual(merged(base, task), {'a': 1, 'b': {'c': 5, 'd': 3}, 'e': 6, 'list': [
            {'Name': 'x', 'on': False, 'k': 4}, {'Name': 'y'}, {'Name': 'z'}]})
        self.assertEqual(base['list'][0]['on'], True)

    def test_every_task_has_its_console_and_the_scene(self):
        session = yaml.safe_load((ROOT / 'config/session.rviz').read_text())
        names = {display['Name'] for display in session['Visualization Manager']['Displays']}
        self.assertGreaterEqual(set(TASKS), {'inject', 'teleoperate', 'train', 'calibrate', 'paper'})
        for task in TASKS:
            with self.subTest(task):
                config = yaml.safe_load(configuration(task))
                console, microscope = config['Panels']
                self.assertEqual((console['Class'], microscope['Class']),
                                 ('microinjection/ConsolePanel', 'microinjection/MicroscopePanel'))
                displays = config['Visualization Manager']['Displays']
                # A misspelt Name would be added as a display without a class.
                self.assertEqual({display['Name'] for display in displays}, names)
                self.assertTrue(all(display['Class'] for display in displays))

    def test_every_part_is_one_of_the_panel(self):
        source = (ROOT / 'src/operation/console/console_parts.cpp').read_text()
        known = set(re.findall(r'"(\w+)"', re.search(r'kWords\[\] = \{(.*?)\}', source, re.DOTALL).group(1)))
        self.assertGreater(len(known), 5)
        for task in TASKS:
            with self.subTest(task):
                parts = yaml.safe_load(configuration(task))['Panels'][0]['Parts'].split()
                self.assertLessEqual(set(parts), known)

    def test_every_panel_is_in_the_plugin_description(self):
        description = (ROOT / 'config/console/plugin_description.xml').read_text()
        for task in TASKS:
            for panel in yaml.safe_load(configuration(task))['Panels']:
                self.assertIn(f'class name="{panel["Class"]}"', description)

    def test_no_parameter_of_the_launch_file_is_a_nodes(self):
        """A node refuses keys that it does not know."""
        launch = ElementTree.parse(ROOT / 'launch/display.launch').getroot()
        nodes = {node.get('name') for node in launch.iter('node')}
        self.assertIn('display', nodes)
        for parameter in launch.findall('param'):
            self.assertNotIn(parameter.get('name').strip('/').split('/')[0], nodes)


if __name__ == '__main__':
    unittest.main()
