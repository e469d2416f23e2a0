"""A pipette's mouth on an incompressible half-space: the closed forms of Theret and others, and the same half-space with the
gap that a sphere and a rounded lip leave, from which the wall that is in contact follows."""
import numpy
from scipy.special import ellipe, ellipk

MODULUS_RATIO = 0.75  # (1 - nu^2) of an incompressible body


def disc(r, radius):
    """@returns (n,) rise of the surface at the distances r, times the modulus, under a unit suction on a disc (Johnson, "Contact
    mechanics", 1985, ch. 3.4)"""
    r = numpy.asarray(r, dtype=float)
    inside = numpy.minimum(r / radius, 1)**2
    k = numpy.minimum(radius / numpy.maximum(r, radius), 1)**2
    outer = r * (ellipe(k) - (1 - k) * ellipk(numpy.minimum(k, 1 - 1e-15)))
    return 4 * MODULUS_RATIO / numpy.pi * numpy.where(r <= radius, radius * ellipe(inside), outer)


class RingPressures:
    """Pressures on rings between `edges` (ascending, over the bore's radius) that hold a surface at given heights."""

    def __init__(self, edges):
        self.edges, self.middle = edges, (edges[1:] + edges[:-1]) / 2
        self.area = numpy.pi * numpy.diff(edges**2)
        self.fall = self.under(self.middle)

    def under(self, r):
        """@returns (n, rings), fall of the surface at r by a unit pressure on each ring, times the modulus"""
        return numpy.stack([disc(r, high) - disc(r, low) for low, high in zip(self.edges, self.edges[1:])], axis=1)

    def solve(self, heights, touching, force=None):
        """@returns (rings,) pressures, and how far the pipette is shifted along its axis: by nothing, or so that the pressures
        bear the force. heights: the surface's without them, over the pipette's own."""
        rings = numpy.flatnonzero(touching)
        n = len(rings)
        matrix, right = numpy.eye(n + 1), numpy.zeros(n + 1)
        matrix[:n, :n], right[:n] = self.fall[numpy.ix_(rings, rings)], heights[rings]
        if force is not None:
            matrix[:n, n], matrix[n, :n], matrix[n, n], right[n] = 1, self.area[rings], 0, force
        found = numpy.linalg.solve(matrix, right)
        pressures = numpy.zeros(len(self.area))
        pressures[rings] = found[:n]
        return pressures, found[n]


def flat_phi(wall, held):
    """Phi of L/a = 3 Phi dp / (2 pi E) of a flat mouth that is in contact all over: 2 for an infinite wall (a pressurised penny
    crack).
    @param wall its width over the bore's radius. @param held False: the wall does not move, as in Theret's closed form; True:
    its force balances the suction, as that of a cell that nothing else holds"""
    rings = RingPressures(1 + wall * (1 - numpy.cos(numpy.linspace(0, numpy.pi, 301))) / 2)
    pressures, shift = rings.solve(disc(rings.middle, 1), numpy.ones(300, dtype=bool), numpy.pi if held else None)
    centre = numpy.zeros(1)
    return 2 * numpy.pi / 3 * (disc(centre, 1) - rings.under(centre) @ pressures - shift)[0]


def tongue(suction, radius, edge, outer, rings=400):
    """@returns length of the tongue from the lip's crest, and the radii between which the lip is in contact. Unilateral, without
    friction; the gap before contact is that of a sphere and the lip's roundings. All lengths over the bore's radius, suction over
    the modulus."""
    crest, end = 1 + edge, outer - edge
    flat = crest + (end - crest) * numpy.linspace(0, 1, 3 * rings // 4 + 1)**1.7
    edges = numpy.concatenate([numpy.linspace(1, crest, rings // 8 + 1)[:-1], flat, numpy.linspace(end, outer, rings // 8 + 1)[1:]])
    wall = RingPressures(edges)
    r = wall.middle
    off = numpy.maximum(crest - r, 0) + numpy.maximum(r - end, 0)
    gap = radius - numpy.sqrt(radius**2 - r**2) + edge - numpy.sqrt(numpy.maximum(edge**2 - off**2, 0))
    heights = suction * disc(r, crest) - gap
    touching = (r > 1 + edge / 2) & (r < crest + 0.3 * (end - crest))
    for _ in range(200):
        pressures, shift = wall.solve(heights, touching, suction * numpy.pi * crest**2)
        into = heights - wall.fall @ pressures - shift
        after = (touching & (pressures > 0)) | (~touching & (into > 1e-12))
        if (after == touching).all():
            break
        touching = after
    else:
        raise RuntimeError(f'no contact found at a suction of {suction} E')
    centre = numpy.zeros(1)
    length = (suction * disc(centre, crest) - wall.under(centre) @ pressures - shift)[0]
    return length, r[touching].min(), r[touching].max()
