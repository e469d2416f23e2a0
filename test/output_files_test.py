"""No tool of src/tools that makes a file of a file replaces the one by the other."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parent.parent / 'src' / 'tools'
sys.path.insert(0, str(TOOLS))
from output_files import check_outputs  # noqa: E402

# Tool, and its arguments for a file that is read and one that is written.
CALLS = {
    'curve_from_bag.py': ('{0}', '--out', '{1}'),
    'injection_report.py': ('{0}', '--out', '{1}'),
    'plot_residuals.py': ('{0}', '--out', '{1}'),
    'plot_training.py': ('{0}', '{1}'),
    'plot_force_depth.py': ('{0}', '{1}'),
    'plot_tongue.py': ('--scene', '{0}', '--out', '{1}'),
}


class OutputFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.measured = self.folder / 'measured.csv'
        self.measured.write_text('time_s,position_m,force_N\n0,1e-6,2e-9\n')

    def test_each_tool_leaves_its_input(self):
        before = self.measured.read_text()
        link = self.folder / 'link.csv'
        link.symlink_to(self.measured)
        for tool, arguments in CALLS.items():
            for out in (self.measured, self.folder / '..' / self.folder.name / 'measured.csv', link):
                with self.subTest(tool=tool, out=out):
                    call = [argument.format(self.measured, out) for argument in arguments]
                    done = subprocess.run([sys.executable, str(TOOLS / tool), *call], stdout=subprocess.DEVNULL,
                                          stderr=subprocess.PIPE, text=True)
                    self.assertNotEqual(done.returncode, 0)
                    self.assertIn('must be another file than', done.stderr)
                    self.assertEqual(self.measured.read_text(), before)

    def test_all_tools_that_write_pictures_or_tables_ask(self):
        for path in TOOLS.glob('*.py'):
            text = path.read_text()
            if 'add_argument(' in text and ('savefig(png' in text or 'savefig(path' in text or 'savetxt(out' in text or 'out.write_text(' in text):
                self.assertIn(path.name, CALLS)

    def test_what_cannot_be_written_is_refused(self):
        for out in (self.folder, self.measured / 'below.csv'):
            with self.assertRaisesRegex(ValueError, 'cannot be written'):
                check_outputs({}, {'--out': out})
        with self.assertRaisesRegex(ValueError, '--b = .* than --a, which is written, too'):
            check_outputs({}, {'--a': self.folder / 'x', '--b': self.folder / 'y' / '..' / 'x'})

    def test_what_is_new_is_taken_and_its_folder_made(self):
        check_outputs({'CSV': self.measured, 'none': None}, {'--out': self.folder / 'new' / 'a.png'})
        self.assertEqual(os.listdir(self.folder / 'new'), [])


if __name__ == '__main__':
    unittest.main()
