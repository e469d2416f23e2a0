#!/usr/bin/python3
"""A rigid needle that pierces a soft cell along a cohesive zone, in GetFEM. Usage: RESULT.csv [options], see --help

The body is the axisymmetric section of a sphere held at its lower pole, or with --block of a cylinder fixed at its
bottom, radius and height both --cell-radius. The needle comes along -z onto the upper pole. What is nearer to the axis
than the hole's radius b is removed from pole to pole. Tractions along r hold the hole's wall closed, on its undeformed
area T = J/d^2 o exp(-o/d) (Xu and Needleman 1994, doi 10.1016/0022-5096(94)90003-5), with opening o >= 0 (deformed r
less b) and toughness J; the peak is J/(e d). The largest o of all steps stays in the exponent, so an opened wall never
heals. The wall slides freely along z. The needle opens the hole as a wedge, and the force tends to that of the energy
balance in a large body, for neo-Hookean rubber F = pi R^2 mu ((1 - x^2) ln(1/x) + 2 x J/(mu R)), x = b/R (Shergold and
Fleck 2004, doi 10.1098/rspa.2004.1315, here for given b). J counts in it as far as the opening R - b spends it: keep d
below (R - b)/5.

The onset is no property of J alone: it grows with the peak J/(e d), and a --flaw of 5 d at the rim removed it. It is
unstable at a given tip. A viscous traction eta J/R do/ds on the wall, s the tip's way, carries the solution
through; it adds to the force in proportion to eta (--damping). RESULT.csv has the depth of the tip below the
undeformed pole, m, force, N, undeformed length of the wall with o > 3 d, m, and energy spent over 2 pi b J, m, a flaw
included. Inside, R and mu are 1. P2-P1: p replaces lambda ln J. A point of the section is X = (r, z); contact is a
penalty.
"""
import argparse
import csv
import math
import time

import getfem
import numpy
import scipy.integrate

PENALTY = 2000  # shear moduli over R: of contact
CLOSED = 500  # shear moduli over R: of a wall that goes inside of b
SMOOTH = 0.005  # R: way over which the contact's stiffness grows to the penalty, half of it before they touch
TOLERANCE, ITERATIONS = 1e-6, 14  # of Newton's method: largest residual, mu R^2
LARGEST_CHANGE = 0.25  # R: of an iteration
LARGEST_STEP, SMALLEST_STEP = 0.08, 1e-9  # R: of the tip
EVEN = 0.4  # R: way from the wall over which elements have one size
WALL, CONTACT = 1, 2
SECTION, GRADIENT, HOOP = '*(2*pi*X(1))', '(Id(2)+Grad_u)', '(1+u(1)/X(1))'


def strain_energy(law, parameter, lam):
    """Returns the energy density over mu. lam: Lame's first constant over mu."""
    square, logarithm = f'(Norm_sqr{GRADIENT}+sqr{HOOP})', f'log(Det{GRADIENT}*{HOOP})'
    if law == 'neo_hookean':
        distortion = f'({square}-3)/2-{logarithm}'
    elif law == 'gent':
        distortion = f'{-parameter / 2!r}*log(1-({square}-3)*{1 / parameter!r})-{logarithm}'
    else:  # Ogden: squares of the stretches in the section are half (sum +- root)
        root = f'sqrt(sqr(Norm_sqr{GRADIENT})-4*sqr(Det{GRADIENT})+1e-8)'
        powers = '+'.join(f'pow((Norm_sqr{GRADIENT}{sign}{root})/2,{parameter / 2!r})' for sign in '+-')
        distortion = f'{2 / parameter ** 2!r}*({powers}+pow({HOOP},{parameter!r})-3)-{2 / parameter!r}*{logarithm}'
    return f'({distortion}+p*{logarithm}-sqr(p)/{2 * lam!r})' + SECTION


