#!/usr/bin/python3
"""One whole session live: the virtual hand indents a cell, punctures it, injects and retracts; the session records all, scores
the trainee, and ends by itself. What a session does to the last bit is in test/nodes/session, on virtual time."""

import csv
import pathlib
import subprocess
import tempfile
import unittest

import rospy
import rostest
import yaml

RATE = 200  # Hz: not each machine keeps 1 kHz
PATIENCE = 300  # s of wall time; only a session that hangs takes that long
NO_SESSION = 3  # exit status of why
# Of the hand: phase, s, m, clutch.
PATH = [("approach", 1.0, -19.2e-3, False), ("approach", 0.2, -19.2e-3, True), ("approach", 0.8, 0.0, True),
        ("approach", 0.2, 0.0, False), ("approach", 1.0, -10.8e-3, False), ("touch", 0.8, -13.8e-3, False),
        ("indent", 1.5, -24.8e-3, False), ("hold", 0.3, -24.8e-3, False), ("puncture", 1.5, -36.8e-3, False),
        ("puncture", 0.5, -36.8e-3, False), ("inject", 1.0, -36.8e-3, False), ("retract", 2.0, -10.8e-3, False),
        ("retract", 0.5, 0.0, False)]
PHASES = {phase for phase, *_ in PATH}
# s, in place of the time-outs: a machine that stalls must hold neither hand nor needle.
PATIENT = {"haptic_bridge": {"timeouts": {key: 1.0 for key in ("hand", "needle", "predicted", "measured", "controller")}},
           "injection_controller": {"input_timeout": 1.0}, "micromanipulator": {"command_timeout": 1.0},
           "cell_simulator": {"needle_timeout": 1.0}, "force_sensor": {"input_timeout": 1.0}, "virtual_hand": {"force_timeout": 1.0},
           "injector": {"command_timeout": 5.0, "pulse_timeout": 2.0}}
TOPICS = {"/needle/measured_cp", "/haptic/measured_cp", "/haptic/servo_cf", "/cell/predicted_cf", "/force_sensor/measured_cf",
          "/controller/injection_state", "/injector/state"}


class SessionLiveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.out = cls.folder / "out"
        motion = cls.folder / "motion.yaml"
        motion.write_text(yaml.safe_dump({"path": [dict(zip(("phase", "duration", "z", "clutch"), waypoint))
                                                   for waypoint in PATH]}))
        session = cls.folder / "session.yaml"
        session.write_text(yaml.safe_dump({
            "version": 1, "cell": "mouse_oocyte_injection", "hand": {"device": "virtual_hand", "motion": "motion.yaml"},
            "display": {"markers": False}, "rate": RATE, "overrides": PATIENT,
            "record": {"folder": str(cls.out), "end_when_done": True, "trainee": "ada", "history": "history.csv"}}))
        launched = subprocess.Popen(["roslaunch", "cell_microinjection", "session.launch", f"session:={session}"],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        cls.addClassCleanup(launched.kill)
        cls.before = cls.why()
        cls.during = cls.before
        while cls.during.returncode == NO_SESSION and launched.poll() is None:
            cls.during = cls.why()
        cls.said, _ = launched.communicate(timeout=PATIENCE)
        cls.status = launched.returncode

    @staticmethod
    def why():
        return subprocess.run(["rosrun", "cell_microinjection", "why"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=PATIENCE)

    def setUp(self):
        self.assertEqual(self.status, 0, self.said)

    def rows(self):
        with open(self.out / "force_depth.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def told(self, name):
        return yaml.safe_load((self.out / name).read_text(encoding="utf-8"))

    def test_all_files_are_complete(self):
        self.assertEqual({path.name for path in self.out.iterdir()},
                         {"force_depth.csv", "summary.yaml", "session.bag", "training.yaml", "training.png", "notebook.csv"},
                         self.said)
        summary = self.told("summary.yaml")
        self.assertEqual(summary["clock"], "wall")
        self.assertLessEqual({"/cell/predicted_cf", "/haptic/servo_cf", "/needle/servo_cp"},
                             {node["topic"] for node in summary["nodes"]})
        for node in summary["nodes"]:
            self.assertGreater(node["count"], 1000, node)
        info = yaml.safe_load(subprocess.run(["rosbag", "info", "--yaml", self.out / "session.bag"], check=True,
                                             stdout=subprocess.PIPE).stdout)
        counts = {topic["topic"]: topic["messages"] for topic in info["topics"]}
        for topic in TOPICS:
            self.assertGreater(counts.get(topic, 0), 50, topic)

    def test_the_needle_goes_through_the_membrane_injects_and_comes_out(self):
        rows = self.rows()
        self.assertEqual({row["phase"] for row in rows if row["phase"]}, PHASES)
        # By hand idle lasts one cycle, which a row each 5 ms may miss.
        states = [row["injection_state"] for row in rows if row["injection_state"] not in ("", "idle")]
        passed = [state for state, before in zip(states, [""] + states) if state != before]
        self.assertEqual(passed[passed.index("indent"):],
                         ["indent", "punctured", "inject", "punctured", "withdraw", "approach"])
        forces = [float(row["predicted_axial_N"]) for row in rows if row["predicted_axial_N"]]
        self.assertGreater(max(forces), 1e-6)
        self.assertLess(max(forces), 1.8e-6)  # the zona gives way at 1.5 uN
        self.assertEqual(forces[-1], 0)
        self.assertGreater(int(rows[-1]["layers_punctured"]), 0)
        # Unknown while the injector or the machine stands still.
        volumes = [float(row["injected_volume_m3"]) for row in rows
                   if row["injection_state"] == "inject" and row["injected_volume_m3"]]
        self.assertGreater(volumes[-1] - volumes[0], 1e-15)
        heights = [float(row["tip_z_m"]) for row in rows if row["tip_z_m"]]
        self.assertLess(min(heights), 15e-6)
        self.assertGreater(heights[-1], 28e-6)

    def test_a_user_is_told_whether_it_is_ready(self):
        self.assertIn(self.during.returncode, (0, 1), self.during.stdout)
        self.assertEqual(self.during.stdout.startswith("the session is ready"), self.during.returncode == 0, self.during.stdout)
        self.assertTrue(self.during.stdout.startswith("the session is"), self.during.stdout)
        if self.before.returncode == NO_SESSION:  # else the session was quicker
            self.assertIn("no session runs", self.before.stdout)

    def test_the_trainee_is_scored(self):
        told = self.told("training.yaml")
        self.assertEqual((told["trainee"], told["outcome"]), ("ada", "complete"))
        self.assertGreater(told["score"], 0)
        with open(self.folder / "history.csv", encoding="utf-8") as file:
            history = list(csv.DictReader(file))
        self.assertEqual([row["trainee"] for row in history], ["ada"])
        self.assertEqual((self.out / "training.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")


if __name__ == "__main__":
    rospy.init_node("user")
    rostest.rosrun("cell_microinjection", "session_live", SessionLiveTest)
