"""Equation (13): the stable time step, and what real time would cost."""
import math

from common import DIFFERENCE, NOT_REPRODUCIBLE, REPRODUCED, figure, item, missing, read, save, table
from table_3 import PAPER

PAPER_ON_LINE = {tetrahedra: 1e-3 * times[2] for tetrahedra, times in PAPER.items()}  # s, of the paper's step
JUDGED = (379, 4819)                             # tetrahedra: meshes on which the price of the mass is computed
NEAR = 0.05                                      # relative, of a mesh's size
HAPTIC = 1e-3                                    # s


def tasks(programs, root, data_dir):
    return [('dynamics', [programs['paper_dynamics'], '--csv', str(data_dir / 'dynamics.csv')], 420)]


def rows_of(data_dir):
    rows = read(data_dir / 'dynamics.csv')
    return [row for row in rows if row['kind'] == 'limit'], [row for row in rows if row['kind'] == 'ramp']


def scale_for(step, stable):
    """Mass scaling with which a step that takes `step` to compute covers as much time; the stable one grows with its
    square root."""
    return (step / stable)**2


def errors_of(ramps, tetrahedra):
    """{mass scale: largest relative error of the force on the way in}"""
    errors = {}
    for row in ramps:
        if row['tetrahedra'] == tetrahedra and row['equilibrium_N'] == row['equilibrium_N']:
            error = abs(row['force_N'] / row['equilibrium_N'] - 1)
            errors[row['mass_scale']] = max(error, errors.get(row['mass_scale'], 0))
    return errors


def price(errors, scale):
    """Relative error of the force at a mass scaling, between those that were run by powers, as text."""
    known = sorted(errors.items())
    if not known:
        return 'unknown'
    if scale > known[-1][0]:
        return f'more than {100 * known[-1][1]:.0f} %'
    for low, high in zip(known, known[1:]):
        if low[0] <= scale <= high[0]:
            share = math.log(scale / low[0]) / math.log(high[0] / low[0])
            return f'{100 * low[1]**(1 - share) * high[1]**share:.0f} %'
    return f'{100 * known[0][1]:.0f} %'


def mesh_of(limits, tetrahedra):
    """The row of the mesh of the paper's size, or None."""
    row = min(limits, key=lambda one: abs(one['tetrahedra'] - tetrahedra))
    return row if abs(row['tetrahedra'] / tetrahedra - 1) <= NEAR else None


def slowness(limits):
    """How many times longer than the time that it steps a step takes: the paper's, ours, on every mesh of its sizes."""
    theirs = [paper / row['exact_step_s'] for tetrahedra, paper in PAPER_ON_LINE.items()
              if (row := mesh_of(limits, tetrahedra))]
    return theirs, [row['step_cost_s'] / row['exact_step_s'] for row in limits]


def span(values):
    return f'{float(f"{min(values):.2g}"):.0f} to {float(f"{max(values):.2g}"):.0f}'


def items(data_dir, out_dir):
    limits, ramps = rows_of(data_dir)
    if not limits:
        return [missing('Equation 13', 'stable time step', 'not given', 'us', 'the dynamics')]
    steps = [1e6 * row['exact_step_s'] for row in limits]
    theirs, ours = slowness(limits)
    result = [item('Equation 13', 'stable time step at the cell\'s mass', 'not given',
                   f'{min(steps):.2g} to {max(steps):.2g}', 'us', DIFFERENCE, 'over all mesh sizes of Table III')]
    if theirs:
        result.append(item('Equation 13', 'time to compute a stable step over the time it steps', 'not given',
                           f'{span(theirs)} (its own step time), {span(ours)} (ours)', '', DIFFERENCE,
                           'all mesh sizes, the cell\'s mass: above 1 it is not real time'))
    for tetrahedra in JUDGED:
        row, paper = mesh_of(limits, tetrahedra), PAPER_ON_LINE[tetrahedra]
        if row is None:
            result.append(missing('Equation 13', f'real time with {tetrahedra} tetrahedra', 'real time', '',
                                  'this mesh'))
            continue
        scale, mine = (scale_for(step, row['exact_step_s']) for step in (paper, row['step_cost_s']))
        errors = errors_of(ramps, row['tetrahedra'])
        nearest = [f'{100 * error:.0f} % at {used:.0e}' for used, error in sorted(errors.items())]
        result.append(item('Equation 13', f'real time with {row["tetrahedra"]:.0f} tetrahedra', 'real time',
                           f'mass times {scale:.1e}, force off by {price(errors, scale)} (its own step time); '
                           f'{mine:.1e}, {price(errors, mine)} (ours)',
                           '', NOT_REPRODUCIBLE if scale > 1 else REPRODUCED,
                           'not with the cell\'s mass. Largest error of the force on the way to 1 um at 100 um/s, '
                           'between these mass scalings by powers: ' + ', '.join(nearest)))
    return result