def graded(length, size, even, growth):
    """Returns positions from 0 to a length: elements of a size up to `even`, then growing."""
    sizes = []
    while sum(sizes) < length:
        sizes.append(size if sum(sizes) < even else sizes[-1] * growth)
    return numpy.concatenate([[0], numpy.cumsum(sizes)]) * length / sum(sizes)


def section_grid(options, hole, body):
    """Returns points (columns away from the hole, rows down, 2), twice as fine as the elements."""
    def halves(nodes):
        return numpy.sort(numpy.concatenate([nodes, (nodes[1:] + nodes[:-1]) / 2]))
    height = body if options.block else 2 * math.sqrt(body ** 2 - hole ** 2)
    away = halves(graded(body - hole if options.block else body * math.pi / 4, options.size, EVEN, options.growth))
    down = halves(graded(height, options.size, options.fine, options.growth))
    away, down = numpy.meshgrid(away, down, indexing='ij')
    rim = options.rim / options.needle_radius
    s, t = numpy.maximum(1 - away / rim, 0), numpy.maximum(1 - down / rim, 0)
    away, down = away - rim * s * (numpy.sqrt(1 - t ** 2 / 2) - 1), down - rim * t * (numpy.sqrt(1 - s ** 2 / 2) - 1)
    if options.block:
        return numpy.stack([hole + away, -down], axis=-1)
    first, corner = math.asin(hole / body), math.pi / 4
    a, v = away / away.max(), down / down.max()

    def top(a):
        angle = first + (corner - first) * a
        return body * numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=-1)

    def side(v):
        angle = corner + (math.pi - 2 * corner) * v
        return body * numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=-1)

    wall, x, y = numpy.stack([0 * v + hole, height * (0.5 - v)], axis=-1), a[..., None], v[..., None]  # Coons' patch
    up, down = top(a), top(a) * (1, -1)
    left, right = top(0 * a), side(0 * v)
    ends = (1 - x) * ((1 - y) * left + y * left * (1, -1)) + x * ((1 - y) * right + y * side(0 * v + 1))
    return (1 - y) * up + y * down + (1 - x) * wall + x * side(v) - ends


def make_mesh(grid):
    """Returns the quadratic mesh of triangles: the diagonals start at the section's four corners."""
    triangles = []
    for i in range(0, len(grid) - 1, 2):
        for j in range(0, len(grid[0]) - 1, 2):
            cell = grid[i:i + 3, j:j + 3]
            if (i < len(grid) / 2) != (j < len(grid[0]) / 2):
                ends = ((0, 0, 0, 1, 1, 2), (0, 1, 2, 0, 1, 0)), ((2, 2, 2, 1, 1, 0), (2, 1, 0, 2, 1, 2))
            else:
                ends = ((0, 1, 2, 0, 1, 0), (0, 1, 2, 1, 2, 2)), ((0, 1, 2, 1, 2, 2), (0, 0, 0, 1, 1, 2))
            triangles += [cell[nodes] for nodes in ends]
    mesh = getfem.Mesh('empty', 2)
    mesh.add_convex(getfem.GeoTrans('GT_PK(2,2)'), numpy.array(triangles).transpose(2, 1, 0))
    return mesh


def on_side(mesh, points):
    """Returns the faces whose nodes are all among these points."""
    return mesh.faces_from_pid(mesh.pid_from_coords(points.T))


