"""The programs that ./dev bench peers compares."""
import importlib.util
import shlex
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
CONVERGED, EQUAL, STABILITY = 'converged', 'equal', 'stability'


@dataclass
class Program:
    name: str
    command: str
    studies: tuple
    missing: str = ''  # the package that it needs and the machine lacks
    preparation: tuple = ()  # a command for scenes of rounded tips, run once with the scene file behind it


def python(script, *arguments):
    return ' '.join([sys.executable, '-B', str(HERE / script), *arguments])


def programs(folder):
    """Returns our models, the reference first, and the peers of Debian; `folder` has the programs that were built."""
    ours, bullet = folder / 'peer_ours', folder / 'peer_bullet'
    no_bullet = '' if bullet.exists() else 'libbullet-dev'
    no_calculix = '' if shutil.which('ccx') else 'calculix-ccx'
    no_getfem = '' if importlib.util.find_spec('getfem') else 'python3-getfem'
    return [
        Program('ours p2_p0', f'{ours} p2_p0', (CONVERGED, EQUAL)),
        Program('ours p1', f'{ours} p1', (EQUAL, STABILITY)),
        Program('ours p2', f'{ours} p2', (EQUAL,)),
        Program('ours explicit', f'{ours} explicit', (EQUAL,)),
        Program('ours family', f'{ours} family', (EQUAL,)),
        Program('ours surrogate', f'{ours} surrogate', (EQUAL,), preparation=(folder / 'prepare', '--scene')),
        Program('Bullet', f'{bullet} 1', (EQUAL, STABILITY), no_bullet),
        Program('Bullet, equilibrium', f'{bullet} 5', (EQUAL, STABILITY), no_bullet),
        Program('CalculiX', python('calculix_cell.py'), (CONVERGED, EQUAL, STABILITY), no_calculix),
        Program('GetFEM p2_p1', python('getfem_cell.py', 'p2_p1'), (CONVERGED, EQUAL), no_getfem),
        Program('GetFEM p2', python('getfem_cell.py', 'p2'), (EQUAL,), no_getfem),
        Program('GetFEM p1', python('getfem_cell.py', 'p1'), (EQUAL, STABILITY), no_getfem),
    ]


def law_command(law):
    """Returns the command that solves a case with another strain energy: what the law of a peer changes."""
    return python('getfem_cell.py', 'p2', law)


def joined(text):
    """Returns the Program of --peer NAME=COMMAND; it may be started from any folder. Raises ValueError."""
    name, equals, command = text.partition('=')
    if not name.strip() or not equals or not command.strip():
        raise ValueError(f"--peer '{text}': must be NAME=COMMAND")
    program, *rest = shlex.split(command)
    if Path(program).is_file():
        program = str(Path(program).resolve())
    return Program(name.strip(), shlex.join([program, *rest]), (CONVERGED, EQUAL, STABILITY))
