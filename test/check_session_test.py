"""session.launch says what is wrong with its arguments."""

import re
import sys
import unittest
from pathlib import Path
from xml.etree import ElementTree

LAUNCH = Path(__file__).resolve().parents[1] / 'launch'
sys.path.insert(0, str(LAUNCH))
from check_session import choices, problems  # noqa: E402

GOOD = {'model': 'auto', 'rig': 'sim', 'sensor': 'simulated', 'injector': 'simulated', 'haptic': 'operator',
        'position_type': '', 'mode': 'manual', 'force_source': 'predicted', 'hand_force': 'predicted', 'link': 'none',
        'clock': 'wall', 'camera': 'sim', 'scene': str(LAUNCH.parent / 'config/cells/mouse_oocyte.yaml'),
        'operator': '', 'record': '', 'allow_network': 'True', 'require_operator': 'true', 'inject': 'True', 'link_emulated': 'False',
        'auto_enable': 'True', 'display': 'true', 'rviz': 'false', 'console': 'none', 'bag': 'true', 'end_when_done': 'false',
        'wait_for_go': 'false', 'twin': 'false', 'hidden': '', 'modelled': 'True'}


class CheckSessionTest(unittest.TestCase):
    def test_accepts_what_is_right(self):
        self.assertEqual(problems(GOOD), [])
        self.assertEqual(problems({**GOOD, 'twin': 'true', 'sensor': 'none'}), [])  # it has a camera
        for name, allowed in choices().items():
            others = {'mode': {'haptic': 'none'}}.get(name, {})
            for value in allowed:
                with self.subTest(name=name, value=value):
                    self.assertEqual(problems({**GOOD, **others, name: value}), [])

    def test_names_argument_value_and_what_is_allowed(self):
        for name in choices():
            with self.subTest(name=name):
                self.assertRegex('\n'.join(problems({**GOOD, name: 'wrong'})), rf"^{name} = 'wrong': must be one of: \w+")

    def test_names_what_does_not_go_together(self):
        for changes, what in (({'scene': '/nowhere.yaml'}, "scene = '/nowhere.yaml': no such file; the cells are: human_oocyte, mouse"),
                              ({'clock': 'lockstep', 'haptic': 'omni'}, "clock = 'lockstep' with haptic = 'omni'"),
                              ({'mode': 'automatic'}, "mode = 'automatic': must be with haptic:=none"),
                              ({'hidden': '/nowhere.yaml'}, "hidden = '/nowhere.yaml': no such file"),
                              ({'hidden': GOOD['scene'], 'modelled': 'False', 'rig': 'zaber'}, "hidden with rig = 'zaber': must be with sim"),
                              ({'twin': 'true', 'sensor': 'none', 'camera': 'none'}, "twin = 'true' with sensor = 'none' and camera = 'none': must be with"),
                              ({'twin': 'true', 'sensor': 'none', 'clock': 'lockstep'}, "clock = 'lockstep' with twin = 'true' and sensor = 'none'"),
                              ({'twin': 'true', 'modelled': 'False', 'sensor': 'serial'}, "twin = 'true' with force_source = 'predicted'"),
                              ({'twin': 'true', 'modelled': 'False', 'sensor': 'none'}, "an image does not show the puncture"),
                              ({'sensor': 'none', 'force_source': 'measured'}, "force_source, hand_force = 'measured' with sensor"),
                              ({'operator': 'ann'}, "operator: must be with record:=FOLDER")):
            with self.subTest(what):
                found = problems({**GOOD, **changes})
                self.assertEqual(len(found), 1, found)
                self.assertIn(what, found[0])

    def test_knows_the_arguments_that_session_launch_gives(self):
        tree = ElementTree.parse(LAUNCH / 'session.launch')
        command, = (param.get('command') for param in tree.iter('param') if param.get('name') == '/session/arguments')
        given = re.findall(r'(\w+):=\$\(arg (\w+)\)', command)
        self.assertEqual({name for name, _ in given}, set(GOOD))
        self.assertTrue(all(argument in (name, f'{name}_given') for name, argument in given))
        self.assertLessEqual(set(choices()), {argument.get('name') for argument in tree.iter('arg')})


if __name__ == '__main__':
    unittest.main()
