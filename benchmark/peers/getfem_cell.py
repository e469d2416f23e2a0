#!/usr/bin/python3
"""GetFEM as a program of ./dev bench peers. Usage: ELEMENT [LAW] CASE RESULT, ELEMENT one of p1, p2, p2_p1.

The strain energy of the case is written as such in GetFEM's language, so that it is exactly the case's; LAW replaces it.
In a section all integrals are those of the body of revolution. Lengths are um and stresses Pa, so that forces are pN.
"""
import sys
import time

sys.dont_write_bytecode = True
import getfem  # noqa: E402
import numpy  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

import peer_format  # noqa: E402
from getfem_energy import strain_energy  # noqa: E402
from getfem_tip import RoundedTip  # noqa: E402

TOLERANCE = 1e-7  # of the largest residual, in the largest force on a held component
ITERATIONS = 25
SMALLEST_STEP = 1e-3  # um, of the tip
QUADRATURE = {(2, 1): 'IM_TRIANGLE(2)', (2, 2): 'IM_TRIANGLE(6)', (3, 1): 'IM_TETRAHEDRON(1)', (3, 2): 'IM_TETRAHEDRON(5)'}
# The case's nodes of a quadratic simplex in GetFEM's order, line by line of the lattice.
LATTICE = {2: [0, 3, 1, 5, 4, 2], 3: [0, 4, 1, 6, 5, 2, 7, 8, 9, 3]}
OUTSIDE = 1000  # region of the outer surface; below are the layers


