#!/usr/bin/python3
"""A cell under a holding pipette's suction, in GetFEM. Usage: SCENE.yaml P1,P2,... RESULT.csv [--size-factor F]

P1, P2, ...: gauge pressures in the bore, Pa, below 0, solved on meshes of sizes F, F/sqrt2 and F/2. RESULT.csv has the last
one's tongue length (crest's plane to lower pole), height (pole to pole) and error of the length, m; forces of the lip and
of the suction along z, and |P| pi s^2, s where the suction ends, N. Inside, the bore's radius a and Young's modulus are 1.

P2-P1: p replaces lambda ln J. The lip is an augmented Lagrangian: a soft penalty, whose pressures become multipliers until
the penetration is nearly 0. The suction fades out about the middle of the contact. A point of the section is X = (r, z).
"""
import argparse
import csv
import math
import sys
import time

import getfem
import numpy
import yaml

from getfem_held_scene import SOUTH, Scene, make_mesh

PENALTY = 100  # Young's moduli over the edge radius
SPRING = 0.02  # Young's moduli times a: holds the whole cell along z, from where it was a solution before
SPRING_SHARE = 1e-6  # of the suction's force that the spring may hold at the end
STILL = 3e-4  # edge radii: the suction's end's last move, and ten times the mean penetration
FADE = 1  # standard deviations of the contact's force: the length over which the suction fades
TOLERANCE, ITERATIONS = 1e-8, 15  # of Newton's method: largest residual in the suction's force
LARGEST_CHANGE = 0.5  # edge radii: of an iteration
FIRST_STEP, SMALLEST_STEP, LARGEST_STEP = 2e-4, 1e-9, 0.05  # Young's moduli, of pressure; the first over e/a
SECTION, GRADIENT, HOOP = '*(2*pi*X(1))', '(Id(2)+Grad_u)', '(1+u(1)/X(1))'


class HeldCell:
    """The cell on one mesh. Forces are in Young's modulus times a^2, pressures in Young's modulus."""

    def __init__(self, scene, factor):
        self.scene, self.suction, self.step = scene, 0.0, FIRST_STEP * scene.edge
        mesh = self.mesh = make_mesh(scene, factor)  # GetFEM crashes once it is gone
        whole, pressures = getfem.MeshFem(mesh, 2), getfem.MeshFem(mesh, 1)
        whole.set_fem(getfem.Fem('FEM_PK(2,2)'))
        pressures.set_fem(getfem.Fem('FEM_PK(2,1)'))
        at, along = whole.basic_dof_nodes(), numpy.arange(whole.nbdof()) % 2 == 1
        kept = numpy.flatnonzero((at[0] > 1e-9) | along)  # nothing moves off the axis
        field = self.field = getfem.MeshFem('partial', whole, kept)
        self.inside, self.surface = [getfem.MeshIm(mesh, getfem.Integ(f'IM_TRIANGLE({order})')) for order in (6, 13)]
        self.model = getfem.Model('real')
        self.model.add_fem_variable('u', field)
        self.model.add_fem_variable('p', pressures)
        self.model.add_initialized_fem_data('before', field, numpy.zeros(len(kept)))
        self.points = getfem.MeshImData(self.surface, SOUTH, [1])
        self.model.add_im_data('multiplier', self.points)
        for name, value in (('edge', scene.touch), ('width', scene.edge / 2), ('suction', 0.0)):
            self.model.add_initialized_data(name, value)
        self.add_terms()
        begin = self.model.interval_of_variable('u')[0]
        self.displacements = slice(begin, begin + len(kept))
        heights = numpy.where((at[0] < 1e-9) & along, at[1], 0)[kept]
        self.poles = begin + numpy.array([heights.argmin(), heights.argmax()])
        self.state = numpy.zeros(self.model.nbdof())

    def add_terms(self):
        """Adds the energies of the cell, the lip and the spring, and the virtual work of the suction."""
        scene, nu = self.scene, self.scene.poisson
        mu, lam = 1 / (2 * (1 + nu)), nu / ((1 + nu) * (1 - 2 * nu))
        self.round_off = 1e-16 * lam * scene.radius ** 2  # of the residual
        growth, spring = f'log(Det{GRADIENT}*{HOOP})', SPRING / (4 / 3 * math.pi * scene.radius ** 3)
        energy = f'{mu / 2!r}*(Norm_sqr{GRADIENT}+sqr{HOOP}-3)+(p-{mu!r})*{growth}-sqr(p)/{2 * lam!r}'
        self.model.add_nonlinear_term(self.inside, f'({energy}+{spring / 2!r}*sqr(u(2)-before(2)))' + SECTION)
        self.spring = f'{spring!r}*(u(2)-before(2))' + SECTION
        r, over, stiffness = '(X(1)+u(1))', f'(X(2)+u(2)-({scene.crest - scene.edge!r}))', PENALTY / scene.edge
        beyond = (f'{1 + scene.edge!r}-{r}', f'{r}-{scene.outer - scene.edge!r}', over)
        from_core = f'sqrt(2*({"+".join(f"half_sqr_pos_part({x})" for x in beyond)}))'
        self.gap = f'({from_core}-{scene.edge!r})'
        self.contact = f'pos_part(multiplier-{stiffness!r}*{self.gap})'  # pressure on the undeformed area
        self.lift = f'{self.contact}*pos_part{over}/{from_core}' + SECTION
        energy = f'half_sqr_pos_part(multiplier-{stiffness!r}*{self.gap})*{1 / stiffness!r}'
        self.model.add_nonlinear_term(self.surface, energy + SECTION, SOUTH)
        fading = 'min(1,max(0,0.5+(edge-X(1)-before(1))/width))'
        self.pull = f"suction*{fading}*(2*pi*{r})*Det{GRADIENT}*(Inv{GRADIENT}'*Normal)"
        self.model.add_nonlinear_term(self.surface, f'({self.pull}).Test_u', SOUTH, False, False)

    def integral(self, expression, method=None):
        """Returns an integral over the lower surface, or with the method for its inside over the cell."""
        return getfem.asm('generic', method or self.surface, 0, expression, -1 if method else SOUTH, self.model)

    def newton(self, state, largest):
        """Returns the equilibrium for the present data, with this largest residual; None where none is found."""
        for _ in range(ITERATIONS):
            self.model.to_variables(state)
            try:
                self.model.assembly('build_rhs')
            except RuntimeError:  # an element is turned inside out
                return None
            residual = -numpy.ravel(self.model.rhs())
            if not numpy.isfinite(residual).all():
                return None
            if numpy.abs(residual).max() <= largest:
                return state
            self.model.assembly('build_matrix')
            change = numpy.ravel(getfem.linsolve_mumps(self.model.tangent_matrix(), -residual))
            size = numpy.abs(change[self.displacements]).max() / self.scene.edge
            state = state + min(1.0, LARGEST_CHANGE / size) * change
        return None

    def settled(self):
        """Returns whether the spring's rest, the suction's end and the multipliers have followed; else has them follow."""
        suction, still = abs(self.model.variable('suction')[0]), STILL * self.scene.edge
        force, middle, square, gap = [self.integral(f'{self.contact}*{weight}' + SECTION) for weight in (
            '1', '(X(1)+u(1))', 'sqr(X(1)+u(1))', f'neg_part{self.gap}')]
        middle, spread = middle / force, math.sqrt(max(square / force - (middle / force) ** 2, 0))
        spring = abs(self.integral(self.spring, self.inside)) / (math.pi * suction)
        moved = abs(middle - self.model.variable('edge')[0])
        if max(moved, 10 * gap / force) < still and spring < SPRING_SHARE:
            return True
        self.model.set_variable('edge', middle)
        self.model.set_variable('width', max(FADE * spread, self.scene.edge / 20))
        self.model.set_variable('multiplier', self.model.interpolation(self.contact, self.points, SOUTH))
        self.model.set_variable('before', self.model.variable('u'))
        return False

    def load(self, target):
        """Leads the cell to this suction, below 0, in as many steps as it takes."""
        settled = False
        while not settled:
            ahead = max(target, self.suction - self.step)
            self.model.set_variable('suction', ahead)
            state = self.newton(self.state, TOLERANCE * math.pi * abs(ahead) + self.round_off)
            if state is None:
                self.step = min(self.step, self.suction - ahead) / 4
                if self.step < SMALLEST_STEP:
                    raise ValueError(f'no equilibrium found beyond {self.suction * self.scene.unit_stress:.4g} Pa')
                continue
            self.step = min(LARGEST_STEP, max(self.step, 3 * (self.suction - ahead)))
            self.state, self.suction = state, ahead
            settled = self.settled() and ahead == target

    def measures(self):
        """Returns tongue length, height, the lip's force along z, the suction's, and |suction| pi s^2."""
        south, north = self.state[self.poles]
        return [self.scene.crest + self.scene.radius - south, 2 * self.scene.radius + north - south,
                self.integral(self.lift), abs(self.integral(f'({self.pull})(2)')),
                abs(self.suction) * math.pi * self.model.variable('edge')[0] ** 2]


