#!/usr/bin/python3
"""The recorder's rows are on disk while the session runs; a full disk is reported and does not end it; at the end one
file that cannot be written hides no other."""

import csv
import pathlib
import resource
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped

from cell_microinjection.msg import CellState, InjectionStatus
from killable_nodes import PATIENCE, PROGRAMS, KillableNodes, parameters
from messages import pose, wrench
from participant import Participant

ERROR = 2  # level of diagnostics
OUTPUTS = {"/needle/measured_cp": PoseStamped, "/cell/predicted_cf": WrenchStamped,
           "/force_sensor/measured_cf": WrenchStamped, "/cell/state": CellState,
           "/controller/injection_state": InjectionStatus}
PERIOD, LATE = 0.005, 0.06  # s between rows; s that the newest row may be old, of which 0.05 are the patience


class RecorderTest(unittest.TestCase):
    def begin(self, **settings):
        """A session with the recorder in a folder of its own."""
        rospy.set_param("/session_recorder", {"output_dir": str(self.out), "row_period": PERIOD, "hand": False,
                                              "injector": False, **settings})
        self.nodes = KillableNodes({"lockstep_clock": {}}, [rospy.get_name(), "/session_recorder"])
        self.said = tempfile.TemporaryFile()
        # A file that may grow no more is then an error to it, as a full disk is, and no signal.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        self.recorder = subprocess.Popen([PROGRAMS / "session_recorder"], stdin=subprocess.DEVNULL, stdout=self.said,
                                         stderr=subprocess.STDOUT, restore_signals=False)
        self.world = Participant(OUTPUTS, {}, PATIENCE)

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name) / "out"
        self.world = self.nodes = self.recorder = None

    def tearDown(self):
        if self.recorder and self.recorder.poll() is None:
            self.recorder.kill()
            self.recorder.wait(PATIENCE)
        if self.world:
            self.world.close()
        if self.nodes:
            self.nodes.stop()
            self.nodes.forget()
        rospy.delete_param("/session_recorder")
        self.folder.cleanup()

    def messages(self):
        # The height tells the time, and no two messages are alike.
        return {"/needle/measured_cp": pose(0, 0, 1e-6 * self.world.now.to_sec()),
                "/cell/predicted_cf": wrench(0, 0, 1e-6), "/force_sensor/measured_cf": wrench(0, 0, 1e-6)}

    def run_for(self, seconds):
        self.world.run(round(seconds * 1e3), self.messages)

    def status_after(self, seconds):
        """(level, text) of diagnostics that are of later: they come once a second over a connection of their own."""
        return self.world.run_to_status("session_recorder: files", round(seconds * 1e3), self.messages)

    def end(self):
        """@returns exit status and what it said."""
        self.recorder.send_signal(signal.SIGINT)
        status = self.recorder.wait(PATIENCE)
        self.said.seek(0)
        return status, self.said.read().decode()

    def rows(self, name):
        text = (self.out / name).read_text()
        self.assertTrue(text.endswith("\n"))
        rows = list(csv.DictReader(text.splitlines()))
        for row in rows:
            self.assertNotIn(None, (*row.keys(), *row.values()), f"a row that is cut: {row}")
        return rows

    def values(self):
        return {pair.key: int(pair.value) for pair in self.world.diagnostics["session_recorder: files"].values}

    def grow_to(self, size):
        """Files of the recorder get no larger (bytes; None: any size)."""
        hard = resource.prlimit(self.recorder.pid, resource.RLIMIT_FSIZE)[1]
        resource.prlimit(self.recorder.pid, resource.RLIMIT_FSIZE, (hard if size is None else size, hard))

    def test_killed_it_leaves_the_rows_until_then(self):
        self.begin(bag=False)
        self.run_for(1.5)
        self.recorder.kill()
        self.assertEqual(self.recorder.wait(PATIENCE), -signal.SIGKILL)
        rows = self.rows("force_depth.csv.active")
        times = [float(row["time_s"]) for row in rows]
        self.assertEqual(times[0], 0)
        self.assertGreater(times[-1], 1.5 - LATE)
        self.assertEqual(len(rows), round(times[-1] / PERIOD) + 1)
        self.assertTrue(rows[-1]["tip_z_m"], f"{rows[:3]} {rows[-3:]}")
        self.assertFalse((self.out / "force_depth.csv").exists())

    def test_a_full_disk_is_reported_and_the_session_goes_on(self):
        self.begin(bag=True)
        self.run_for(0.5)
        before = (self.out / "force_depth.csv.active").stat().st_size
        self.grow_to(before + 1000)
        level, text = self.status_after(4)
        self.assertEqual(level, ERROR)
        for name in ("force_depth.csv.active", "session.bag.active"):
            self.assertIn(f"{self.out}/{name}: cannot be written: ", text)
        self.assertIn("File too large", text)
        self.assertIsNone(self.recorder.poll())
        lost = self.values()["rows lost"]
        self.assertGreater(lost, 550)  # of the 800 of this time
        self.grow_to(None)
        self.status_after(2.2)
        later = self.values()
        self.assertLess(later["rows lost"] - lost, 210, "at most those of one more second, which are written together")
        level, text = self.status_after(1)
        self.assertEqual(self.values()["rows lost"], later["rows lost"])
        self.assertGreater(self.values()["rows written"], later["rows written"] + 150)
        self.assertEqual(level, ERROR, "the bag is not whole")
        self.assertNotIn("force_depth.csv.active", text)
        status, said = self.end()
        self.assertEqual(status, 1, said)
        self.assertEqual(said.count("force_depth.csv.active: cannot be written"), 1, said)  # in the log, once
        self.assertIn(f"{self.out}/force_depth.csv: {later['rows lost']} rows are lost: File too large", said)
        self.assertIn(f"{self.out}/session.bag.active: cannot be written: ", said)
        rows = self.rows("force_depth.csv")
        self.assertEqual(len(rows), round(float(rows[-1]["time_s"]) / PERIOD) + 1 - later["rows lost"])
        self.assertTrue((self.out / "summary.yaml").is_file())

    def test_a_file_that_cannot_be_written_hides_no_other(self):
        for name in ("summary.yaml", "training.yaml"):
            (self.out / name).mkdir(parents=True)
        self.begin(bag=True, training=parameters("training", operator="ada", history=str(self.out / "history.csv")))
        self.run_for(0.5)
        status, said = self.end()
        self.assertEqual(status, 1, said)
        for name in ("summary.yaml", "training.yaml"):
            self.assertIn(f"{self.out}/{name}: cannot be written: ", said)
        self.assertGreater(len(self.rows("force_depth.csv")), 80)
        self.assertGreater((self.out / "session.bag").stat().st_size, 0)
        self.assertEqual(list(self.out.glob("*.active")), [])

    def test_where_nothing_is_wrong_nothing_is_said(self):
        self.begin(bag=True)
        self.assertEqual(self.status_after(1.5), (0, "the session is written"))
        status, said = self.end()
        self.assertEqual(status, 0, said)
        self.assertEqual(sorted(path.name for path in self.out.iterdir()),
                         ["force_depth.csv", "session.bag", "summary.yaml"])


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "recorder", RecorderTest)
