# The members of a family, round by round; each path is a job:
#   snakemake -s src/workflow/family.smk --profile config/workflow/local --config family=FILE members=N out=FOLDER [block=N]
# A block of paths is one job. The solved paths are in the cache ($XDG_CACHE_HOME), which all machines must share.

import sys
from pathlib import Path

sys.path.insert(0, workflow.basedir)
import programs

FAMILY = programs.required("family", config, "FILE")
PROGRAM = programs.find("prepare", config)
MEMBERS = int(config.get("members", 30))
# Plans of another number of members are others.
OUT = programs.required("out", config, "FOLDER") / f"members_{MEMBERS}"
BLOCK = int(config.get("block", 8))


def tasks(plan):
    return Path(plan).read_text().count("\n") - 2


def blocks(wildcards):
    plan = checkpoints.plan.get(round=wildcards.round).output[0]
    return [f"{OUT}/round_{wildcards.round}/blocks/{BLOCK}/{first}" for first in range(0, tasks(plan), BLOCK)]


def last_plan(wildcards):
    """Which has no tasks. What the rounds before it need comes first."""
    number = 0
    while tasks(checkpoints.plan.get(round=number).output[0]) > 0:
        number += 1
    return f"{OUT}/round_{number}/plan.csv"


rule family:
    input:
        last_plan,


checkpoint plan:
    input:
        FAMILY,
        lambda wildcards: [f"{OUT}/round_{int(wildcards.round) - 1}/gathered"] if int(wildcards.round) > 0 else [],
    output:
        f"{OUT}/round_{{round}}/plan.csv",
    shell:
        "{PROGRAM} --family {FAMILY} --members {MEMBERS} --list {output}"


rule block:
    input:
        f"{OUT}/round_{{round}}/plan.csv",
    output:
        touch(f"{OUT}/round_{{round}}/blocks/{BLOCK}/{{first}}"),
    shell:
        "{PROGRAM} --family {FAMILY} --plan {input} --task {wildcards.first} --count {BLOCK}"


rule gather:
    input:
        plan=f"{OUT}/round_{{round}}/plan.csv",
        blocks=blocks,
    output:
        touch(f"{OUT}/round_{{round}}/gathered"),
    shell:
        "{PROGRAM} --family {FAMILY} --members {MEMBERS} --plan {input.plan} --gather"
