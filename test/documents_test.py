"""Holds the documents to what is there.

Follows every relative link of every .md file. Checks what a document names in backquotes or in a block of commands: paths,
files, ./dev commands and their options, programs and theirs, launch files and arguments, topics, services, keys and
identifiers. Checks the tables of the reference against code and configuration.
"""
import re
import tempfile
import unittest
from pathlib import Path

from documents_checker import Checker
from documents_project import Project
from documents_tables import (check_arguments, check_commands, check_defaults, check_fitted, check_nodes, check_origins,
                              check_parameters, check_scene_keys, check_topics, fitted_keys, reachable)

ROOT = Path(__file__).resolve().parent.parent


class TheDocuments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.project = Project(ROOT)

    def assert_none(self, problems):
        self.assertFalse(problems, f'{len(problems)} problems:\n' + '\n'.join(problems))

    def assert_table(self, check, path):
        self.assert_none(check(self.project, self.project.text(path)))

    def test_name_what_is_there(self):
        self.assert_none(Checker(self.project).check())

    def test_are_found_from_the_readme(self):
        found = reachable(self.project)
        self.assert_none([f'{path}: no link leads there' for path in self.project.documents
                          if path.startswith('doc/') and path not in found])

    def test_show_code_that_is_compiled(self):
        tests = [path.read_text() for path in (ROOT / 'test').rglob('*_test.cpp')]
        shown = [(path, block) for path in self.project.documents
                 for block in re.findall('```cpp\n(.*?)```', self.project.text(path), re.DOTALL)]
        self.assertTrue(shown)
        self.assert_none([f'{path}: no test has the code {block.splitlines()[0]}' for path, block in shown
                          if not any(block in text for text in tests)])

    def test_have_every_parameter_and_its_default(self):
        self.assert_table(check_parameters, 'doc/reference/parameters.md')

    def test_mark_what_a_session_fits_to_its_cell(self):
        self.assertGreater(len(fitted_keys(self.project.text('src/session/session_fit.cpp'))), 30)
        self.assert_table(check_fitted, 'doc/reference/parameters.md')

    def test_state_the_defaults_of_a_session(self):
        self.assert_none(check_defaults(self.project))

    def test_scenes_say_where_their_numbers_are_from(self):
        self.assert_none(check_origins(self.project))

    def test_have_every_topic(self):
        self.assert_table(check_topics, 'doc/reference/topics_and_frames.md')

    def test_have_the_nodes_of_every_topic(self):
        self.assert_table(check_nodes, 'doc/reference/topics_and_frames.md')

    def test_have_every_command_argument_and_option(self):
        self.assert_table(check_commands, 'doc/reference/commands.md')

    def test_have_every_key_of_a_scene(self):
        self.assert_table(check_scene_keys, 'doc/reference/scene_file.md')

    def test_keep_the_sizes_of_a_rig_by_the_names_that_the_session_knows(self):
        shown = re.search('      rig:\n((?:        .*\n)+)', self.project.text('doc/guide/your_rig.md'))[1]
        known = re.search(r'kSizes\[\] = (.*?);', self.project.text('src/session/rig_description.cpp'), re.DOTALL)[1]
        self.assertEqual(sorted(re.findall(r'^ +(\w+):', shown, re.MULTILINE)), re.findall('"(.*?)"', known))

    def test_have_the_holding_radius_of_the_families(self):
        text = ' '.join(self.project.text('doc/guide/your_cell.md').split())
        for family, form in (('zona', 'with a zona'), ('homogeneous', 'of a cell of one material')):
            low, high = re.search(r'holding_radius: \[(.*), (.*)\]', self.project.text(f'config/families/{family}.yaml')).groups()
            self.assertIn(f'{low} to {high} R {form}', text)

    def test_are_read_token_by_token(self):
        self.assertGreater(len(self.project.topics), 40)
        self.assertGreater(len(self.project.keys), 200)
        self.assertIn('--tolerance', self.project.programs['indent'])
        self.assertIn('--isolated', self.project.dev['shell'])
        self.assertIn('/force_sensor/tare', self.project.topics)
        self.assertGreater(sum(len(re.findall('`', self.project.text(path))) for path in self.project.documents), 1000)


