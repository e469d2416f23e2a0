#!/usr/bin/python3
"""The parts of the workflows that need no engine: the status of a job of Slurm, the array's script, where the programs are.
./dev bench cluster runs the whole on a real Slurm."""
import os
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src' / 'workflow'))
sys.path.insert(0, str(ROOT / 'test'))

import programs  # noqa: E402
from in_folder import InFolder  # noqa: E402


class Workflow(InFolder):
    def script(self, name, text):
        path = self.write(name, f'#!/bin/sh\n{text}\n')
        path.chmod(0o755)
        return path

    def status(self, scontrol):
        """Of a job, where the command scontrol does that."""
        self.script('scontrol', scontrol)
        path = f'{self.folder}:{os.environ["PATH"]}'
        return subprocess.run([ROOT / 'config/workflow/slurm/slurm_status.sh', '7'], env={**os.environ, 'PATH': path},
                              capture_output=True, text=True, check=True).stdout.strip()

    def test_status_of_a_job(self):
        """States as `scontrol show job` of Slurm 22.05 prints them (man scontrol, JOB STATE CODES of man squeue)."""
        expected = {'COMPLETED': 'success', 'PENDING': 'running', 'RUNNING': 'running', 'COMPLETING': 'running',
                    'SUSPENDED': 'running', 'FAILED': 'failed', 'CANCELLED': 'failed', 'TIMEOUT': 'failed',
                    'NODE_FAIL': 'failed', 'OUT_OF_MEMORY': 'failed', 'PREEMPTED': 'failed'}
        for state, wanted in expected.items():
            self.assertEqual(self.status(f'echo "JobId=7 JobName=x JobState={state} Reason=None"'), wanted, state)

    def test_a_controller_that_is_away_still_has_the_job(self):
        away = 'echo "slurm_load_jobs error: Unable to contact slurm controller (connect failure)" >&2; exit 1'
        self.assertEqual(self.status(away), 'running')
        self.assertEqual(self.status('echo "slurm_load_jobs error: Invalid job id specified" >&2; exit 1'), 'failed')
        with self.assertRaises(subprocess.CalledProcessError) as caught:
            self.status('echo "scontrol: fatal: Could not establish a configuration source" >&2; exit 1')
        self.assertIn('Could not establish a configuration source', caught.exception.stderr)

    def test_a_job_of_the_array_does_its_block(self):
        program = self.script('sweep', 'echo "$@"')
        done = subprocess.run([ROOT / 'src/workflow/slurm_array.sh', program, 'f.yaml', 'out', '50'], check=True,
                              env={**os.environ, 'SLURM_ARRAY_TASK_ID': '3'}, capture_output=True, text=True)
        self.assertEqual(done.stdout.strip(), '--file f.yaml --out out --task 150 --count 50')
        wrong = subprocess.run([ROOT / 'src/workflow/slurm_array.sh', program], capture_output=True, text=True)
        self.assertEqual(wrong.returncode, 2)
        self.assertIn('slurm_array.sh PROGRAM FILE OUT BLOCK', wrong.stderr)

    def test_the_programs_are_named_or_built(self):
        self.script('sweep', 'true')
        self.assertEqual(programs.find('sweep', {'programs': str(self.folder)}), (self.folder / 'sweep').resolve())
        with self.assertRaisesRegex(SystemExit, f'prepare is not in {self.folder}'):
            programs.find('prepare', {'programs': str(self.folder)})
        with self.assertRaisesRegex(SystemExit, 'sweep is missing: add sweep=FILE behind --config'):
            programs.required('sweep', {}, 'FILE')


if __name__ == '__main__':
    unittest.main()
