"""Section V.A: the force behind the paper's puncture, as it follows from the toughness, beside that of a threshold."""
from common import DIFFERENCE, MEASURED_DEPTH, MEASURED_FORCE, figure, item, micro, missing, read, save, table

SCENE = 'config/cells/mouse_oocyte_stiffening.yaml'


def tasks(programs, root, data_dir):
    return [('puncture', [programs['paper_puncture'], '--csv', str(data_dir / 'puncture.csv')], 900)]


def ways_of(data_dir):
    """{way: [(depth in um, force in uN, hole in um)]}"""
    ways = {}
    for row in read(data_dir / 'puncture.csv'):
        ways.setdefault(row['way'], []).append(tuple(micro((row['depth_m'], row['force_N'], row['hole_m']))))
    return ways


def items(data_dir, out_dir):
    name = 'Section V.A'
    ways = ways_of(data_dir)
    if not {'onset', 'in', 'out'} <= set(ways):
        return [missing(name, 'force behind the puncture, by mechanics', 'not given', 'uN', 'the puncture')]
    onset, *_ = ways['onset']
    first, last = ways['in'][0], ways['in'][8]  # steps of 0.25 um
    return [
        item(name, 'puncture by mechanics, fitted', f'{1e6 * MEASURED_FORCE:.3g} uN at {1e6 * MEASURED_DEPTH:.3g} um',
             f'{onset[1]:.3g} uN at {onset[0]:.3g} um', '', DIFFERENCE,
             'modulus and toughness are fitted to this one point; the stiffening is chosen'),
        item(name, 'force at once behind it, and 2 um further on', 'not given', f'{first[1]:.3g}, {last[1]:.3g}', 'uN',
             DIFFERENCE, 'follows without another number; a threshold has none of it'),
        item(name, 'force with which the closing hole pushes the needle out', 'not given',
             f'{min(force for _, force, _ in ways["out"]):.3g}', 'uN', DIFFERENCE,
             'smallest on the way out, without friction of the shaft')]


def section(data_dir, out_dir):
    title = '## Section V.A: the puncture by mechanics'
    ways = ways_of(data_dir)
    if not {'onset', 'in', 'out'} <= set(ways):
        return f'{title}\n\nNo result in this run.'
    onset, *_ = ways['onset']
    made, axes = figure()
    for way, style, label in (('whole', 'C0:', 'whole cell'), ('in', 'C3-', 'with the hole, in'),
                              ('out', 'C3--', 'with the hole, out')):
        axes.plot([depth for depth, *_ in ways[way]], [force for _, force, _ in ways[way]], style, label=label)
    before = [point for point in ways['whole'] if point[0] <= onset[0]] + [onset]
    axes.plot([depth for depth, *_ in before], [force for _, force, _ in before], 'C0-')
    axes.plot([onset[0], ways['in'][0][0]], [onset[1], ways['in'][0][1]], 'C3-')
    axes.plot([onset[0], onset[0], onset[0] + 3], [onset[1], 0, 0], color='0.6', label='threshold')
    axes.plot(1e6 * MEASURED_DEPTH, 1e6 * MEASURED_FORCE, 'k+', markersize=10, label='measured')
    axes.set(xlabel='depth (um)', ylabel='force (uN)', xlim=(0, None), ylim=(0, 1.15 * onset[1]))
    axes.legend(frameon=False, fontsize=8)
    save(made, out_dir / 'puncture.png')
    (_, force_in, radius), (_, force_out, _) = ways['steady_in'][0], ways['steady_out'][0]
    rows = [(f'{depth - onset[0]:.1f}', f'{force:.3g}', f'{hole:.3g}') for depth, force, hole in ways['in'][::2]]
    return '\n\n'.join((
        title, '![force of the whole and of the pierced cell](puncture.png)',
        f'`{SCENE}`: an Ogden solid whose modulus and toughness are fitted to the measured puncture (`./dev bench '
        f'puncture -- --studies paper`). It begins at {onset[1]:.3g} uN in a dent of {onset[0]:.3g} um. All behind '
        'it follows without another number: '
        f'a long hole, of an undeformed radius of {radius:.2g} um, would need {force_in:.3g} uN and push '
        f'the needle out with {force_out:.2g} uN.',
        table(('behind the onset (um)', 'force (uN)', 'hole (um)'), rows),
        'A threshold says nothing of this: the same cell with `puncture/force` has no force behind the '
        'break but those of springs and shaft, which are illustrative. What the one measured point cannot decide '
        'is the stiffening: another exponent meets it with another modulus and toughness, and falls by another share. '
        'A second point of the same curve, or the force behind the break, would decide it. The steps of the way in '
        'may be those of the interpolation between holes of a few lengths.'))