class TheCheck(unittest.TestCase):
    """Each thing that a document may get wrong, in a small project, is reported, and what is right is not."""

    FILES = {
        'dev': """#!/bin/bash
case "$*" in
  --help) printf '  test          all tests\\n  bench NAME    a benchmark\\n' ;;
  "test --help") echo 'usage: ./dev test [--core]' ;;
esac
""",
        'launch/session.launch': '<launch><arg name="rig" default="sim" doc="sim or zaber"/><arg name="fixed" value="1"/><arg name="set" default="" doc="keys"/></launch>',
        'src/commands/session.cpp': 'int main() {}\n',
        'config/sessions/default.yaml': 'rig:\n  name: sim\noverrides: {}\n',
        'config/bridge.yaml': 'rate: 1000   # Hz\nlimits: {force: 3.0}\n# serial:\n#   baud: 9600   # bit/s\n',
        'src/nodes/bridge_node.cpp': 'cycle.output<Wrench>("haptic/servo_cf"); bus.advertiseService<A>("~tare");\n',
        'src/nodes/programs/bridge.cpp': '#include "nodes/bridge_node.h"\nint main() {}\n',
        'src/nodes/programs/clock.cpp': 'int main() {}\n',
        'src/commands/indent.cpp': 'add("depths", po::value(&depths)); int main() {}\n',
        'benchmark/accuracy.cpp': 'add("draws", po::value(&draws));\n',
        'src/cell/model/scene.cpp': 'reader.number("stretch"); double forceGain = 1;\n',
        'test/cell/model/scene_test.cpp': '\n',
        'doc/guide/other.md': '# Other page\n\n## How its `rate` is, mostly\n',
    }
    GOOD = """# Title

See [other](doc/guide/other.md#how-its-rate-is-mostly), `config/bridge.yaml`, `scene.cpp`, `cell/model/scene.cpp`, `limits/force`,
`serial/baud`, `stretch`, `forceGain`, `/haptic/servo_cf`, `/bridge/tare`, `/haptic`, `rig:=zaber`, `--depths`,
`launch/NAME.launch`, `./dev test --core`, `roslaunch cell_microinjection session.launch rig:=sim`.

    ./dev test --core cell/model
    ./dev bench accuracy -- --draws 3
    rosrun cell_microinjection indent --depths 1
    rosrun cell_microinjection session lab.yaml rig.name:=sim
    roslaunch cell_microinjection session.launch set:="rig.name=sim overrides.bridge.rate=1"
    rostopic echo /haptic/servo_cf          # the force
"""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name, text in self.FILES.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def problems(self, text, name='doc/guide/page.md'):
        self.write(name, text)
        return Checker(Project(self.root)).check()

    def test_accepts_a_document_that_is_right(self):
        good = re.sub(r'(?<=, )`|(?<=,)\n`', '\n`', self.GOOD)
        self.assertEqual(self.problems(good, 'README.md'), [])

    def test_reports_what_is_not_there(self):
        for wrong, reason in {
                '[page](nowhere.md)': 'no such file', '[page](other.md#nothing)': 'no such heading',
                '[page](../other.md)': 'no such file', '![picture](scene.png)': 'no such file',
                '`config/nothing.yaml`': 'no file, topic or key', '`cell/nothing.cpp`': 'no file, topic or key',
                '`nodes/servo_cf.h`': 'no file, topic or key', '`scene.h`': 'no file, topic or key',
                '`limits/torque`': 'no file, topic or key', '`serial/parity`': 'no file, topic or key',
                '`launch/NAME.urdf`': 'no file, topic or key', '`torque_gain`': 'nothing of that name',
                '`/haptic/servo_cx`': 'no node has a topic', '`/bridge/reset`': 'no node has a topic', '`--deep`': 'no program has an option',
                '`speed:=1`': 'no launch file has an argument', '`fixed:=1`': 'no launch file has an argument',
                '`rig:=lathe`': 'knows no lathe', '`set:=rig.speed=1`': 'no key rig.speed', '`./dev demo`': '', '`./dev walk --far`': 'no command walk',
                '`./dev test --bore`': 'no option --bore', '`limits: {torque: 1}`': 'nothing of that name'}.items():
            with self.subTest(wrong=wrong):
                found = self.problems(f'# Page\n\nSee {wrong}.\n')
                self.assertEqual(len(found), 1, found)
                self.assertIn('doc/guide/page.md:3', found[0])
                self.assertIn(reason, found[0])

    def test_reports_commands_that_cannot_be_run(self):
        for wrong, reason in {
                './dev walk': 'no command walk', './dev test --far': 'no option --far', './dev test attic': 'no folder test/attic',
                './dev bench speed': 'no benchmark speed', './dev bench accuracy -- --depths 1': 'no option --depths',
                'rosrun cell_microinjection dent': 'no program dent', 'rosrun cell_microinjection indent --deep': 'no option --deep',
                './dev shell -- rosrun cell_microinjection dent': 'no command shell',
                'roslaunch cell_microinjection other.launch': 'no launch file', 'rostopic echo /haptic/none': 'no node has a topic',
                'roslaunch cell_microinjection session.launch rig:=lathe': 'knows no lathe',
                'roslaunch cell_microinjection session.launch speed:=1': 'no argument speed',
                'roslaunch cell_microinjection session.launch set:="rig.speed=1"': 'no key rig.speed',
                'rosrun cell_microinjection session lab.yaml rig.speed:=1': 'no key rig.speed',
                'rostopic pub -1 /haptic/servo_cf cell_microinjection/Nothing': 'no message', 'python3 src/none.py': 'no file src/none.py',
                'cp config/none.yaml mine.yaml': 'no file config/none.yaml'}.items():
            for block in (f'    {wrong}\n', f'```\n{wrong}\n```\n'):
                with self.subTest(block=block):
                    for written in (block, block.replace(' --', ' \\\n     --')):
                        found = self.problems(f'# Page\n\nText.\n\n{written}')
                        self.assertIn(reason, '\n'.join(found))

    def test_checks_a_command_whose_continuation_is_missing(self):
        found = self.problems('# Page\n\nText.\n\n    ./dev walk \\\n\nMore text.\n\n    ./dev run\n')
        self.assertEqual(len(found), 2, found)
        self.assertIn('doc/guide/page.md:5: ./dev has no command walk', found[0])

    def test_reports_tables_that_differ_from_the_code(self):
        project = Project(self.root)
        table = '## config/bridge.yaml\n\n| key | default |\n|---|---|\n| `rate` | 1000 |\n| `limits/force` | 3.0 |\n'
        self.assertEqual(check_parameters(project, table), [])
        self.assertIn('rate = 1000', check_parameters(project, table.replace('1000', '999'))[0])
        self.assertIn('limits/force', check_parameters(project, table.replace('`limits/force`', '`force`'))[0])
        self.assertIn('the file has not', check_parameters(project, table + '| `more` | 1 |\n')[0])
        self.assertEqual(check_topics(project, '`/haptic/servo_cf` `/bridge/tare`'), [])
        self.assertEqual(len(check_topics(project, '')), 2)
        self.assertEqual(check_nodes(project, '| `/haptic/servo_cf` | `Wrench` | `bridge` |\n'), [])
        self.assertIn('does not know', check_nodes(project, '| `/haptic/other` | `Wrench` | `bridge` |\n')[0])
        self.assertIn('bridge publishes it', check_nodes(project, '| `/haptic/servo_cf` | `Wrench` | you |\n')[0])
        self.assertIn('rig = sim', '\n'.join(check_arguments(project, '## session.launch\n| `rig` | `zaber` | |\n')))
        self.assertIn('rig is not', '\n'.join(check_arguments(project, '## session.launch\n| `mode` | | |\n')))
        self.write('launch/session.launch', '<launch><arg name="rig" default="" doc="rig.name: sim or zaber"/></launch>')
        project = Project(self.root)
        self.assertEqual(check_arguments(project, '## session.launch\n| `rig` | `rig.name` | |\n'), [])
        self.assertIn('rig = rig.name', check_arguments(project, '## session.launch\n| `rig` | `rig` | |\n')[0])
        self.assertIn('the key stretch', check_scene_keys(project, '`mesh/size`')[0])

    def test_reports_a_fitted_key_that_is_not_marked(self):
        self.write('src/session/session_fit.cpp', 'constexpr char kNode[] = "bridge";\nconst Keys kForces = {{kNode, {"limits/force"}}};\n')
        table = '## config/bridge.yaml\n\n| `limits/force` | 3.0 | N | largest; fitted |\n'
        self.assertEqual(check_fitted(Project(self.root), table), [])
        self.assertIn('limits/force is fitted', check_fitted(Project(self.root), table.replace('; fitted', ''))[0])

    def test_reports_a_default_that_is_another(self):
        self.write('README.md', 'The default rig, `sim`, or the default\nrig is `sim`.\n')
        self.assertEqual(check_defaults(Project(self.root)), [])
        self.write('README.md', 'The default rig is `zaber`.\n')
        self.assertEqual(check_defaults(Project(self.root)), ['README.md: the default rig is sim, not zaber'])

    def test_reports_a_number_of_a_scene_that_is_from_nowhere(self):
        told = 'cell:\n  diameter: 56e-6  # m, Table I\n  puncture:        # illustrative\n    force: 1e-6\n    shaft:\n      friction: 2e-6\n'
        (self.root / 'config/cells').mkdir()
        (self.root / 'config/cells/mouse.yaml').write_text(told)
        self.assertEqual([problem.partition(':')[0] for problem in check_origins(Project(self.root))],
                         ['config/cells/mouse.yaml, line 6'])

    def test_finds_documents_that_no_link_leads_to(self):
        self.write('README.md', '[other](doc/guide/other.md)\n')
        self.write('doc/guide/lonely.md', '# Lonely\n')
        self.assertEqual(reachable(Project(self.root)), {'README.md', 'doc/guide/other.md'})


if __name__ == '__main__':
    unittest.main()