class Cell:
    """A case's cell as a model of GetFEM, solved by Newton's method."""

    def __init__(self, case, element, law=None):
        self.case = case
        self.dimension = case.dimension
        order = 1 if element == 'p1' else 2
        self.points = 1e6 * numpy.array(case.nodes)
        self.mesh = self.make_mesh()
        self.field = getfem.MeshFem(self.mesh, self.dimension)
        self.field.set_fem(getfem.Fem(f'FEM_PK({self.dimension},{order})'))
        integration = getfem.MeshIm(self.mesh, getfem.Integ(QUADRATURE[self.dimension, order]))
        self.model = getfem.Model('real')
        self.model.add_fem_variable('u', self.field)
        mixed = element == 'p2_p1'
        if mixed:
            pressures = getfem.MeshFem(self.mesh, 1)
            pressures.set_fem(getfem.Fem(f'FEM_PK({self.dimension},1)'))
            self.model.add_fem_variable('p', pressures)
        for layer, (name, young, poisson) in enumerate(case.layers):
            self.model.add_nonlinear_term(integration, strain_energy(law or name, young, poisson, self.dimension, mixed),
                                          layer + 1)
        self.tip = None
        if not case.glued:
            self.tip = RoundedTip(case, self.mesh, self.model, OUTSIDE)
        self.constrain()
        self.displacement = numpy.zeros(3)
        self.before, self.last_step = self.state, 0.0  # the equilibrium before, and the length of the step from it, um

    def make_mesh(self):
        """Returns the mesh with a region for each layer and one for the outer surface."""
        case, simplex = self.case, self.dimension
        mesh = getfem.Mesh('empty', simplex)
        order = LATTICE[simplex] if case.order == 2 else list(range(simplex + 1))
        corners = numpy.array([[nodes[k] for k in order] for _, nodes in case.elements])
        layers = numpy.array([layer for layer, _ in case.elements])
        convexes = mesh.add_convex(getfem.GeoTrans(f'GT_PK({simplex},{case.order})'),
                                   self.points[corners].transpose(2, 1, 0))
        convexes = numpy.ravel(convexes)
        for layer in range(len(case.layers)):
            inside = convexes[layers == layer]
            mesh.set_region(layer + 1, numpy.array([inside, 0 * inside - 1]))
        mesh.set_region(OUTSIDE, mesh.outer_faces())
        return mesh

    def constrain(self):
        """Finds the fixed components of the state, and those that follow the tip."""
        begin = self.model.interval_of_variable('u')[0]
        places = self.field.basic_dof_nodes().T
        components = numpy.arange(len(places)) % self.dimension
        axis = self.dimension - 1
        tree = cKDTree(self.points)
        node = tree.query(places)[1]
        held, glued = numpy.isin(node, self.case.held), numpy.isin(node, self.case.glued)
        fixed = held | glued
        if self.dimension == 2:
            fixed |= (places[:, 0] < 1e-9) & (components == 0)
        count = self.model.nbdof()
        free = numpy.ones(count, dtype=bool)
        free[begin:begin + len(places)] = ~fixed
        self.free = numpy.flatnonzero(free)
        self.held = begin + numpy.flatnonzero(held & (components == axis))
        self.fixed = begin + numpy.flatnonzero(fixed)
        self.follows = numpy.zeros((count, 3))
        for k in range(self.dimension):
            to = 2 if k == axis else k
            self.follows[begin + numpy.flatnonzero(glued & (components == k)), to] = 1
        self.state = numpy.zeros(count)

    def residual(self, state):
        """Returns the residual of a state, None where the energy is not defined."""
        self.model.to_variables(state)
        try:
            self.model.assembly('build_rhs')
        except RuntimeError:
            return None
        residual = -numpy.ravel(self.model.rhs())
        return residual if numpy.isfinite(residual).all() else None

    def correction(self, right_hand_side):
        """Returns the change of the free components, with the tangent of the last assembly of a matrix."""
        tangent = getfem.Spmat('copy', self.model.tangent_matrix(), self.free, self.free)
        change = numpy.zeros(len(self.state))
        change[self.free] = numpy.ravel(getfem.linsolve_mumps(tangent, right_hand_side[self.free]))
        return change

    def advance(self, displacement):
        """Moves the tip by one step to this displacement, um; returns whether there is an equilibrium."""
        state = self.predict(displacement)
        if state is None:
            return False
        residual = self.residual(state)
        for _ in range(ITERATIONS):
            if residual is None:
                return False
            if numpy.abs(residual[self.free]).max() <= TOLERANCE * numpy.abs(residual[self.fixed]).max() + 1e-9:
                self.before, self.state, self.displacement = self.state, state, displacement
                self.force = residual[self.held].sum()
                return True
            self.model.assembly('build_matrix')
            state, residual = self.search(state, residual, self.correction(-residual))
        return False

    def predict(self, displacement):
        """Returns the state that the tangent has the tip's nodes lead to; under a rounded tip, the last motion goes on."""
        if self.tip:
            self.tip.move(displacement)
            length = numpy.linalg.norm(displacement - self.displacement)
            share = length / self.last_step if self.last_step else 0
            self.last_step = length
            return self.state + share * (self.state - self.before)
        increment = self.follows @ (displacement - self.displacement)
        residual = self.residual(self.state)
        if residual is None:
            return None
        self.model.assembly('build_matrix')
        return self.state + increment + self.correction(
            -residual - numpy.ravel(self.model.tangent_matrix().mult(increment)))

    def search(self, state, residual, change):
        """Returns the state along a change whose residual is smaller, or the last one tried, and its residual."""
        before = numpy.linalg.norm(residual[self.free])
        for share in (1, 0.5, 0.25, 0.125):
            tried = state + share * change
            residual = self.residual(tried)
            if residual is not None and numpy.linalg.norm(residual[self.free]) < before:
                break
        return tried, residual

    def move(self, target):
        """Moves the tip to a displacement, um, in as many steps as it takes; returns whether it got there."""
        begin, done, step = self.displacement.copy(), 0.0, 1.0
        length = numpy.linalg.norm(target - begin)
        if self.tip:
            step = min(1.0, self.tip.largest_step / length)
        largest = step
        while done < 1 - 1e-9:
            ahead = min(1.0, done + step)
            last_step = self.last_step
            if self.advance(begin + ahead * (target - begin)):
                done, step = ahead, min(largest, 1.5 * step)
                if self.tip:
                    self.tip.accept()
                continue
            self.last_step = last_step
            step /= 2
            if step * length < SMALLEST_STEP:
                return False
        return True


def solve(case, element, law):
    """Returns the Result of a case."""
    result = peer_format.Result(f'GetFEM {getfem.getfem_env("version")}', 'equilibrium', element, law or 'same')
    if (case.order == 1) != (element == 'p1'):
        result.declined = 'the mesh is of another order'
    elif strain_energy(law or case.layers[0][0], 1, 0.3, case.dimension, False) is None:
        result.declined = f'no {case.layers[0][0]} material here'
    elif not case.glued and case.tip_shape != 'hemisphere':
        result.declined = 'discs and hemispheres only'
    if result.declined:
        return result
    cell = Cell(case, element, law)
    lost = False
    for displacement in case.motion:
        start = time.process_time()
        lost = lost or not cell.move(1e6 * numpy.array(displacement))
        result.times.append(time.process_time() - start)
        result.forces.append((0, 0, numpy.nan if lost else 1e-12 * cell.force))
    return result


def main(element, *rest):
    *law, case, result = rest
    getfem.util_trace_level(0)
    getfem.util_warning_level(0)
    text = peer_format.result_text(solve(peer_format.read_case(case), element, law[0] if law else None))
    with open(result, 'w', encoding='utf-8') as file:
        file.write(text)


if __name__ == '__main__':
    main(*sys.argv[1:])
