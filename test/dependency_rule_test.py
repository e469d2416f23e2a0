"""Holds the include lines of src/ and benchmark/ to the dependency rule of src/CMakeLists.txt.

A room includes only itself and the rooms that its microinjection_room(... DEPENDS ...) names, directly or in turn. A
room of one wing never depends on one of another; one without a wing may join them. Only src/nodes includes ROS; nothing else includes src/nodes or
benchmark. benchmark/emulated_haptic is a node and includes both. src/rviz, a plugin of rviz, includes ROS,
rooms, and of src/nodes the bus and what every node uses.
"""
import re
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / 'src'

# Folders that are programs and not rooms: they may include every room, and no room may include them.
PROGRAMS = {'nodes', 'rviz', 'commands', 'tools', 'workflow', 'python', 'benchmark', 'benchmark/emulated_haptic'}
KNOWS_ROS = {'nodes', 'rviz', 'python', 'benchmark/emulated_haptic'}
FOR_THE_CONSOLE = re.compile('nodes/(bus|runtime)/')

# First folders of the include paths of ROS, of its libraries and of generated messages (ours too).
ROS_FOLDERS = re.compile(
    r'(ros|rosbag|rosconsole|roslib|rospack|rosgraph_msgs|tf|tf2|tf2_\w+|\w+_msgs|std_srvs|cell_microinjection'
    r'|diagnostic_updater|message_filters|topic_tools|actionlib|dynamic_reconfigure|nodelet|pluginlib|class_loader'
    r'|interactive_markers|image_transport|cv_bridge|urdf|kdl_parser|robot_state_publisher|realtime_tools|rviz)/')
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
ROOM = re.compile(r'^\s*microinjection_room\(\s*([\w/]+)([^)]*)\)', re.MULTILINE)


def read_rooms(cmake_text):
    """Returns {room: set of the rooms it may include, itself among them}, in the order of declaration.

    Raises ValueError for a dependency that is not declared above the room (the order is the house's order) or that is in
    another wing.
    """
    allowed = {}
    for name, arguments in ROOM.findall(re.sub(r'#.*', '', cmake_text)):
        depends = re.search(r'\bDEPENDS\b(.*?)(\bLINK\b|$)', arguments, re.DOTALL)
        allowed[name] = {name}
        for dependency in depends.group(1).split() if depends else []:
            if dependency not in allowed:
                raise ValueError(f'room {name} depends on {dependency}, which is not declared above it')
            if '/' in name and '/' in dependency and dependency.split('/')[0] != name.split('/')[0]:
                raise ValueError(f'room {name} depends on {dependency}, which is in another wing')
            allowed[name] |= allowed[dependency]
    return allowed


def room_of(path, allowed):
    """Returns the room or the program that a path below src/ belongs to, None for neither."""
    parts = path.split('/')
    names = [name for name in ('/'.join(parts[:2]), parts[0]) if name in allowed or name in PROGRAMS]
    return names[0] if names else None


def check_include(folder, target, allowed):
    """Returns what is wrong with a file of the room <folder> that includes <target>, or None."""
    first = room_of(target, allowed)
    if ROS_FOLDERS.match(target):
        return None if folder in KNOWS_ROS else 'only src/nodes may include ROS'
    if first in PROGRAMS and '/' in target:
        if first == folder or (first == 'nodes' and folder in ('benchmark/emulated_haptic', 'python')):
            return None
        if folder == 'rviz' and first == 'nodes':
            return None if FOR_THE_CONSOLE.match(target) else 'src/rviz includes of src/nodes only bus and runtime'
        return f'nothing includes {"" if first.startswith("benchmark") else "src/"}{first}'
    if first in allowed and folder in allowed and first not in allowed[folder]:
        return f'room {folder} may include only {", ".join(sorted(allowed[folder]))}'
    return None


