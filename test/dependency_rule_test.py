"""Holds the include lines of src/ to the dependency rule of src/CMakeLists.txt.

A room includes only itself and the rooms that its microinjection_room(... DEPENDS ...) names, directly or in turn; only
src/nodes includes ROS; nothing else includes src/nodes.
"""
import re
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent / 'src'

# Folders of src/ that are programs and not rooms: they may include every room, and no room may include them.
PROGRAMS = {'nodes', 'commands', 'bench', 'paper', 'tools'}
SHARES = {('paper', 'bench')}  # the first may include what the second's programs share
KNOWS_ROS = {'nodes'}

# First folders of the include paths of ROS, of its libraries and of generated messages (ours too).
ROS_FOLDERS = re.compile(
    r'(ros|rosbag|rosconsole|roslib|rospack|rosgraph_msgs|tf|tf2|tf2_\w+|\w+_msgs|std_srvs|cell_microinjection'
    r'|diagnostic_updater|message_filters|topic_tools|actionlib|dynamic_reconfigure|nodelet|pluginlib|class_loader'
    r'|interactive_markers|image_transport|cv_bridge|urdf|kdl_parser|robot_state_publisher|realtime_tools|rviz)/')
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
ROOM = re.compile(r'^\s*microinjection_room\(\s*(\w+)([^)]*)\)', re.MULTILINE)


def read_rooms(cmake_text):
    """Returns {room: set of the rooms it may include, itself among them}, in the order of declaration.

    Raises ValueError for a dependency that is not declared above the room: the order is the house's order.
    """
    allowed = {}
    for name, arguments in ROOM.findall(re.sub(r'#.*', '', cmake_text)):
        depends = re.search(r'\bDEPENDS\b(.*?)(\bLINK\b|$)', arguments, re.DOTALL)
        allowed[name] = {name}
        for dependency in depends.group(1).split() if depends else []:
            if dependency not in allowed:
                raise ValueError(f'room {name} depends on {dependency}, which is not declared above it')
            allowed[name] |= allowed[dependency]
    return allowed


def check_include(folder, target, allowed):
    """Returns what is wrong with a file of src/<folder> that includes <target>, or None."""
    first = target.split('/')[0]
    if ROS_FOLDERS.match(target):
        return None if folder in KNOWS_ROS else 'only src/nodes may include ROS'
    if first in PROGRAMS and '/' in target:
        return None if first == folder or (folder, first) in SHARES else f'nothing includes src/{first}'
    if first in allowed and folder in allowed and first not in allowed[folder]:
        return f'room {folder} may include only {", ".join(sorted(allowed[folder]))}'
    return None


def check_files(source, allowed):
    """Returns a line for every include of a C++ file below `source` that breaks the rule."""
    problems = []
    for path in sorted(source.rglob('*')):
        if path.suffix not in ('.h', '.hpp', '.cpp') or not path.is_file():
            continue
        folder = path.relative_to(source).parts[0]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            target = include.group(1)
            problem = check_include(folder, target, allowed)
            own = f'"{target}"' in line and not ROS_FOLDERS.match(target)
            if not problem and own and not (source / target).is_file():
                problem = 'own files are included as "room/file.h", libraries in angle brackets'
            if problem:
                problems.append(f'{path.relative_to(source)}:{number}: includes {target}: {problem}')
    return problems


def check_source(source):
    """Returns everything below the folder `source` that breaks the rule, a line each."""
    allowed = read_rooms((source / 'CMakeLists.txt').read_text())
    folders = {path.name for path in source.iterdir() if path.is_dir() and not path.name.startswith('__')}
    problems = [f'{name}: a folder of src/ that is no room' for name in sorted(folders - set(allowed) - PROGRAMS)]
    problems += [f'{name}: a room without a folder' for name in sorted(set(allowed) - folders)]
    return problems + check_files(source, allowed)


class TheHouse(unittest.TestCase):
    def test_has_the_rooms_that_everything_stands_on(self):
        rooms = read_rooms((SOURCE / 'CMakeLists.txt').read_text())
        self.assertLessEqual({'base', 'mesh', 'material', 'mechanics', 'contact', 'cell'}, set(rooms))
        self.assertLessEqual({'base', 'mesh', 'material'}, rooms['cell'])

    def test_is_read_include_by_include(self):
        files = list(SOURCE.rglob('*.cpp'))
        self.assertTrue(any(INCLUDE.match(line) for path in files for line in path.read_text().splitlines()))

    def test_keeps_the_dependency_rule(self):
        problems = check_source(SOURCE)
        self.assertFalse(problems, '\n'.join(problems))


