"""Section V.A: the modulus that the measured puncture has, by `identify`, and what the paper leaves open in it."""
from common import (BAND, DIFFERENCE, MEASURED_DEPTH, MEASURED_FORCE, REPRODUCED, item, missing, read, table)

PAPER_MODULUS = 17.9e3  # Pa, Table I
SCENE = 'mouse_oocyte_pipette'
RADIUS, HOLDING = '    radius: 3e-6', '  contact_radius: 10e-6'
# name of the table: what is assumed, the line of the scene that changes, its new value
VARIANTS = {'identified': ('tip of 3 um, holding radius 10 um', None, None),
            'identified_tip_2_5': ('tip of 2.5 um', RADIUS, '    radius: 2.5e-6'),
            'identified_tip_4': ('tip of 4 um', RADIUS, '    radius: 4e-6'),
            'identified_holding_8': ('holding radius 8 um', HOLDING, '  contact_radius: 8e-6'),
            'identified_holding_14': ('holding radius 14 um', HOLDING, '  contact_radius: 14e-6')}
LIMIT = 300  # s


def scene_of(name, root, data_dir):
    """Writes the variant's scene and returns its path."""
    _, line, changed = VARIANTS[name]
    text = (root / f'config/cells/{SCENE}.yaml').read_text(encoding='utf-8')
    if line is not None:
        if text.count(line) != 1:
            raise ValueError(f'{SCENE}.yaml: must have {line!r} once')
        text = text.replace(line, changed)
    path = data_dir / f'{name}.yaml'
    path.write_text(text, encoding='utf-8')
    return path


def tasks(programs, root, data_dir):
    return [(name, [programs['identify'], '--point', f'{MEASURED_DEPTH},{MEASURED_FORCE}', '--reading-error', str(BAND),
                    '--scene', str(scene_of(name, root, data_dir)), '--model', 'solution', '--csv',
                    str(data_dir / f'{name}.csv')], LIMIT) for name in VARIANTS]


def modulus(data_dir, name):
    """(value, low, high), Pa, or None."""
    for row in read(data_dir / f'{name}.csv'):
        if row['quantity'] == 'young_modulus':
            return row['value'], row['low'], row['high']
    return None


def kilo(value):
    return f'{1e-3 * value:.1f}'


def items(data_dir, out_dir):
    name, quantity = 'Section V.A', 'modulus from the puncture (7.5 uN at 45 um +- 5 %)'
    found = modulus(data_dir, 'identified')
    if found is None:
        return [missing(name, quantity, kilo(PAPER_MODULUS), 'kPa', 'identify')]
    value, low, high = found
    holds = low <= PAPER_MODULUS <= high
    assumed = [modulus(data_dir, variant) for variant in VARIANTS]
    moduli = [variant[0] for variant in assumed if variant is not None]
    why = 'neo-Hookean, solved to 45 um by `identify`; the interval is of 95 %, from the reading error'
    if len(moduli) > 1:
        why += f'; the needle and the holding pipette, which the paper does not tell, move it from ' \
               f'{kilo(min(moduli))} to {kilo(max(moduli))}'
    return [item(name, quantity, kilo(PAPER_MODULUS), f'{kilo(value)} [{kilo(low)}, {kilo(high)}]', 'kPa',
                 REPRODUCED if holds else DIFFERENCE, why)]


def section(data_dir, out_dir):
    rows = []
    for name, (assumed, _, _) in VARIANTS.items():
        found = modulus(data_dir, name)
        rows.append([assumed, *([kilo(value) for value in found] if found else ['none'] * 3)])
    return '\n\n'.join((
        '## Section V.A: the modulus that the experiment has',
        'The force of a homogeneous cell at a given depth is proportional to its modulus. `identify` solves the cell of '
        'Table I under a round pipette to 45 um, and finds the modulus that has the measured force there. Its interval '
        'of 95 % has the prediction bounds of the paper and the error of the solution.',
        table(('assumed', 'modulus (kPa)', 'low', 'high'), rows),
        'Left open by the paper: the radius of the tip, that of the holding pipette, and how far the needle was from the '
        'axis. The rows have one of the first two changed; the needle is on the axis in all. One point does not test '
        'the model, and its depth is given as "about 45 um", without an error.'))
