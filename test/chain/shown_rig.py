#!/usr/bin/python3
"""The node of a rig of one's own, as doc/guide/your_rig.md shows it."""

import pathlib
import re

import rospkg

GUIDE = pathlib.Path(rospkg.RosPack().get_path("cell_microinjection")) / "test/chain/your_rig.md"

shown = re.findall("```python\n(.*?)```", GUIDE.read_text(encoding="utf-8"), re.DOTALL)
assert len(shown) == 1, f"{GUIDE}: {len(shown)} nodes are shown, must be one"
exec(compile(shown[0], GUIDE.name, "exec"), {"__name__": "__main__"})
