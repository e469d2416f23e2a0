"""The biomembrane point-load model beside finite elements (the paper compares with membrane theory)."""
import math

from common import (DIFFERENCE, MEASURED_DEPTH, MEASURED_FORCE, at_depth, converged, figure, item, micro, missing, save,
                    table)

THICKNESS, DIMPLE, TIP = 4e-6, 28e-6, 3e-6                 # m; assumed: a zona of 4 um, a dimple as wide as the cell
YOUNG, POISSON = 17.9e3, 0.49                              # Pa
SOFT, KEEPS_VOLUME = 1e2, 0.4999                           # Pa and Poisson ratio of an inside that is only pressure
DEPTHS = (1, 2, 5, 10, 15, 20, 25, 30, 35, 40, 45)         # um
LAYERED = (1, 2, 5, 10, 15, 20, 25, 30)                    # um

CELL = '''cell:
{cell}
holding_pipette: {{contact_radius: 10e-6}}
needle: {{tip: {{shape: hemisphere, radius: {tip}}}, contact: {{mode: sticking}}}}
'''
SHELL = '''  layers:
    - {{name: zona_pellucida, outer_radius: 28e-6,
       material: {{model: neo_hookean, young_modulus: {young}, poisson_ratio: {poisson}}}}}
    - {{name: cytoplasm, outer_radius: {inner},
       material: {{model: neo_hookean, young_modulus: {soft}, poisson_ratio: {inside}}}}}
'''
HOMOGENEOUS = '''  diameter: 56e-6
  material: {{model: neo_hookean, young_modulus: {young}, poisson_ratio: {poisson}}}
  biomembrane: {{thickness: {thickness}, dimple_radius: {dimple}}}
'''

def tasks(programs, root, data_dir):
    homogeneous = HOMOGENEOUS.format(young=YOUNG, poisson=POISSON, thickness=THICKNESS, dimple=DIMPLE)
    shell = SHELL.format(young=YOUNG, poisson=POISSON, inner=28e-6 - THICKNESS, soft=SOFT, inside=KEEPS_VOLUME)
    for name, cell in (('membrane', homogeneous), ('shell', shell)):
        (data_dir / f'{name}.yaml').write_text(CELL.format(cell=cell, tip=TIP), encoding='utf-8')

    def command(name, depths, *more):
        return [programs['indent'], '--scene', str(data_dir / f'{name}.yaml'), '--depths',
                ','.join(f'{depth}e-6' for depth in depths), '--csv', str(data_dir / f'{name}.csv'), *more]

    return [('membrane', command('membrane', DEPTHS, '--model', 'membrane'), 60),
            ('shell', command('shell', LAYERED, '--tolerance', '0.02', '--time', '60'), 240)]


def steepness(path, first, last):
    """d(ln F)/d(ln depth) between two depths in um, or None."""
    low, high = at_depth(path, 1e-6 * first), at_depth(path, 1e-6 * last)
    return None if not low or not high else math.log(high / low) / math.log(last / first)


def items(data_dir, out_dir):
    name, quantity = 'Section V.C', 'force-depth relation of membrane theory'
    paper = 'similar to the homogeneous cell\'s'
    forces = [at_depth(data_dir / f'{table_name}.csv', MEASURED_DEPTH) for table_name in ('membrane', 'pipette')]
    powers = [steepness(data_dir / f'{table_name}.csv', 10, 30) for table_name in ('membrane', 'pipette', 'shell')]
    if None in forces or None in powers[:2]:
        return [missing(name, quantity, paper, '', 'the membrane or the round pipette')]
    shell = '' if powers[2] is None else f', {powers[2]:.1f} (4 um shell over a soft inside)'
    return [item(name, quantity, paper, f'power of the depth, 10 to 30 um: {powers[0]:.1f} (membrane), {powers[1]:.1f} '
                 f'(homogeneous){shell}', '', DIFFERENCE,
                 f'both bend upwards and cross once ({1e6 * forces[0]:.1f} and {1e6 * forces[1]:.1f} uN at 45 um), but the '
                 'membrane has no stiffness at first, and its inside carries nothing but pressure')]


def plot(data_dir, path):
    made, axes = figure(10, 4.2, 2)
    for axis in axes:
        for name, label, style in (('membrane', 'membrane (analytic)', '-'),
                                   ('pipette', 'homogeneous, converged', 'o-'),
                                   ('shell', f'shell of 4 um over {SOFT:.0f} Pa, converged', 's-')):
            depths, forces = converged(data_dir / f'{name}.csv')
            axis.plot(micro(depths), micro(forces), style, markersize=4, label=label)
        axis.plot([1e6 * MEASURED_DEPTH], [1e6 * MEASURED_FORCE], 'k*', markersize=9, label='measured puncture')
        axis.set(xlabel='depth (um)', ylabel='force (uN)')
    axes[1].set(xscale='log', yscale='log')
    axes[0].legend(frameon=False, fontsize=8)
    save(made, path)


def fitting_thickness(data_dir):
    force = at_depth(data_dir / 'membrane.csv', MEASURED_DEPTH)
    if not force:
        return ''
    fitting = 1e6 * THICKNESS * MEASURED_FORCE / force
    return (f' With {fitting:.1f} um it would meet the measured puncture, where (depth/dimple '
            f'radius)^2 = {(MEASURED_DEPTH / DIMPLE)**2:.1f} is far beyond its small slopes.')


def section(data_dir, out_dir):
    plot(data_dir, out_dir / 'membrane.png')
    names = ('membrane', 'pipette', 'shell')
    lines = [[depth] + [f'{1e6 * force:.3g}' if (force := at_depth(data_dir / f'{name}.csv', 1e-6 * depth)) is not None
                        else '' for name in names] for depth in DEPTHS]
    return '\n\n'.join((
        '## The biomembrane point-load model',
        'Sun, Wan, Roberts and Nelson (2003): a membrane with pressure behind it, F = k depth^3 '
        '(`src/cell/model/biomembrane.h` has the derivation; `indent --model membrane`). It takes nanoseconds. Thickness of '
        'the zona '
        f'({1e6 * THICKNESS:.0f} um) and radius of the dimple ({1e6 * DIMPLE:.0f} um, the widest there can be) are '
        'its inputs, '
        'and assumed: the paper gives neither.' + fitting_thickness(data_dir),
        '![membrane and finite elements](membrane.png)',
        table(('depth (um)', 'membrane (uN)', 'homogeneous, round pipette', 'shell over a soft inside'), lines),
        'Valid where the inside is soft and the dimple known, and well wider than deep; not at small depths, where a '
        'solid '
        'answers in proportion and a slack membrane not at all; not for the paper\'s homogeneous cell. A real shell '
        'of the '
        'same thickness around an inside that keeps its volume is softer yet when deep: being round, it dents with '
        'little '
        'stretching, which a flat membrane cannot.'))
