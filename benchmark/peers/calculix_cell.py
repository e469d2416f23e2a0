#!/usr/bin/python3
"""CalculiX as a program of ./dev bench peers. Usage: CASE RESULT.

Writes CalculiX's input in um, MPa and uN, runs ccx on one thread and reads the reaction of the held nodes. The time of a
step is that of the whole run over its steps, because ccx is started once for a case.
"""
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
import peer_format  # noqa: E402
from calculix_tip import tip_input  # noqa: E402

# CalculiX reads at most 16 values a line and 20 characters a value.
LINE = 12
ELEMENTS = {(2, 2): ('CAX6', 'p2'), (3, 1): ('C3D4', 'p1'), (3, 2): ('C3D10', 'p2')}
WEDGES = 180  # of 2 degrees in a turn: CalculiX turns a section into one of them
LAWS = {'linear': 'same', 'st_venant_kirchhoff': 'same', 'neo_hookean': 'neo_hookean_isochoric'}


def listing(numbers):
    """Returns lines of numbers, separated by commas."""
    return [','.join(str(n) for n in numbers[k:k + LINE]) for k in range(0, len(numbers), LINE)]


def material(layer, law, young, poisson):
    lines = [f'*MATERIAL,NAME=M{layer}']
    young *= 1e-6
    if law == 'neo_hookean':
        shear, bulk = young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))
        lines += ['*HYPERELASTIC,NEO HOOKE', f'{shear / 2!r},{2 / bulk!r}']
    else:
        lines += ['*ELASTIC', f'{young!r},{poisson!r}']
    return lines + [f'*SOLID SECTION,ELSET=L{layer},MATERIAL=M{layer}']


def mesh(case):
    lines = ['*NODE,NSET=CELL']
    for number, node in enumerate(case.nodes, 1):
        x, y, z = (1e6 * value for value in (*node, 0)[:3])
        lines.append(f'{number},{x:.12g},{y:.12g},{z:.12g}')
    kind = ELEMENTS[case.dimension, case.order][0]
    for layer in range(len(case.layers)):
        lines.append(f'*ELEMENT,TYPE={kind},ELSET=L{layer}')
        for number, (of, nodes) in enumerate(case.elements, 1):
            if of == layer:
                lines.append(','.join(str(n) for n in (number, *(node + 1 for node in nodes))))
    lines += ['*NSET,NSET=HELD', *listing([node + 1 for node in case.held])]
    if case.dimension == 2:
        lines += ['*NSET,NSET=AXIS', *listing([n for n, node in enumerate(case.nodes, 1) if abs(node[0]) < 1e-15])]
    if case.glued:
        lines += ['*NSET,NSET=GLUED', *listing([node + 1 for node in case.glued])]
    for layer, values in enumerate(case.layers):
        lines += material(layer, *values)
    return lines


def steps(case):
    """Returns a step of CalculiX for each step of the motion."""
    axis, moved = case.dimension, 'GLUED' if case.glued else 'TIP'
    geometry = '' if case.glued and all(law == 'linear' for law, _, _ in case.layers) else ',NLGEOM'
    lines = ['*BOUNDARY', f'HELD,1,{case.dimension}']
    if case.dimension == 2:
        lines.append('AXIS,1,1')
    for displacement in case.motion:
        lines += [f'*STEP{geometry},INC=2000', '*STATIC',
                  '1.,1.,1e-4,1.' if case.glued else '0.02,1.,1e-6,0.1', '*BOUNDARY']
        if case.dimension == 3:
            lines += [f'{moved},{k + 1},{k + 1},{1e6 * displacement[k]:.12g}' for k in (0, 1)]
        else:
            lines.append(f'{moved},1,1,0.')
        lines += [f'{moved},{axis},{axis},{1e6 * displacement[2]:.12g}', '*NODE PRINT,NSET=HELD,TOTALS=ONLY,FREQUENCY=1000000',
                  'RF', '*END STEP']
    return lines


def input_text(case):
    lines = mesh(case)
    if not case.glued:
        lines += tip_input(case, listing)
    return '\n'.join(lines + steps(case)) + '\n'


def read_forces(text, dimension):
    """Returns the axial force in N of each step that was solved."""
    found = re.findall(r'total force[^\n]*set HELD[^\n]*\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)', text)
    whole = WEDGES if dimension == 2 else 1
    return [1e-6 * whole * float(values[dimension - 1]) for values in found]


def version():
    output = subprocess.run(['ccx', '-v'], capture_output=True, text=True, check=False).stdout
    found = re.search(r'Version\s+(\S+)', output)
    return f'CalculiX {found.group(1)}' if found else 'CalculiX'


def refusal(case):
    """Returns why a case is not served; empty when it is."""
    if (case.dimension, case.order) not in ELEMENTS:
        return 'no linear elements in the section'
    laws = {law for law, _, _ in case.layers}
    if not laws <= set(LAWS) or len(laws) != 1:
        return f'no such material: {", ".join(sorted(laws))}'
    if not case.glued and (case.dimension, case.tip_shape) != (2, 'hemisphere'):
        return 'a rounded tip in the section only'
    if not case.glued and case.tip_mode != 'sliding':
        return 'no contact that sticks without slipping'
    return ''


def solve(case):
    """Returns the Result of a case."""
    result = peer_format.Result(version(), 'equilibrium', declined=refusal(case))
    if result.declined:
        result.element = '-'
        return result
    result.element = ELEMENTS[case.dimension, case.order][1]
    result.law = LAWS[case.layers[0][0]]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / 'case.inp').write_text(input_text(case), encoding='utf-8')
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(['ccx', 'case'], cwd=folder, env={**os.environ, 'OMP_NUM_THREADS': '1'}, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        data = Path(folder) / 'case.dat'
        forces = read_forces(data.read_text(encoding='utf-8'), case.dimension) if data.exists() else []
    count = len(case.motion)
    forces = (forces + [math.nan] * count)[:count]
    time = (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / count
    result.forces, result.times = [(0, 0, force) for force in forces], [time] * count
    return result


def main(case, result):
    text = peer_format.result_text(solve(peer_format.read_case(case)))
    Path(result).write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main(*sys.argv[1:])
