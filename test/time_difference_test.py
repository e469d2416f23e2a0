#!/usr/bin/python3
"""Nodes do not subtract times: the difference of two ros::Time throws beyond 2^31 s, so that one wild stamp would end a
node. secondsBetween of src/nodes/runtime/stamps.h does not."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]
NODES = ("src/nodes", "benchmark/emulated_haptic")
# (a - b).toSec(), with names, members and calls for a and b.
DIFFERENCE = re.compile(r"\((?:[\w:.]|->|\(\))+ - (?:[\w:.]|->|\(\))+\)\s*\.to(?:Sec|NSec)\(\)")


def differences(text):
    return DIFFERENCE.findall(text)


class TimeDifferenceTest(unittest.TestCase):
    def test_no_node_subtracts_times(self):
        files = [path for folder in NODES for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cpp")]
        self.assertGreater(len(files), 50)
        found = [f"{path.relative_to(ROOT)}: {match}" for path in files
                 for match in differences(path.read_text(encoding="utf-8"))]
        self.assertEqual(found, [])

    def test_finds_one(self):
        for text in ("(now - header.stamp).toSec()", "(ros::Time::now() - message->header.stamp).toSec() > 1",
                     "(tick.now - shown_).toSec()"):
            with self.subTest(text):
                self.assertEqual(len(differences(text)), 1)
        self.assertEqual(differences("secondsBetween(a, b) - c.toSec()"), [])


if __name__ == "__main__":
    unittest.main()