def check_files(source, allowed):
    """Returns a line for every include of a C++ file below `source`, or of benchmark beside it, that breaks the rule."""
    problems = []
    for path in sorted([*source.rglob('*'), *(source.parent / 'benchmark').rglob('*')]):
        if path.suffix not in ('.h', '.hpp', '.cpp') or not path.is_file():
            continue
        below = path.relative_to(source if source in path.parents else source.parent).as_posix()
        folder = room_of(below, allowed)
        for number, line in enumerate(path.read_text().splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            target = include.group(1)
            problem = check_include(folder, target, allowed)
            # In angle brackets it is a header of rviz itself.
            if f'"{target}"' in line and target.startswith('rviz/') and folder != 'rviz':
                problem = 'nothing includes src/rviz'
            own = f'"{target}"' in line and not ROS_FOLDERS.match(target)
            if not problem and own and not (source / target).is_file() and not (source.parent / target).is_file():
                problem = 'own files are included as "room/file.h", libraries in angle brackets'
            if problem:
                problems.append(f'{below}:{number}: includes {target}: {problem}')
    return problems


def check_source(source):
    """Returns everything below the folder `source` that breaks the rule, a line each."""
    allowed = read_rooms((source / 'CMakeLists.txt').read_text())
    wings = {name.split('/')[0] for name in allowed if '/' in name}
    folders = set()
    for path in [*source.iterdir(), *(room for wing in wings for room in (source / wing).glob('*'))]:
        if path.is_dir() and not path.name.startswith('__') and path.relative_to(source).as_posix() not in wings:
            folders.add(path.relative_to(source).as_posix())
    problems = [f'{name}: a folder of src/ that is no room' for name in sorted(folders - set(allowed) - PROGRAMS)]
    problems += [f'{name}: a room without a folder' for name in sorted(set(allowed) - folders)]
    return problems + check_files(source, allowed)


class TheHouse(unittest.TestCase):
    def test_has_the_rooms_that_everything_stands_on(self):
        rooms = read_rooms((SOURCE / 'CMakeLists.txt').read_text())
        self.assertLessEqual({'base', 'cell/mesh', 'cell/material', 'cell/mechanics', 'cell/model'}, set(rooms))
        self.assertLessEqual({'base', 'cell/mesh', 'cell/material'}, rooms['cell/model'])

    def test_is_read_include_by_include(self):
        files = list(SOURCE.rglob('*.cpp'))
        self.assertTrue(any(INCLUDE.match(line) for path in files for line in path.read_text().splitlines()))

    def test_keeps_the_dependency_rule(self):
        problems = check_source(SOURCE)
        self.assertFalse(problems, '\n'.join(problems))


    def test_installs_what_installed_tools_import(self):
        """A tool finds those beside it also where only the installed ones are."""
        installed = set(re.findall(r'tools/(\w+)\.py', (SOURCE / 'nodes/CMakeLists.txt').read_text(encoding='utf-8')))
        self.assertIn('session_on_hosts', installed)
        tools = {path.stem for path in (SOURCE / 'tools').glob('*.py')}
        for name in sorted(installed):
            text = (SOURCE / 'tools' / f'{name}.py').read_text(encoding='utf-8')
            imported = set(re.findall(r'^\s*(?:import|from) (\w+)', text, re.MULTILINE))
            self.assertEqual((imported & tools) - installed, set(), f'{name}.py imports what is not installed')


class TheRule(unittest.TestCase):
    """Each way to break the rule, in a small house of its own, is reported."""

    CMAKE = ('function(microinjection_room name)\nendfunction()\n# microinjection_room(cellar)\n'
             'microinjection_room(base LINK yaml-cpp)\nmicroinjection_room(cell/mesh DEPENDS base LINK gmsh)\n'
             'microinjection_room(cell/model\n  DEPENDS cell/mesh\n  LINK Threads::Threads)\n'
             'microinjection_room(hardware/sensor DEPENDS base)\n')

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.source = Path(folder.name) / 'src'
        self.write('CMakeLists.txt', self.CMAKE)
        for name in ('base/a.h', 'cell/mesh/a.h', 'cell/model/a.h', 'hardware/sensor/a.h', 'nodes/a.h'):
            self.write(name, '#include <vector>\n')

    def write(self, name, text):
        path = self.source / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def assert_reported(self, name, line, reason):
        self.write(name, f'// first line\n{line}\n')
        problems = check_source(self.source)
        self.assertEqual(len(problems), 1, problems)
        self.assertIn(f'{name}:2', problems[0])
        self.assertIn(reason, problems[0])

    def test_accepts_a_house_in_order(self):
        self.write('cell/model/b.cpp', '#include "cell/model/a.h"\n\n#include <Eigen/Core>\n#include "cell/mesh/a.h"\n#include "base/a.h"\n')
        self.write('nodes/b.cpp', '#include "nodes/a.h"\n#include <ros/ros.h>\n'
                   '#include "cell/model/a.h"\n#include "cell_microinjection/CellState.h"\n')
        self.write('commands/b.cpp', '#include "cell/model/a.h"\n#include "hardware/sensor/a.h"\n')
        self.assertEqual(check_source(self.source), [])

    def test_reads_what_each_room_stands_on(self):
        rooms = read_rooms(self.CMAKE)
        self.assertEqual(rooms['cell/model'], {'cell/model', 'cell/mesh', 'base'})
        self.assertEqual(rooms['hardware/sensor'], {'hardware/sensor', 'base'})
        self.assertNotIn('cellar', rooms)

    def test_refuses_a_dependency_on_a_room_above(self):
        with self.assertRaisesRegex(ValueError, 'base depends on mesh'):
            read_rooms('microinjection_room(base DEPENDS mesh)\nmicroinjection_room(mesh)\n')

    def test_refuses_a_dependency_on_another_wing(self):
        with self.assertRaisesRegex(ValueError, 'hardware/sensor depends on cell/mesh, which is in another wing'):
            read_rooms('microinjection_room(cell/mesh)\nmicroinjection_room(hardware/sensor DEPENDS cell/mesh)\n')

    def test_reports_an_include_of_a_room_above(self):
        self.assert_reported('base/b.cpp', '#include "cell/mesh/a.h"', 'room base may include only base')

    def test_reports_an_include_of_a_room_beside(self):
        self.assert_reported('hardware/sensor/b.h', '#include "cell/mesh/a.h"', 'room hardware/sensor may include only base, hardware/sensor')

    def test_reports_a_room_in_angle_brackets_and_spaces(self):
        self.assert_reported('base/b.h', '  #  include <cell/model/a.h>', 'room base may include only base')

    def test_holds_for_a_room_s_own_folders(self):
        self.write('cell/model/round/a.h', '#include "cell/model/a.h"\n#include "cell/model/round/b.h"\n#include "base/a.h"\n')
        self.write('cell/model/round/b.h', '#include <vector>\n')
        self.assertEqual(check_source(self.source), [])
        self.assert_reported('base/deep/er/b.cpp', '#include "cell/model/round/a.h"', 'room base may include only base')

    def test_reports_ros_in_a_room_and_in_a_command(self):
        for header in ('ros/ros.h', 'tf2_ros/buffer.h', 'geometry_msgs/PoseStamped.h', 'cell_microinjection/CellState.h',
                       'rosbag/bag.h', 'diagnostic_updater/publisher.h', 'pluginlib/class_list_macros.h'):
            for name in ('cell/model/b.cpp', 'commands/b.cpp'):
                with self.subTest(header=header, name=name):
                    self.assert_reported(name, f'#include <{header}>', 'only src/nodes may include ROS')
                (self.source / name).unlink()

    def test_holds_for_the_plugin_of_rviz(self):
        self.write('rviz/b.cpp', '#include "rviz/b.h"\n#include <rviz/panel.h>\n#include "cell/model/a.h"\n#include "nodes/bus/a.h"\n')
        self.write('nodes/bus/a.h', '')
        self.assertEqual(check_source(self.source), [])
        for line, reason in (('#include "nodes/a.h"', 'only bus and runtime'),
                             ('#include "mesh.h"', 'included as "room/file.h"')):
            with self.subTest(line=line):
                self.assert_reported('rviz/c.cpp', line, reason)
        (self.source / 'rviz/c.cpp').unlink()
        self.assert_reported('nodes/b.cpp', '#include "rviz/b.h"', 'nothing includes src/rviz')

    def test_reports_an_include_of_the_nodes(self):
        self.assert_reported('cell/model/b.cpp', '#include "nodes/a.h"', 'nothing includes src/nodes')

    def test_holds_for_the_benchmarks(self):
        self.write('../benchmark/a.h', '#include "cell/model/a.h"\n')
        self.write('../benchmark/a.cpp', '#include "benchmark/a.h"\n')
        self.assertEqual(check_source(self.source), [])
        self.assert_reported('cell/model/b.cpp', '#include "benchmark/a.h"', 'nothing includes benchmark')

    def test_holds_for_the_node_of_the_benchmarks(self):
        self.write('../benchmark/emulated_haptic/a.h', '#include "nodes/a.h"\n#include <ros/ros.h>\n')
        self.write('../benchmark/emulated_haptic/a.cpp', '#include "benchmark/emulated_haptic/a.h"\n')
        self.assertEqual(check_source(self.source), [])
        self.write('../benchmark/a.cpp', '#include <ros/ros.h>\n')
        self.assertIn('only src/nodes may include ROS', check_source(self.source)[0])
        self.write('../benchmark/a.cpp', '#include "nodes/a.h"\n')
        self.assertIn('nothing includes src/nodes', check_source(self.source)[0])
        (self.source / '../benchmark/a.cpp').unlink()
        self.assert_reported('nodes/b.cpp', '#include "benchmark/emulated_haptic/a.h"',
                             'nothing includes benchmark/emulated_haptic')

    def test_reports_an_include_without_its_room(self):
        self.assert_reported('cell/model/b.cpp', '#include "a.h"', 'included as "room/file.h"')

    def test_reports_a_folder_that_is_no_room(self):
        self.write('attic/a.h', '')
        self.write('cell/attic/a.h', '')
        self.assertEqual(check_source(self.source), ['attic: a folder of src/ that is no room',
                                                     'cell/attic: a folder of src/ that is no room'])

    def test_reports_a_room_without_a_folder(self):
        self.write('CMakeLists.txt', self.CMAKE + 'microinjection_room(tower DEPENDS base)\n')
        self.assertEqual(check_source(self.source), ['tower: a room without a folder'])


if __name__ == '__main__':
    unittest.main()
