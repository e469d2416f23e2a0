"""The programs around a session: what makes it ready, runs it on virtual time, and judges it afterwards."""
import os
import subprocess
from pathlib import Path


class FullSolutionError(Exception):
    """What went wrong, for the user."""


def _program(name):
    for prefix in os.environ.get('CMAKE_PREFIX_PATH', '').split(':'):
        path = Path(prefix) / 'lib' / 'cell_microinjection' / name
        if path.is_file():
            return str(path)
    raise FullSolutionError(f'there is no program {name} in the workspace: is it built and its environment set?')


def prepare(scene):
    """Prepares a scene, with progress; at once when that was done before, or when a family serves it. @returns whether
    it is prepared."""
    families = Path(__file__).resolve().parents[2] / 'config' / 'families'
    return subprocess.run([_program('prepare'), '--scene', str(scene), '--families', str(families)], check=False).returncode == 0


def simulate(keys):
    """Runs a session on virtual time, with progress. `keys`: those that differ from the default session's. @returns the exit
    status."""
    return subprocess.run([_program('simulate'), 'default', *(f'{key}:={value}' for key, value in keys.items() if value)],
                          check=False).returncode


def check_family(family, members, seed, kept, table):
    """Compares a family with members at random that were never solved for, and leaves the table.

    `kept`: file of converged places, which gets those that it lacks. @returns success.
    """
    command = [_program('prepare'), '--family', str(family), '--check', str(members), '--seed', str(seed),
               '--reference', str(kept), '--csv', str(table)]
    return subprocess.run(command, check=False, stdout=subprocess.DEVNULL).returncode == 0


def judge(scene, session, table):
    """Compares a session's forces with the full solution along its way in, and leaves the table.

    @returns the closing line, or None when the full solution was lost on the way.
    """
    command = [_program('trajectory_error'), '--scene', str(scene), '--session', str(session), '--csv', str(table)]
    result = subprocess.run(command, check=False, stdout=subprocess.PIPE, text=True)
    lines = result.stdout.strip().splitlines()
    return lines[-1] if result.returncode == 0 and lines else None
