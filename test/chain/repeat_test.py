#!/usr/bin/env python3
"""Two lock-step runs of one session give the same bytes, and the session does what a session is for."""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "src" / "tools"))
from processes import free_port  # noqa: E402

PATIENCE = 200  # s of wall time; only a session that hangs takes that long


def run_session(folder):
    """A lock-step session on a master of its own; returns the bytes of its force_depth.csv."""
    motion = pathlib.Path(folder) / "motion.csv"
    subprocess.run(["/usr/bin/python3", str(ROOT / "src/tools/make_hand_motion.py"), "--out", str(motion), "--depth",
                    "4e-6", "--speed", "10e-6", "--hold", "0.2", "--tremor", "0", "--puncture", "12e-6", "--inject",
                    "0.6"], check=True)
    port = free_port()
    out = pathlib.Path(folder) / "out"
    subprocess.run(
        ["roslaunch", "-p", str(port), str(ROOT / "launch/session.launch"), "clock:=lockstep", "display:=false",
         f"scene:={ROOT}/test/chain/injected_oocyte.yaml", "model:=live", f"motion:={motion}", f"record:={out}",
         "bag:=false", "end_when_done:=true"],
        check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        env={**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"})
    return (out / "force_depth.csv").read_bytes()


class RepeatTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as a, tempfile.TemporaryDirectory() as b:
            cls.first, cls.second = run_session(a), run_session(b)
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
        self.assertEqual(self.rows[-1]["layers_punctured"], "1")
        volumes = [float(row["injected_volume_m3"]) for row in self.rows if row["injection_state"] == "inject"]
        pipette = 2.46e3 / 1.546e17  # m^3/s: of the pulse's 3 kPa past the capillary pressure, over the resistance
        self.assertAlmostEqual((volumes[-1] - volumes[0]) / (0.3 * pipette), 1, delta=0.05)


if __name__ == "__main__":
    unittest.main()
