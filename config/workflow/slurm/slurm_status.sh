#!/bin/sh
# slurm_status.sh JOB: prints running, success or failed, as snakemake asks. It needs no accounting. A controller that does
# not answer, because it is being restarted, still has the job. Any other error ends the workflow with its message.
if ! answer=$(scontrol --oneliner show job "$1" 2>&1); then
  case $answer in
    *"Invalid job id"*) echo failed ;;
    *"Unable to contact"* | *"timed out"* | *"Connection refused"*) echo running ;;
    *)
      echo "slurm_status.sh: $answer" >&2
      exit 1
      ;;
  esac
  exit 0
fi
case $answer in
  *JobState=COMPLETED*) echo success ;;
  *JobState=PENDING* | *JobState=RUNNING* | *JobState=COMPLETING* | *JobState=CONFIGURING* | *JobState=SUSPENDED* | \
    *JobState=REQUEUED* | *JobState=REQUEUE_HOLD*) echo running ;;
  *) echo failed ;;
esac
