#!/bin/sh
# A sweep as an array of jobs of Slurm, without any other engine:
#   sbatch --array=0-LAST src/workflow/slurm_array.sh PROGRAM FILE OUT BLOCK
# Job K solves the tasks K * BLOCK to K * BLOCK + BLOCK - 1. Submit it again after failures: what is there is not solved anew.
#SBATCH --job-name=sweep
#SBATCH --cpus-per-task=1
#SBATCH --requeue
set -eu
if [ $# -ne 4 ]; then
  echo "slurm_array.sh PROGRAM FILE OUT BLOCK, not '$*'" >&2
  exit 2
fi
exec "$1" --file "$2" --out "$3" --task $((SLURM_ARRAY_TASK_ID * $4)) --count "$4"
