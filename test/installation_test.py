#!/usr/bin/python3
"""What a user starts is complete and finds its interpreter: ./dev installs aside and swaps, and only when something has
changed; each tool has the system's Python, whatever python3 comes first on the PATH."""

import os
import pathlib
import re
import stat
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROJECT = """cmake_minimum_required(VERSION 3.10)
project(small NONE)
install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/../config DESTINATION share)
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/../package.xml DESTINATION share)
"""
INSTALL = """set -euo pipefail
ROOT=%s
say() { echo "$*"; }
fail() { echo "dev: $*" >&2; exit 1; }
source %s/src/tools/dev/build.sh
install_workspace
"""


class SmallWorkspace:
    """A workspace whose build installs two folders, and ./dev's own way to install it."""

    def __init__(self, folder):
        self.root = pathlib.Path(folder).resolve()
        for name in ('launch', 'config', 'urdf', 'msg', 'srv', 'action', 'src/tools', 'small', 'catkin_ws/devel/lib'):
            (self.root / name).mkdir(parents=True)
        (self.root / 'package.xml').write_text('<package/>')
        self.write('config/a.yaml', 'a: 1')
        self.write('config/b.yaml', 'b: 1')
        (self.root / 'small/CMakeLists.txt').write_text(PROJECT)
        self.install_folder = self.root / 'catkin_ws/install'
        subprocess.run(['cmake', '-S', self.root / 'small', '-B', self.root / 'catkin_ws/build',
                        f'-DCMAKE_INSTALL_PREFIX={self.install_folder}'], check=True, capture_output=True)
        self.write('config/a.yaml', 'a: 1')

    def write(self, name, text):
        """CMake compares times by the second, so each text gets one of its own."""
        path = self.root / name
        self.time = getattr(self, 'time', 1.0e9) + 10
        path.write_text(text)
        os.utime(path, (self.time, self.time))

    def touch_now(self, name):
        os.utime(self.root / name)

    def install(self, **environment):
        return subprocess.run(['bash', '-c', INSTALL % (self.root, ROOT)], capture_output=True, text=True,
                              env={**os.environ, **environment})

    def installed(self):
        return {str(path.relative_to(self.install_folder)): path.read_text()
                for path in self.install_folder.rglob('*') if path.is_file()}


class InstallationTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.workspace = SmallWorkspace(folder.name)
        done = self.workspace.install()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.workspace.installed()['share/config/a.yaml'], 'a: 1')

    def change(self, text):
        """In a later second, and newer than the installation."""
        path = self.workspace.root / 'config/a.yaml'
        path.write_text(text)
        later = (self.workspace.install_folder / '.complete').stat().st_mtime + 100
        os.utime(path, (later, later))

    def test_nothing_is_installed_when_nothing_has_changed(self):
        complete = (self.workspace.install_folder / '.complete').stat()
        done = self.workspace.install(PATH=os.environ['PATH'])
        self.assertEqual((done.returncode, done.stdout), (0, ''))
        self.assertEqual((self.workspace.install_folder / '.complete').stat().st_ino, complete.st_ino)

    def test_a_change_arrives_and_what_was_removed_goes(self):
        self.change('a: 2')
        (self.workspace.root / 'config/b.yaml').unlink()
        done = self.workspace.install()
        self.assertEqual(done.returncode, 0, done.stderr)
        installed = self.workspace.installed()
        self.assertEqual(installed['share/config/a.yaml'], 'a: 2')
        self.assertNotIn('share/config/b.yaml', installed)
        self.assertEqual(sorted(path.name for path in (self.workspace.root / 'catkin_ws').iterdir()),
                         ['build', 'devel', 'install'])

    def test_an_installation_that_is_broken_off_changes_nothing(self):
        before = self.workspace.installed()
        self.change('a: 2')
        with tempfile.TemporaryDirectory() as folder:
            # Installs, and is killed with the whole script before it is told.
            fake = pathlib.Path(folder) / 'cmake'
            fake.write_text('#!/bin/sh\n/usr/bin/cmake "$@"\nkill -9 $PPID\n')
            fake.chmod(0o755)
            self.assertEqual(self.workspace.install(PATH=f'{folder}:{os.environ["PATH"]}').returncode, -9)
        self.assertEqual(self.workspace.installed(), before)
        self.assertEqual(self.workspace.install().returncode, 0)
        self.assertEqual(self.workspace.installed()['share/config/a.yaml'], 'a: 2')

    def test_a_swap_that_was_broken_off_is_mended(self):
        self.workspace.install_folder.rename(self.workspace.root / 'catkin_ws/.install.old')
        self.assertEqual(self.workspace.install().returncode, 0)
        self.assertEqual(self.workspace.installed()['share/config/a.yaml'], 'a: 1')


class InterpreterTest(unittest.TestCase):
    def scripts(self):
        for folder in ('src', 'test', 'benchmark'):
            for path in (ROOT / folder).rglob('*.py'):
                first = path.read_text(encoding='utf-8').split('\n', 1)[0]
                if first.startswith('#!'):
                    yield path, first

    def test_each_script_names_the_systems_interpreter(self):
        scripts = list(self.scripts())
        self.assertGreater(len(scripts), 30)
        self.assertEqual([str(path) for path, first in scripts if first != '#!/usr/bin/python3'], [])

    def test_no_program_starts_python_by_the_path(self):
        start = re.compile(r'''(?:^|[\s;&|(])(?:exec |env )?python3? +["$./\w-]*\.py|["']python3?["'],''')
        found = []
        for folder, suffixes in (('src', ('.cpp', '.h', '.sh', '.py', '.smk')), ('launch', ('.launch',))):
            for path in (ROOT / folder).rglob('*'):
                if path.suffix in suffixes:
                    lines = path.read_text(encoding='utf-8').splitlines()
                    found += [f'{path}: {line}' for line in lines if start.search(line) and './dev shell' not in line]
        self.assertEqual(found, [])

    def test_a_tool_runs_with_another_python_first_on_the_path(self):
        with tempfile.TemporaryDirectory() as folder:
            other = pathlib.Path(folder) / 'python3'
            other.write_text('#!/bin/sh\necho "another python3 was started" >&2\nexit 9\n')
            other.chmod(other.stat().st_mode | stat.S_IXUSR)
            for name in ('plot_training.py', 'plot_force_depth.py', 'plot_residuals.py', 'injection_report.py'):
                with self.subTest(name):
                    done = subprocess.run([ROOT / 'src/tools' / name, '--help'], capture_output=True, text=True,
                                          env={**os.environ, 'PATH': f'{folder}:{os.environ["PATH"]}'})
                    self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == '__main__':
    unittest.main()
