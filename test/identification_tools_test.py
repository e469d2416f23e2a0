"""curve_from_bag.py makes the table that identify reads, plot_residuals.py a picture of the table that it writes."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib.image
import numpy
import rosbag
import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped

TOOLS = Path(__file__).resolve().parents[1] / 'src/tools'
RESIDUALS = Path(__file__).resolve().parents[1] / 'src/commands/identify.cpp'
SPEED = 20e-6  # m/s
TILT = 0.3  # rad, of the needle about y


class ToolsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_tool(self, tool, *arguments):
        return subprocess.run([sys.executable, TOOLS / tool, *map(str, arguments)], capture_output=True, text=True, check=False)

    def bag(self, frame='needle_tip', poses=True):
        """A tilted needle that moves along its axis; its force in nN is the time in ms, its depth known at half the rate."""
        path = self.folder / 'session.bag'
        axis = numpy.array([numpy.sin(TILT), 0, numpy.cos(TILT)])
        with rosbag.Bag(str(path), 'w') as bag:
            for k in range(200):
                time = rospy.Time.from_sec(100 + 1e-3 * k)
                wrench = WrenchStamped()
                wrench.header.stamp, wrench.header.frame_id = time, frame
                wrench.wrench.force.z = 1e-9 * k
                bag.write('/force_sensor/measured_cf', wrench, time)
                if k % 2 or not poses:
                    continue
                pose = PoseStamped()
                pose.header.stamp = time
                place = axis * (30e-6 - SPEED * 1e-3 * k)
                pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = place
                pose.pose.orientation.y, pose.pose.orientation.w = numpy.sin(TILT / 2), numpy.cos(TILT / 2)
                bag.write('/needle/measured_cp', pose, time)
            broken = WrenchStamped()
            broken.header.stamp, broken.header.frame_id = rospy.Time.from_sec(100.1005), frame
            broken.wrench.force.z = float('nan')
            bag.write('/force_sensor/measured_cf', broken, rospy.Time.from_sec(100.1005))
            invalid = WrenchStamped()
            invalid.wrench.force.z = 1
            bag.write('/force_sensor/measured_cf', invalid, rospy.Time(101))
        return path

    def test_a_curve_along_the_pipette(self):
        done = self.run_tool('curve_from_bag.py', self.bag(), '--from', '0.0495')
        self.assertEqual(done.returncode, 0, done.stderr)
        table = numpy.genfromtxt(self.folder / 'session.csv', delimiter=',', names=True)
        self.assertEqual(table.dtype.names, ('time_s', 'position_m', 'force_N'))
        self.assertEqual(len(table), 148)  # the first force is before the first position is passed, the last after the last
        numpy.testing.assert_allclose(table['force_N'], 1e-6 * (table['time_s'] + 1e-3), atol=1e-15)
        numpy.testing.assert_allclose(table['position_m'], SPEED * (table['time_s'] + 1e-3) - 30e-6, atol=1e-12)

    def test_says_what_a_bag_lacks(self):
        for more, why in (({'frame': 'camera'}, "frame 'camera': must be needle_tip"),
                          ({'poses': False}, 'no valid message on /needle/measured_cp')):
            done = self.run_tool('curve_from_bag.py', self.bag(**more))
            self.assertEqual(done.returncode, 2)
            self.assertIn(why, done.stderr)
        text = self.folder / 'text.bag'
        text.write_text('no bag')
        done = self.run_tool('curve_from_bag.py', text)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_a_picture_of_the_residuals(self):
        header = RESIDUALS.read_text().split('std::string table = "')[1].split('\\n')[0]
        depth = numpy.linspace(-2e-6, 5e-6, 300)
        fitted = 1e-8 * numpy.clip(depth / 1e-6, 0, None) ** 1.5
        residual = 1e-9 * numpy.sin(1e6 * depth)
        rows = [','.join(f'{value:.9g}' for value in (0, *row)) for row in zip(depth, fitted + residual, fitted, residual)]
        table = self.folder / 'residuals.csv'
        table.write_text('\n'.join((header, *rows)) + '\n')
        done = self.run_tool('plot_residuals.py', table)
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = matplotlib.image.imread(self.folder / 'residuals.png')
        self.assertGreater(numpy.ptp(picture[..., :3]), 0.5)
        table.write_text('a,b\n1,2\n')
        done = self.run_tool('plot_residuals.py', table)
        self.assertEqual(done.returncode, 2)
        self.assertIn('it has no column depth_m', done.stderr)


if __name__ == '__main__':
    unittest.main()
