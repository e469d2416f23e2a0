#!/usr/bin/python3
"""The recorder's process is killed: its rows are on disk. Its disk is full: it says so, and the session goes on. That all
files are complete at the end is in test/nodes/session/recorder_test.cpp."""

import csv
import pathlib
import resource
import signal
import subprocess
import tempfile
import threading
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped

from killable_nodes import PATIENCE, PROGRAMS
from live_chain import until
from messages import pose, wrench

ERROR = 2  # level of diagnostics
PERIOD = 0.005  # s between rows
DELAY = 2.0  # s after which the recorder writes a row: its patience for late messages
RATE = 200  # Hz, of the messages
FILES = "session_recorder: files"


class World:
    """The nodes of a session. The needle's height tells the time of its message: um for s since the beginning."""

    def __init__(self):
        self._publishers = {"/needle/measured_cp": PoseStamped, "/cell/predicted_cf": WrenchStamped,
                            "/force_sensor/measured_cf": WrenchStamped}
        self._publishers = {topic: rospy.Publisher(topic, kind, queue_size=100) for topic, kind in self._publishers.items()}
        self._begin = rospy.Time.now()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def age(self):
        """s since the beginning."""
        return (rospy.Time.now() - self._begin).to_sec()

    def _run(self):
        while not self._ended.wait(1 / RATE):
            now = rospy.Time.now()
            messages = (pose(0, 0, 1e-6 * (now - self._begin).to_sec()), wrench(0, 0, 1e-6), wrench(0, 0, 1e-6))
            for publisher, message in zip(self._publishers.values(), messages):
                message.header.stamp = now
                publisher.publish(message)

    def end(self):
        self._ended.set()
        self._thread.join()
        for publisher in self._publishers.values():
            publisher.unregister()


class RecorderTest(unittest.TestCase):
    def begin(self, **settings):
        """The recorder in a folder of its own."""
        rospy.set_param("/session_recorder", {"output_dir": str(self.out), "row_period": PERIOD, "hand": False,
                                              "injector": False, "diagnostic_period": 0.2, **settings})
        # A file that may grow no more is then an error to it, as a full disk is, and no signal.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        self.recorder = subprocess.Popen([PROGRAMS / "session_recorder"], stdin=subprocess.DEVNULL, stdout=self.said,
                                         stderr=subprocess.STDOUT, restore_signals=False)
        self.addCleanup(self.kill)
        self.world = World()
        self.addCleanup(self.world.end)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "out"
        self.said = tempfile.TemporaryFile()
        self.statuses = []
        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self.on_diagnostics)
        self.addCleanup(subscriber.unregister)

    def on_diagnostics(self, message):
        self.statuses += [status for status in message.status if status.name == FILES]

    def kill(self):
        self.recorder.kill()
        return self.recorder.wait(PATIENCE)

    def end(self):
        """@returns exit status and what it said."""
        self.recorder.send_signal(signal.SIGINT)
        status = self.recorder.wait(PATIENCE)
        self.said.seek(0)
        return status, self.said.read().decode()

    def rows(self, name):
        """All of a table, of whole rows."""
        text = (self.out / name).read_text()
        self.assertTrue(text.endswith("\n"))
        rows = list(csv.DictReader(text.splitlines()))
        for row in rows:
            self.assertNotIn(None, (*row.keys(), *row.values()), f"a row that is cut: {row}")
        return rows

    def newest_on_disk(self):
        """s after the beginning of the newest row that is on disk by now; nothing of its file is read twice as it grows."""
        path = self.out / "force_depth.csv.active"
        lines = path.read_text().split("\n")[:-1] if path.exists() else []
        rows = [row for row in csv.DictReader(lines) if row["tip_z_m"]]
        return 1e6 * float(rows[-1]["tip_z_m"]) if rows else 0.0

    def values(self):
        return {pair.key: int(pair.value) for pair in self.statuses[-1].values}

    def status(self, condition, what):
        """The first status from now on for which condition() is true."""
        begin = len(self.statuses)
        until(lambda: len(self.statuses) > begin and condition(), what)
        return self.statuses[-1]

    def grow_to(self, size):
        """Files of the recorder get no larger (bytes; None: any size)."""
        hard = resource.prlimit(self.recorder.pid, resource.RLIMIT_FSIZE)[1]
        resource.prlimit(self.recorder.pid, resource.RLIMIT_FSIZE, (hard if size is None else size, hard))

    def test_killed_it_leaves_the_rows_until_then(self):
        self.begin(bag=False)
        until(lambda: self.newest_on_disk() > 1.0, "rows on disk")
        until(lambda: self.newest_on_disk() > self.world.age() - DELAY - 0.2, "rows that are as new as they can be")
        newest = self.newest_on_disk()
        self.assertEqual(self.kill(), -signal.SIGKILL)
        rows = self.rows("force_depth.csv.active")
        times = [float(row["time_s"]) for row in rows]
        self.assertEqual(times[0], 0)
        self.assertEqual(len(rows), round(times[-1] / PERIOD) + 1)
        self.assertGreaterEqual(self.newest_on_disk(), newest)
        self.assertFalse((self.out / "force_depth.csv").exists())

    def test_a_full_disk_is_reported_and_the_session_goes_on(self):
        self.begin(bag=True)
        until(lambda: self.newest_on_disk() > 0.5, "rows on disk")
        self.grow_to((self.out / "force_depth.csv.active").stat().st_size + 1000)
        names = ("force_depth.csv.active", "session.bag.active")
        status = self.status(lambda: all(name in self.statuses[-1].message for name in names), "what cannot be written")
        self.assertEqual(status.level, ERROR)
        for name in names:
            self.assertIn(f"{self.out}/{name}: cannot be written: ", status.message)
        self.assertIn("File too large", status.message)
        self.status(lambda: self.values()["rows lost"] > 500, "rows that are lost")
        self.assertIsNone(self.recorder.poll())
        self.grow_to(None)
        # No row is lost any more, while many are written.
        before = {}

        def are_written():
            now = self.values()
            if now["rows lost"] != before.get("rows lost"):
                before.update(now)
            return now["rows written"] > before["rows written"] + 200
        status = self.status(are_written, "rows that are written again")
        lost = before["rows lost"]
        self.assertEqual(status.level, ERROR, "the bag is not whole")
        self.assertNotIn("force_depth.csv.active", status.message)
        status, said = self.end()
        self.assertEqual(status, 1, said)
        self.assertEqual(said.count("force_depth.csv.active: cannot be written"), 1, said)  # in the log, once
        self.assertIn(f"{self.out}/force_depth.csv: {lost} rows are lost: File too large", said)
        self.assertIn(f"{self.out}/session.bag.active: cannot be written: ", said)
        rows = self.rows("force_depth.csv")
        self.assertEqual(len(rows), round(float(rows[-1]["time_s"]) / PERIOD) + 1 - lost)
        self.assertTrue((self.out / "summary.yaml").is_file())


if __name__ == "__main__":
    rospy.init_node("world")
    rostest.rosrun("cell_microinjection", "recorder", RecorderTest)