def solve(scene, suctions, factor):
    """Returns the measures under each suction, one row each."""
    start, cell, rows = time.time(), HeldCell(scene, factor), {}
    for suction in sorted(suctions, reverse=True):
        cell.load(suction)
        rows[suction] = cell.measures()
    lengths = ' '.join(f'{1e6 * scene.unit_length * row[0]:.6f}' for row in rows.values())
    print(f'size factor {factor:.3f}: {lengths} um in {time.time() - start:.0f} s', flush=True)
    return [rows[suction] for suction in suctions]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ('scene', 'pressures', 'result'):
        parser.add_argument(name)
    parser.add_argument('--size-factor', type=float, default=1.0)
    options = parser.parse_args([' ' * word[1:2].isdigit() + word for word in sys.argv[1:]])  # -50 is no option
    pressures = [float(part) for part in options.pressures.split(',')]
    if not all(-math.inf < pressure < 0 for pressure in pressures):
        raise ValueError(f'{options.pressures.strip()}: each pressure must be below 0 Pa, such as -50,-250')
    getfem.util_trace_level(0)
    scene = Scene(options.scene.strip())
    suctions = [pressure / scene.unit_stress for pressure in pressures]
    runs = numpy.array([solve(scene, suctions, options.size_factor * x) for x in (1, math.sqrt(0.5), 0.5)])
    first, second = abs(numpy.diff(runs[:, :, 0], axis=0))
    errors = numpy.maximum(first / 2, second)
    units = scene.unit_length * numpy.array([1, 1] + [scene.unit_length * scene.unit_stress] * 3)
    with open(options.result, 'w', newline='', encoding='utf-8') as file:
        table = csv.writer(file)
        table.writerow(['pressure_pa', 'tongue_length_m', 'height_m', 'contact_force_n', 'suction_force_n',
                        'suction_on_circle_n', 'tongue_error_m'])
        for pressure, row, error in zip(pressures, units * runs[2], scene.unit_length * errors):
            table.writerow([f'{value:.7g}' for value in (pressure, *row, error)])


if __name__ == '__main__':
    try:
        main()
    except (ValueError, OSError, yaml.YAMLError) as problem:
        sys.exit(f'getfem_held_cell.py: {problem}')
