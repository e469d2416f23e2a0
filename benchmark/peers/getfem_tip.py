"""A rigid hemisphere with its shaft in GetFEM: a penalty on the distance of the surface's points from it."""
import getfem
import numpy

PENALTY = 2000  # in moduli of the stiffest layer over the tip's radius
STEPS = 60  # of the tip's radius: what touches in a step slides in it before it sticks


class RoundedTip:
    """The contact term of a model. The tip is at rest relative to `tip`, its lowest point at first contact."""

    def __init__(self, case, mesh, model, region):
        self.model, self.region, self.radius = model, region, 1e6 * case.tip_radius
        self.sticking = case.tip_mode == 'sticking'
        self.largest_step = self.radius / STEPS if self.sticking else self.radius / 30
        dimension = case.dimension
        self.start = numpy.array([0] * (dimension - 1) + [1e6 * case.tip_height + self.radius])
        model.add_initialized_data('centre', self.start)
        axis = dimension
        at = '(X+u-centre)'
        radial = f'sqr({at}(1))' + (f'+sqr({at}(2))' if dimension == 3 else '')
        self.distance = f'(sqrt({radial}+sqr(neg_part({at}({axis}))))-{self.radius!r})'
        self.relative = at
        # GetFEM's methods for elements serve their faces, too.
        simplex = {2: 'IM_TRIANGLE(8)', 3: 'IM_TETRAHEDRON(8)'}[dimension]
        integration = getfem.MeshIm(mesh, getfem.Integ(simplex))
        penalty = PENALTY * max(young for _, young, _ in case.layers) / self.radius
        weight = '*(2*pi*X(1))' if dimension == 2 else ''
        contact = f'sqr(neg_part({self.distance}))'
        if self.sticking:
            self.scalars = getfem.MeshImData(integration, region, [1])
            self.vectors = getfem.MeshImData(integration, region, [dimension])
            model.add_im_data('stuck', self.scalars)
            model.add_im_data('anchor', self.vectors)
            self.stuck = numpy.zeros(self.scalars.nbpts())
            self.anchor = numpy.zeros((self.scalars.nbpts(), dimension))
            contact = f'((1-stuck)*{contact}+stuck*Norm_sqr({at}-anchor))'
        model.add_nonlinear_term(integration, f'{penalty / 2!r}*{contact}{weight}', region)

    def move(self, displacement):
        """displacement: um, of the tip."""
        step = displacement[2:] if len(self.start) == 2 else displacement
        centre = self.start.copy()
        centre[-len(step):] += step
        self.model.set_variable('centre', centre)

    def accept(self):
        """Points that touch stick from now on to where they met the tip, until they are pulled."""
        if not self.sticking:
            return
        at = numpy.reshape(self.model.interpolation(self.relative, self.vectors, self.region), (-1, len(self.start)))
        core = at.copy()
        core[:, -1] = numpy.minimum(core[:, -1], 0)
        length = numpy.linalg.norm(core, axis=1)
        normal = core / numpy.maximum(length, 1e-12)[:, None]
        touching = (self.stuck == 0) & (length < self.radius)
        self.anchor[touching] = at[touching] + (self.radius - length[touching])[:, None] * normal[touching]
        pulled = (self.stuck == 1) & (((at - self.anchor) * normal).sum(axis=1) > 0)
        self.stuck[touching], self.stuck[pulled] = 1, 0
        self.model.set_variable('stuck', self.stuck)
        self.model.set_variable('anchor', self.anchor.ravel())