class TheRule(unittest.TestCase):
    """Each way to break the rule, in a small house of its own, is reported."""

    CMAKE = ('function(microinjection_room name)\nendfunction()\n# microinjection_room(cellar)\n'
             'microinjection_room(base LINK yaml-cpp)\nmicroinjection_room(mesh DEPENDS base LINK gmsh)\n'
             'microinjection_room(cell\n  DEPENDS mesh\n  LINK Threads::Threads)\nmicroinjection_room(sensor DEPENDS base)\n')

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.source = Path(folder.name)
        self.write('CMakeLists.txt', self.CMAKE)
        for name in ('base/a.h', 'mesh/a.h', 'cell/a.h', 'sensor/a.h', 'nodes/a.h'):
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
        self.write('cell/b.cpp', '#include "cell/a.h"\n\n#include <Eigen/Core>\n#include "mesh/a.h"\n#include "base/a.h"\n')
        self.write('nodes/b.cpp', '#include "nodes/a.h"\n#include <ros/ros.h>\n'
                   '#include "cell/a.h"\n#include "cell_microinjection/CellState.h"\n')
        self.write('commands/b.cpp', '#include "cell/a.h"\n#include "sensor/a.h"\n')
        self.assertEqual(check_source(self.source), [])

    def test_reads_what_each_room_stands_on(self):
        rooms = read_rooms(self.CMAKE)
        self.assertEqual(rooms['cell'], {'cell', 'mesh', 'base'})
        self.assertEqual(rooms['sensor'], {'sensor', 'base'})
        self.assertNotIn('cellar', rooms)

    def test_refuses_a_dependency_on_a_room_above(self):
        with self.assertRaisesRegex(ValueError, 'base depends on mesh'):
            read_rooms('microinjection_room(base DEPENDS mesh)\nmicroinjection_room(mesh)\n')

    def test_reports_an_include_of_a_room_above(self):
        self.assert_reported('base/b.cpp', '#include "mesh/a.h"', 'room base may include only base')

    def test_reports_an_include_of_a_room_beside(self):
        self.assert_reported('sensor/b.h', '#include "mesh/a.h"', 'room sensor may include only base, sensor')

    def test_reports_a_room_in_angle_brackets_and_spaces(self):
        self.assert_reported('base/b.h', '  #  include <cell/a.h>', 'room base may include only base')

    def test_holds_for_a_room_s_own_folders(self):
        self.write('cell/round/a.h', '#include "cell/a.h"\n#include "cell/round/b.h"\n#include "base/a.h"\n')
        self.write('cell/round/b.h', '#include <vector>\n')
        self.assertEqual(check_source(self.source), [])
        self.assert_reported('base/deep/er/b.cpp', '#include "cell/round/a.h"', 'room base may include only base')

    def test_reports_ros_in_a_room_and_in_a_command(self):
        for header in ('ros/ros.h', 'tf2_ros/buffer.h', 'geometry_msgs/PoseStamped.h', 'cell_microinjection/CellState.h',
                       'rosbag/bag.h', 'diagnostic_updater/publisher.h', 'pluginlib/class_list_macros.h'):
            for name in ('cell/b.cpp', 'commands/b.cpp'):
                with self.subTest(header=header, name=name):
                    self.assert_reported(name, f'#include <{header}>', 'only src/nodes may include ROS')
                (self.source / name).unlink()

    def test_reports_an_include_of_the_nodes(self):
        self.assert_reported('cell/b.cpp', '#include "nodes/a.h"', 'nothing includes src/nodes')

    def test_reports_an_include_without_its_room(self):
        self.assert_reported('cell/b.cpp', '#include "a.h"', 'included as "room/file.h"')

    def test_reports_a_folder_that_is_no_room(self):
        self.write('attic/a.h', '')
        self.assertEqual(check_source(self.source), ['attic: a folder of src/ that is no room'])

    def test_reports_a_room_without_a_folder(self):
        self.write('CMakeLists.txt', self.CMAKE + 'microinjection_room(tower DEPENDS cell)\n')
        self.assertEqual(check_source(self.source), ['tower: a room without a folder'])


if __name__ == '__main__':
    unittest.main()
