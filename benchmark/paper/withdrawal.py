"""What the paper leaves to future work: friction, adhesion and viscosity, in the force on the way out."""
import math

from common import DIFFERENCE, NOT_REPRODUCIBLE, figure, item, missing, read, save, table

IN, OUT = (0.5, 1, 2, 3, 4, 5), (4, 3, 2, 1, 0.5, 0, -0.25, -0.5, -0.75, -1, -1.5, -2, -3)  # um
ADHESION = '{energy: 2e-3, range: 0.5e-6}'                                             # J/m^2 and m: assumed
PRONY = ', viscoelasticity: {prony: [{modulus_ratio: 0.5, relaxation_time: 0.2}]}'     # assumed
SCENE = '''cell:
  diameter: 56e-6
  material: {{model: neo_hookean, young_modulus: 17.9e3, poisson_ratio: 0.49{viscosity}}}
holding_pipette: {{contact_radius: 10e-6}}
needle: {{tip: {{shape: hemisphere, radius: 3e-6}}, contact: {{{contact}}}}}
'''
# name: label, contact, viscosity, options
RUNS = {
    'smooth': ('sliding, nothing else', 'mode: sliding', '', ()),
    'friction': ('friction 0.2', 'mode: sliding, friction: 0.2', '', ()),
    'sticking': ('sticking (friction without bound)', 'mode: sticking', '', ()),
    'adhesion': ('adhesion, sliding', f'mode: sliding, adhesion: {ADHESION}', '', ()),
    'adhesion_sticking': ('adhesion, sticking', f'mode: sticking, adhesion: {ADHESION}', '', ()),
    'viscous': ('viscosity, 20 um/s', 'mode: sticking', PRONY, ('--speed', '20e-6')),
}

# effect, run that has it, run that has all else
EFFECTS = (('friction', 'friction', 'smooth'), ('adhesion', 'adhesion', 'smooth'), ('viscosity', 'viscous', 'sticking'))

NOISE = 0.1  # fJ, of the work lost, which is some hundreds going in
PULL_UNIT = 1e9 * math.pi * 2e-3 / (1 / 3e-6 + 1 / 28e-6)  # nN, pi w R: 1.5 times that in JKR's limit, 2 in DMT's


def tasks(programs, root, data_dir):
    result = []
    for name, (_, contact, viscosity, options) in RUNS.items():
        scene = data_dir / f'withdrawal_{name}.yaml'
        scene.write_text(SCENE.format(contact=contact, viscosity=viscosity), encoding='utf-8')
        command = [programs['indent'], '--scene', str(scene), '--depths', ','.join(f'{d}e-6' for d in IN), '--withdraw',
                   ','.join(f'{d}e-6' for d in OUT), '--tolerance', '0.05', '--time', '60', '--csv',
                   str(data_dir / f'withdrawal_{name}.csv'), *options]
        result.append((f'withdrawal_{name}', command, 240))
    return result


def path_of(data_dir, name):
    """[(depth in um, force in uN)] in and out, converged."""
    rows = read(data_dir / f'withdrawal_{name}.csv')
    return [(1e6 * row['depth_m'], 1e6 * row['force_z_N']) for row in rows if row['converged'] == 1]


def measures(data_dir, name):
    """(work lost in fJ, strongest pull in nN, depth there in um), or None when the path was not found to its end."""
    path = path_of(data_dir, name)
    if len(path) < len(IN) + len(OUT):
        return None
    closed = [(0, 0)] + path
    lost = sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(closed, closed[1:]))  # uN um = pJ
    depth, least = min(path, key=lambda point: point[1])
    return 1e3 * lost, max(0, -1e3 * least), depth


