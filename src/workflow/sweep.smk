# A sweep as jobs, each a block of tasks:
#   snakemake -s src/workflow/sweep.smk --profile config/workflow/local --config sweep=FILE out=FOLDER [block=N]

import subprocess
import sys
import yaml
from pathlib import Path

sys.path.insert(0, workflow.basedir)
import programs

SWEEP = programs.required("sweep", config, "FILE")
OUT = programs.required("out", config, "FOLDER")
PROGRAM = programs.find("sweep", config)
BLOCK = int(config.get("block", 1))
# A change of either makes the jobs run again; tasks whose scene is the same return at once.
FILES = [SWEEP, (SWEEP.parent / Path(yaml.safe_load(SWEEP.read_text())["scene"]).expanduser()).resolve()]


def first_tasks():
    """Each job reads this file: the tasks are listed once."""
    tasks = OUT / "tasks.csv"
    if not tasks.exists() or tasks.stat().st_mtime < SWEEP.stat().st_mtime:
        OUT.mkdir(parents=True, exist_ok=True)
        listed = subprocess.run([PROGRAM, "--file", SWEEP, "--list"], check=True, stdout=subprocess.PIPE).stdout
        tasks.write_bytes(listed)
    return range(0, tasks.read_text().count("\n") - 1, BLOCK)


rule table:
    input:
        FILES,
        expand(f"{OUT}/blocks/{BLOCK}/{{first}}", first=first_tasks()),
    output:
        f"{OUT}/sweep.csv",
    shell:
        "{PROGRAM} --file {SWEEP} --out {OUT} --gather"


rule block:
    input:
        FILES,
    output:
        touch(f"{OUT}/blocks/{BLOCK}/{{first}}"),
    shell:
        "{PROGRAM} --file {SWEEP} --out {OUT} --task {wildcards.first} --count {BLOCK}"
