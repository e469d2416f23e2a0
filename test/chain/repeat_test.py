#!/usr/bin/env python3
"""Two lock-step runs of one session give the same bytes, and the session does what a session is for."""

import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "src" / "tools"))
from processes import free_port  # noqa: E402

PATIENCE = 200  # s of wall time; only a session that hangs takes that long


# Of the hand: phase, s, m, clutch. It indents, punctures, injects and retracts.
PATH = [("approach", 2.0, -19.2e-3, False), ("approach", 0.2, -19.2e-3, True), ("approach", 1.2, 0.0, True),
        ("approach", 0.2, 0.0, False), ("approach", 1.6, -10.8e-3, False), ("touch", 1.0, -13.8e-3, False),
        ("indent", 0.4, -16.8e-3, False), ("hold", 0.2, -16.8e-3, False), ("puncture", 0.8, -24.8e-3, False),
        ("puncture", 0.5, -24.8e-3, False), ("inject", 0.6, -24.8e-3, False), ("retract", 1.2, -10.8e-3, False),
        ("retract", 1.0, 0.0, False)]


def run_session(folder, training):
    """A lock-step session on a master of its own; returns the bytes of its force_depth.csv. `training`: keys of the
    session."""
    motion = pathlib.Path(folder) / "motion.yaml"
    motion.write_text(yaml.safe_dump({"path": [dict(zip(("phase", "duration", "z", "clutch"), waypoint))
                                               for waypoint in PATH]}))
    port = free_port()
    out = pathlib.Path(folder) / "out"
    subprocess.run(
        ["roslaunch", "-p", str(port), str(ROOT / "launch/session.launch"), "clock:=lockstep", "display:=false",
         f"cell:={ROOT}/test/chain/injected_oocyte.yaml", "model:=live", f"record:={out}",
         f"set:=hand.motion={motion} record.bag=false record.end_when_done=true {training}"],
        check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        env={**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"})
    return (out / "force_depth.csv").read_bytes()


# Some of it is met, some is not.
TASK = {"peak_force": 0.7e-6, "deformation": 5e-6, "lateral_error": 1e-6, "time": 7.0, "punctures": 3, "volume": 6e-15}
TASK_KEYS = {"peak_force_N": "peak_force", "deformation_m": "deformation", "lateral_error_m": "lateral_error",
             "time_s": "time", "punctures": "punctures", "volume_m3": "volume"}


def training_measures(rows):
    """What a session is scored by, from the rows of its table and nothing else."""
    def number(row, name):
        return float(row[name]) if row[name] else math.nan

    def tip(row):
        return [number(row, f"tip_{axis}_m") for axis in "xyz"]

    rows = [row for row in rows if row["tip_x_m"] and row["measured_axial_N"]]
    at_work = [row for row in rows if row["injection_state"] not in ("", "idle")]
    first_move = next(i for i, row in enumerate(at_work) if math.dist(tip(row), tip(at_work[0])) > 1e-6)
    working = [row for row in at_work if row["injection_state"] != "approach"]
    layers = [int(row["layers_punctured"]) for row in rows]
    gained = [now - before for before, now in zip([0] + layers, layers)]  # one place only
    through = [i for i, row in enumerate(rows) if i and row["injection_state"] in ("punctured", "inject")]
    volumes = [number(row, "injected_volume_m3") for row in rows]
    deepest, farthest, entry = 0, 0, None
    for i, row in enumerate(rows):
        depth = number(row, "depth_m")
        if not depth >= 0:
            entry = None
            continue
        entry = entry or tip(row)
        if not any(gained[:i + 1]):
            deepest = max(deepest, depth)
        if row["injection_state"] in ("contact", "indent", "punctured", "inject"):
            farthest = max(farthest, math.dist(tip(row)[:2], entry[:2]))
    return {"peak_force_N": max(math.hypot(number(row, "measured_axial_N"), number(row, "measured_lateral_N"))
                                for row in rows),
            "deformation_m": deepest, "lateral_error_m": farthest,
            "time_s": float(working[-1]["time_s"]) - float(at_work[first_move - 1]["time_s"]),
            "punctures": sum(gained), "volume_m3": sum(volumes[i] - volumes[i - 1] for i in through)}


class RepeatTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as a, tempfile.TemporaryDirectory() as b:
            task = pathlib.Path(a) / "training.yaml"
            task.write_text(yaml.safe_dump({"force": "measured", "task": TASK}), encoding="utf-8")
            training = f"record.trainee=ada record.history={a}/history.csv record.training={task}"
            cls.first, cls.second = (run_session(folder, training) for folder in (a, b))
            cls.told = yaml.safe_load((pathlib.Path(b) / "out/training.yaml").read_text(encoding="utf-8"))
            cls.history = (pathlib.Path(a) / "history.csv").read_text(encoding="utf-8")
            cls.nodes = yaml.safe_load((pathlib.Path(b) / "out/summary.yaml").read_text(encoding="utf-8"))["nodes"]
            cls.picture = (pathlib.Path(b) / "out/training.png").read_bytes()
        cls.rows = list(csv.DictReader(cls.first.decode().splitlines()))

    def numbers(self, column, phases):
        return [float(row[column]) for row in self.rows if row["phase"] in phases and row[column]]

    def test_same_bytes(self):
        self.assertEqual(self.first, self.second)

    def test_a_whole_session(self):
        self.assertEqual({row["phase"] for row in self.rows if row["phase"]},
                         {"approach", "touch", "indent", "hold", "puncture", "inject", "retract"})
        touched = next(row for row in self.rows if row["in_contact"] == "1")
        self.assertLess(abs(float(touched["depth_m"])), 0.06e-6)  # of 10 um/s in the 5 ms of a row
        depths = self.numbers("depth_m", ("indent", "hold"))
        self.assertGreater(max(depths), 2.5e-6)  # of 4 um meant: the hand yields
        self.assertLess(max(depths), 4.1e-6)
        self.assertGreater(max(self.numbers("predicted_axial_N", ("indent", "hold"))), 0.3e-6)
        self.assertEqual(self.numbers("predicted_axial_N", ("retract",))[-1], 0)

    def test_summary_has_the_steps_of_each_node(self):
        topics = {node["topic"]: node for node in self.nodes}
        self.assertLessEqual({"/cell/predicted_cf", "/haptic/servo_cf", "/needle/servo_cp"}, set(topics))
        for node in self.nodes:
            self.assertGreater(node["count"], 1000, node)
            self.assertAlmostEqual(node["rate_hz"] / round(node["rate_hz"], -2), 1, delta=0.01, msg=str(node))

    def test_hand_yields(self):
        """At rest in the cell the springs of hand and coupling, in series, are in balance with the rendered force."""
        held = [row for row in self.rows if row["phase"] == "hold"][-1]
        force, depth = float(held["hand_force_N"]), float(held["depth_m"])
        self.assertAlmostEqual(force, 2e5 * float(held["predicted_axial_N"]), delta=0.02 * force)
        yielded = force / 400 + force / 2000  # m, of hand (N/m) and coupling
        self.assertAlmostEqual(depth + 1e-3 * yielded, 4e-6, delta=0.03e-6)

    def test_injection(self):
        """Through the membrane, the operator's word, the pulse and its volume."""
        # By hand idle lasts one cycle, which a row each 5 ms may miss.
        states = [row["injection_state"] for row in self.rows if row["injection_state"] not in ("", "idle")]
        passed = [state for state, before in zip(states, [""] + states) if state != before]
        self.assertEqual(passed[passed.index("indent"):],
                         ["indent", "punctured", "inject", "punctured", "withdraw", "approach"])
        self.assertEqual((self.rows[-1]["layers_punctured"], self.rows[-1]["punctures_felt"]), ("2", "0"))
        volumes = [float(row["injected_volume_m3"]) for row in self.rows if row["injection_state"] == "inject"]
        pipette = 2.46e3 / 1.546e17  # m^3/s: of the pulse's 3 kPa past the capillary pressure, over the resistance
        self.assertAlmostEqual((volumes[-1] - volumes[0]) / (0.3 * pipette), 1, delta=0.05)

    def test_training(self):
        """Score, history and picture of the second of two sessions; its measures, once more from the table."""
        self.assertEqual([self.told[key] for key in ("operator", "outcome", "reason", "moments_left_out")],
                         ["ada", "complete", "", 0])
        measures = training_measures(self.rows)
        points = 0
        for name, value in measures.items():
            row = self.told["measures"][name]
            self.assertAlmostEqual(row["value"] / value, 1, delta=1e-5, msg=name)
            share = 1 - abs(value / TASK[TASK_KEYS[name]] - 1) if name in ("punctures", "volume_m3") else \
                min(1, 2 - value / TASK[TASK_KEYS[name]])
            self.assertGreater(share, 0, f"{name}: a task that tells something")
            self.assertAlmostEqual(row["points"] / (share * row["of"]), 1, delta=1e-4, msg=name)
            points += share * row["of"]
        self.assertAlmostEqual(self.told["score"], points, delta=1e-3)
        self.assertEqual(measures["punctures"], 2)
        rows = list(csv.DictReader(self.history.splitlines()))
        self.assertEqual([(row.pop("session")[:2], row["operator"]) for row in rows], [("20", "ada")] * 2)
        self.assertEqual(rows[0], rows[1])
        for name, value in measures.items():
            self.assertAlmostEqual(float(rows[1][name]) / value, 1, delta=1e-5)
        self.assertEqual(self.picture[:8], b"\x89PNG\r\n\x1a\n")


if __name__ == "__main__":
    unittest.main()
