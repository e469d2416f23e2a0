"""Table I: volume and mass of the cell from its diameter; and what else it gives, which is taken over."""
import math

from common import DIAMETER, DIFFERENCE, at_depth, item, missing, table, verdict

VOLUME, MASS = '91952', '9.1952e-5'  # um^3, mg: the paper's
ROUNDING = 1e-5                      # relative, of its five figures
DENSITY = 1000                       # kg/m^3, of water: the paper's mass over its volume


def values():
    volume = math.pi / 6 * DIAMETER**3
    return volume, DENSITY * volume


def items(data_dir, out_dir):
    volume, mass = values()
    deepest = at_depth(data_dir / 'pipette.csv', 45e-6)
    rows = [
        item('Table I', 'cell volume', VOLUME, f'{1e18 * volume:.0f}', 'um^3',
             verdict(1e18 * volume, float(VOLUME), ROUNDING)),
        item('Table I', 'cell mass', MASS, f'{1e6 * mass:.4e}', 'mg', verdict(1e6 * mass, float(MASS), ROUNDING),
             'with the density of water, which the paper must have taken')]
    name, quantity, paper = 'Table I', 'maximum indentation depth', '40 to 44'
    if deepest is None:
        return rows + [missing(name, quantity, paper, 'um', 'the round pipette')]
    return rows + [item(name, quantity, paper, '45 and more', 'um', DIFFERENCE,
                        'a limit of the experiment (puncture), not of the model: a neo-Hookean cell under a round '
                        'pipette has a converged solution there')]


def section(data_dir, out_dir):
    volume, mass = values()
    rows = [('Young modulus', '17.9 kPa', 'taken over'), ('Poisson ratio', '0.49', 'taken over'),
            ('diameter', '56 um', 'taken over'), ('volume', '91952 um^3', f'{1e18 * volume:.1f} um^3'),
            ('mass', '9.1952e-5 mg', f'{1e6 * mass:.4e} mg'), ('mesh', '123 vertices, 379 tetrahedra', 'see Table III')]
    return ('## Table I: the homogeneous cell\n\n' + table(('', 'paper', 'ours'), rows) +
            '\n\n(Section III.B of the paper names a mesh of "1115 vertices and 322 tetrahedra": no mesh can have so '
            'few '
            'tetrahedra for its vertices; it is Table III\'s first, 115 and 332, misprinted.)')