class Puncture:
    """A needle in a body on one mesh. Lengths are in R, stresses in mu."""

    def __init__(self, options):
        self.options, unit = options, options.needle_radius
        self.mu = options.young / (2 * (1 + options.poisson))
        self.toughness, self.d = options.toughness / (self.mu * unit), options.opening / unit
        hole, body = self.hole, self.body = options.hole / unit, options.cell_radius / unit
        grid = section_grid(options, hole, body)
        mesh = self.mesh = make_mesh(grid)
        wall = grid[0][grid[0, :, 0] < hole + 1e-9]
        mesh.set_region(WALL, on_side(mesh, wall))
        mesh.set_region(CONTACT, numpy.hstack([on_side(mesh, grid[:, 0]), on_side(mesh, grid[0])]))
        whole, pressures = getfem.MeshFem(mesh, 2), getfem.MeshFem(mesh, 1)
        whole.set_fem(getfem.Fem('FEM_PK(2,2)'))
        pressures.set_fem(getfem.Fem('FEM_PK(2,1)'))
        at = whole.basic_dof_nodes()
        if options.block:
            held = at[1] < -body + 1e-9
        else:
            held = (at[1] < 0) & (numpy.hypot(*at) > body - 1e-6) & (at[0] < options.held_radius / unit)
        self.field = getfem.MeshFem('partial', whole, numpy.flatnonzero(~held))
        self.inside, self.faces = [getfem.MeshIm(mesh, getfem.Integ(f'IM_TRIANGLE({order})')) for order in (4, 8)]
        model = self.model = getfem.Model('real')
        model.add_fem_variable('u', self.field)
        model.add_fem_variable('p', pressures)
        model.add_initialized_fem_data('before', self.field, numpy.zeros(self.field.nbdof()))
        self.points = getfem.MeshImData(self.faces, WALL, [1])
        model.add_im_data('reached', self.points)
        flaw = f'{1e3 * self.d!r}*Heaviside(X(2)-({wall[0, 1] - options.flaw / unit!r}))'
        model.set_variable('reached', model.interpolation(flaw, self.points, WALL))
        for name, value in (('centre', 0.0), ('damping', 0.0)):
            model.add_initialized_data(name, value)
        self.edge = options.edge_radius / unit if options.edge_radius else 1.0
        self.add_terms()
        begin = model.interval_of_variable('u')[0]
        self.displacements = slice(begin, begin + self.field.nbdof())
        self.pole = body if not options.block else 0.0
        r, z = grid[:, 0].T
        over = z + numpy.sqrt(numpy.maximum(self.edge ** 2 - numpy.maximum(r - 1 + self.edge, 0) ** 2, 0)) - self.edge
        self.state, self.depth = numpy.zeros(model.nbdof()), self.pole - over[r < 1].max()

    def add_terms(self):
        """Adds the energies of body and contact, and the virtual work of the wall."""
        nu, c, d = self.options.poisson, self.toughness, self.d
        self.model.add_nonlinear_term(self.inside, strain_energy(
            self.options.law, self.options.parameter, 2 * nu / (1 - 2 * nu)))
        beside, below = f'(X(1)+u(1)-({1 - self.edge!r}))', '(centre-X(2)-u(2))'
        distance = f'sqrt(2*(half_sqr_pos_part{beside}+half_sqr_pos_part{below})+1e-14)'
        gap = f'({self.edge + SMOOTH / 2!r}-{distance})'
        gaps = gap, f'({gap}-{SMOOTH!r})'
        cubes = [f'pow(2*half_sqr_pos_part{x}+1e-16,1.5)' for x in gaps]
        self.model.add_nonlinear_term(
            self.faces, f'{PENALTY / (6 * SMOOTH)!r}*({cubes[0]}-{cubes[1]})' + SECTION, CONTACT)
        squares = [f'half_sqr_pos_part{x}' for x in gaps]
        self.lift = f'{PENALTY / SMOOTH!r}*({squares[0]}-{squares[1]})*pos_part{below}/{distance}' + SECTION
        largest = 'pos_part(reached+pos_part(u(1)-reached))'
        self.traction = f'{c / d ** 2!r}*exp(-{largest}*{1 / d!r})*pos_part(u(1))-{CLOSED!r}*neg_part(u(1))'
        if self.options.bonded:
            self.traction = f'{CLOSED!r}*u(1)'
        self.model.add_nonlinear_term(
            self.faces, f'({self.traction}+damping*(u(1)-before(1)))*Test_u(1)' + SECTION, WALL, False, False)
        self.largest = largest

    def integral(self, expression, region):
        """Returns the integral over a region of the surface."""
        return getfem.asm('generic', self.faces, 0, expression, region, self.model)

    def residual(self, state):
        """Returns the residual of all unknowns; None where an element is turned inside out."""
        self.model.to_variables(state)
        try:
            self.model.assembly('build_rhs')
        except RuntimeError:
            return None
        residual = -numpy.ravel(self.model.rhs())
        return residual if numpy.isfinite(residual).all() else None

    def newton(self, state):
        """Returns the equilibrium for the present data and the iterations; None where none is found."""
        change, share = 0 * state, 0.0
        for iteration in range(ITERATIONS):
            residual = self.residual(state + share * change)
            while residual is None and share > 0.1:
                share /= 2
                residual = self.residual(state + share * change)
            if residual is None:
                return None, iteration
            state = state + share * change
            if numpy.abs(residual).max() <= TOLERANCE:
                return state, iteration
            self.model.assembly('build_matrix')
            change = numpy.ravel(getfem.linsolve_mumps(self.model.tangent_matrix(), -residual))
            size = numpy.abs(change[self.displacements]).max()
            if not size < 20:
                return None, iteration
            share = min(1.0, LARGEST_CHANGE / size)
        return None, ITERATIONS

    def measures(self):
        """Returns force, length with an opening over 3 d and J-equivalent length."""
        share = f'(1-(1+{self.largest}*{1 / self.d!r})*exp(-{self.largest}*{1 / self.d!r}))'
        return (self.integral(self.lift, CONTACT), self.integral(f'Heaviside(u(1)-{3 * self.d!r})', WALL),
                self.integral(share, WALL))

    def run(self):
        """Lowers the tip; returns rows of depth, force and lengths, in R and mu R^2."""
        rows, step, way, start = [], 0.01, numpy.zeros_like(self.state), time.time()
        eta = self.options.damping * self.toughness
        while self.depth < self.options.depth and time.time() - start < self.options.seconds:
            self.model.set_variable('centre', self.pole - self.depth - step + self.edge)
            self.model.set_variable('damping', eta / step)
            self.model.set_variable('before', self.state[self.displacements])
            state, iterations = self.newton(self.state + step * way)
            if state is None and way.any():
                way = 0 * way
                state, iterations = self.newton(self.state)
            if state is None:
                step /= 3
                if step < SMALLEST_STEP:
                    print(f'no equilibrium found beyond depth {self.depth:.4f} R')
                    break
                continue
            self.model.to_variables(state)
            self.model.set_variable('reached', self.model.interpolation(self.largest, self.points, WALL))
            way, self.state, self.depth = (state - self.state) / step, state, self.depth + step
            rows.append((self.depth, *self.measures()))
            print('depth %.4f force %.4f crack %.3f equivalent %.3f' % rows[-1],
                  f'step {step:.2g} iterations {iterations} {time.time() - start:.0f} s', flush=True)
            if rows[-1][2] > self.options.crack:
                break
            if iterations <= 6:
                step = min(LARGEST_STEP, step * 1.6)
            elif iterations > 9:
                step /= 1.5
        return numpy.array(rows)