def items(data_dir, out_dir):
    result = []
    for effect, name, without in EFFECTS:
        title, paper = f'{effect} in the force on the way out', 'future work'
        found, plain = measures(data_dir, name), measures(data_dir, without)
        if not found or not plain:
            result.append(missing('Section VI', title, paper, '', effect))
            continue
        ours = f'{found[0]:.3g} fJ lost in 5 um in and out, pull of {found[1]:.3g} nN'
        shown = found[0] > plain[0] + NOISE
        result.append(item('Section VI', title, paper, ours, '', DIFFERENCE if shown else NOT_REPRODUCIBLE,
                           f'modelled here; without it ({RUNS[without][0]}) {plain[0]:.2g} fJ, {plain[1]:.2g} nN; '
                           'the constants are assumed, since the paper has none'))
    return result


def loops(data_dir, name):
    """[(depth in um, force on the way in less that on the way out, nN)]; none where the path was not found."""
    points = path_of(data_dir, name)
    if len(points) < len(IN) + len(OUT):
        return []
    going_in, out = dict([(0, 0)] + points[:len(IN)]), dict(points[len(IN):])
    return [(depth, 1e3 * (force - out[depth])) for depth, force in going_in.items() if depth in out]


def plot(data_dir, path):
    made, axes = figure(14.5, 4.4, 3)
    for index, (name, (label, *_)) in enumerate(RUNS.items()):
        points = path_of(data_dir, name)
        if not points:
            continue
        going_in, out = points[:len(IN)], points[len(IN) - 1:]
        axes[2].plot([depth for depth, _ in loops(data_dir, name)], [gap for _, gap in loops(data_dir, name)], 'o-',
                     color=f'C{index}', markersize=3)
        for axis in axes[:2]:
            axis.plot(*zip(*[(0, 0)] + going_in), '-', color=f'C{index}', linewidth=1)
            axis.plot(*zip(*out), '--', color=f'C{index}', marker='o', markersize=3, label=label)
    axes[0].set(title='in (solid) and out (dashed)', xlabel='depth (um)', ylabel='force (uN)')
    axes[1].set(title='about the touch', xlabel='depth (um)', xlim=(-3.2, 1.6), ylim=(-0.06, 0.1))
    axes[2].set(title='force in less force out', xlabel='depth (um)', ylabel='nN')
    axes[2].set_yscale('symlog', linthresh=0.1)
    axes[0].legend(frameon=False, fontsize=8)
    save(made, path)


def section(data_dir, out_dir):
    plot(data_dir, out_dir / 'withdrawal.png')
    lines = []
    for name, (label, *_) in RUNS.items():
        found = measures(data_dir, name)
        lines.append((label, *(f'{value:.3g}' for value in found)) if found else (label, 'no path', '', ''))
    return '\n\n'.join((
        '## Future work of the paper: friction, adhesion, viscosity',
        '`indent --depths 0.5e-6,...,5e-6 --withdraw 4e-6,...,-3e-6`, neo-Hookean cell, hemisphere of 3 um. '
        'Coulomb\'s friction '
        'and sticking; adhesion `needle/contact/adhesion: {energy: 2e-3, range: 0.5e-6}` (J/m^2 and m), a traction '
        'that pulls '
        'what has touched over a gap (`contact/rigid_contact.h`); one Prony term of half the modulus and 0.2 s. All '
        'assumed.',
        '![in and out](withdrawal.png)',
        table(('', 'work lost (fJ)', 'strongest pull (nN)', 'at (um)'), lines),
        f'Theories of adhesion to a soft body without range (JKR) and to a rigid one (DMT) have pull-offs of '
        f'{1.5 * PULL_UNIT:.1f} '
        f'and {2 * PULL_UNIT:.1f} nN for a smooth tip. Viscosity opens the loop while the cell is pushed, adhesion '
        'after the touch, where the needle has to be torn off; a '
        'sticking needle hangs on by the side of its tip a little. Friction loses little: under a hemisphere most of '
        'the '
        'surface sticks on the way in at such depths (on the right, at most '
        f'{max((gap for _, gap in loops(data_dir, "friction")), default=0):.2g} nN). (The sums are over the points of '
        'the plot.)'))