def plot(ramps, path):
    sizes = sorted({row['tetrahedra'] for row in ramps})
    made, axes = figure(10, 4.2, max(2, len(sizes)))
    for axis, size in zip(axes, sizes):
        rows = [row for row in ramps if row['tetrahedra'] == size]
        scales = sorted({row['mass_scale'] for row in rows})
        for index, scale in enumerate(scales):
            line = [row for row in rows if row['mass_scale'] == scale]
            axis.plot([1e6 * row['depth_m'] for row in line], [1e6 * row['force_N'] for row in line], 'o-',
                      markersize=3,
                      color=f'C{index}', label=f'mass x {scale:.0e}')
        line = [row for row in rows if row['mass_scale'] == scales[0]]
        axis.plot([1e6 * row['depth_m'] for row in line], [1e6 * row['equilibrium_N'] for row in line], 'k--',
                  label='equilibrium')
        axis.set(xlabel='depth (um)', ylabel='force (uN)', title=f'{size:.0f} tetrahedra, 100 um/s')
    axes[0].legend(frameon=False, fontsize=8)
    save(made, path)


def section(data_dir, out_dir):
    limits, ramps = rows_of(data_dir)
    if not limits:
        return '## Equation 13\n\nNo result in this run.'
    if ramps:
        plot(ramps, out_dir / 'dynamics.png')
    lines = [(f'{row["vertices"]:.0f} / {row["tetrahedra"]:.0f}', f'{1e6 * row["stable_step_s"]:.3f}',
              f'{1e6 * row["exact_step_s"]:.3f}', f'{1e6 * row["observed_limit_s"]:.3f}',
              f'{1e6 * row["step_cost_s"]:.1f}',
              f'{row["step_cost_s"] / row["exact_step_s"]:.0f}',
              f'{scale_for(row["step_cost_s"], row["exact_step_s"]):.1e}',
              f'{scale_for(HAPTIC, row["exact_step_s"]):.1e}')
             for row in limits]
    return '\n\n'.join((
        '## Equation 13: the time step that the paper does not tell',
        'Central differences are stable up to 2/w, w the highest angular frequency. *Bound*: from the most rigid '
        'element, in '
        'closed form, certain (`mechanics/element_frequency.h`); *exact*: by power iteration; *observed*: beyond it '
        'a small '
        'jump of the needle grows without end.',
        table(('vertices / tetrahedra', 'bound (us)', 'exact (us)', 'observed (us)', 'a step takes (us)',
               'times slower than real '
               'time', 'mass scaling: real time', 'mass scaling: one step a millisecond'), lines),
        '![forces with scaled mass](dynamics.png)',
        'The needle goes in at 100 um/s; damped critically for a shear wave of two diameters. What scaling costs '
        'depends on '
        'speed times the square root of the mass scaling: ten times faster is as bad as a hundredfold mass. Scaled a '
        'hundred '
        'million times, as a step each millisecond needs, the force is inertia, not elasticity.'))