def steady_energy(law, parameter, x):
    """Returns the energy in mu R^2 that widens a length of a hole from x R to R in a large incompressible body."""
    def density(a):  # a: hoop stretch
        square = a ** 2 + a ** -2 - 2
        if law == 'gent':
            return -parameter / 2 * math.log(1 - square / parameter)
        power = parameter if law == 'ogden' else 2
        return 2 / power ** 2 * (a ** power + a ** -power - 2)
    # With a^2 = 1 + (1 - x^2)/r^2 over the undeformed r = x e^t.
    return 2 * math.pi * scipy.integrate.quad(
        lambda t: density(math.sqrt(1 + (x ** -2 - 1) * math.exp(-2 * t))) * (x * math.exp(t)) ** 2, 0, 12)[0]


def summary(puncture, rows):
    """Returns lines on the onset (largest force before the first drop by 2 %) and on the crack's last quarter."""
    options, unit, x = puncture.options, puncture.options.needle_radius, puncture.hole
    force = puncture.mu * unit ** 2
    depth, load, _, crack = rows.T
    dropped = numpy.flatnonzero(load < 0.98 * numpy.maximum.accumulate(load))
    onset, last = load[:dropped[0] if dropped.size else None].argmax(), crack > 0.75 * crack[-1]
    spent = 1 - (1 + (1 - x) / puncture.d) * math.exp((x - 1) / puncture.d)
    widened = steady_energy(options.law, options.parameter, x)
    balance = [widened + 2 * math.pi * x * puncture.toughness * share for share in (1, spent)]
    name = 'onset' if dropped.size else 'no drop by 2 %, largest force'
    return [f'{name}: depth {depth[onset]:.4f} R = {unit * depth[onset]:.4g} m, force {load[onset]:.4f} mu R^2 = '
            f'{force * load[onset]:.4g} N, lowest force after it {load[onset:].min():.4f}',
            f'crack {crack[last][0]:.2f} to {crack[-1]:.2f} R: force {load[last].mean():.4f} mu R^2 = '
            f'{force * load[last].mean():.4g} N, from {load[last][0]:.4f} to {load[-1]:.4f}',
            f'balance in a large body {balance[0]:.4f}, '
            f'with the {spent:.4f} J that the opening R - b spends {balance[1]:.4f}']


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('result')
    for name, default, text in (
            ('cell-radius', 40e-6, 'm'), ('held-radius', 20e-6, 'm: of the patch that is held'),
            ('young', 3000.0, 'Pa'), ('poisson', 0.499, ''), ('parameter', 4.0, "Gent's Jm or Ogden's exponent"),
            ('needle-radius', 4e-6, 'm: R'),
            ('edge-radius', 0.0, 'm: of a flat needle; 0: a hemisphere'), ('hole', 2e-6, 'm: b, undeformed'),
            ('toughness', 4e-3, 'J/m^2'), ('opening', 0.4e-6, 'm: d'), ('damping', 0.02, 'eta'),
            ('flaw', 0.0, 'm: length of the wall from the rim that nothing holds'),
            ('rim', 0.8e-6, "m: fillet of the hole's rim"), ('size', 0.1, 'R: elements at the wall'),
            ('fine', 3.0, 'R: depth of the fine elements'), ('growth', 1.35, 'of elements away from there'),
            ('depth', 8.0, 'R: where the run ends'), ('crack', 1.7, 'R: cracked length at which the run ends'),
            ('seconds', 600.0, 's: after which it ends')):
        parser.add_argument('--' + name, type=float, default=default, help=f'{text} (default: {default})')
    parser.add_argument('--law', choices=('neo_hookean', 'gent', 'ogden'), default='neo_hookean')
    parser.add_argument('--block', action='store_true', help='a cylinder in place of the sphere')
    parser.add_argument('--bonded', action='store_true', help='the wall stays closed')
    options = parser.parse_args()
    if not 0 < options.hole < options.needle_radius < options.cell_radius:
        parser.error('give 0 < --hole < --needle-radius < --cell-radius')
    getfem.util_trace_level(0)
    puncture = Puncture(options)
    print(f'{puncture.model.nbdof()} unknowns')
    rows = puncture.run()
    print(*summary(puncture, rows), sep='\n')
    unit, force = options.needle_radius, puncture.mu * options.needle_radius ** 2
    with open(options.result, 'w', newline='', encoding='utf-8') as file:
        table = csv.writer(file)
        table.writerow(['depth_m', 'force_n', 'crack_m', 'equivalent_crack_m'])
        table.writerows([[f'{x:.7g}' for x in row * (unit, force, unit, unit)] for row in rows])


if __name__ == '__main__':
    main()
