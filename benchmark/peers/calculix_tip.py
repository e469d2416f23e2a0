"""A rigid, frictionless hemisphere with its shaft in CalculiX: a ring of quadratic elements whose nodes are all prescribed."""
import math

ARC, SHAFT = 40, 12  # elements along the quarter of a circle and the shaft
LENGTH = 5  # of the shaft, in radii
PENALTY = 4000  # in moduli of the stiffest layer over the tip's radius
NEAR = 2.5  # radii from the pole, of the surface that may touch


def outline(radius):
    """Returns points (r, z) on the tip's surface from its lowest one on, two for each element and the last."""
    points = []
    for k in range(2 * ARC + 1):
        angle = 0.5 * math.pi * k / (2 * ARC)
        points.append((radius * math.sin(angle), radius * (1 - math.cos(angle))))
    points += [(radius, radius * (1 + LENGTH * k / (2 * SHAFT))) for k in range(1, 2 * SHAFT + 1)]
    return points


def tip_input(case, listing):
    """Returns the lines of tip, surfaces and contact."""
    radius, height = 1e6 * case.tip_radius, 1e6 * case.tip_height
    points, inner = outline(radius), outline(0.7 * radius)
    # The inner outline is laid concentric to the outer one.
    inner = [(r, z + 0.3 * radius) for r, z in inner]
    first = len(case.nodes) + 1
    outside = [first + k for k in range(len(points))]
    inside = [first + len(points) + k for k in range(len(points))]
    middle = [first + 2 * len(points) + k for k in range(len(points))]
    lines = ['*NODE,NSET=TIP']
    for numbers, places in ((outside, points), (inside, inner),
                            (middle, [((a + c) / 2, (b + d) / 2) for (a, b), (c, d) in zip(points, inner)])):
        # Middle nodes between those of an element's edge are not part of it.
        lines += [f'{n},{r:.12g},{height + z:.12g},0.' for k, (n, (r, z)) in enumerate(zip(numbers, places))
                  if numbers is not middle or k % 2 == 0]
    lines.append('*ELEMENT,TYPE=CAX8,ELSET=NEEDLE')
    element = len(case.elements)
    for k in range(0, len(points) - 1, 2):
        element += 1
        lines.append(','.join(str(n) for n in (
            element, outside[k], outside[k + 2], inside[k + 2], inside[k], outside[k + 1], middle[k + 2], inside[k + 1],
            middle[k])))
    young = 1e-6 * max(modulus for _, modulus, _ in case.layers)
    stiffness = PENALTY * young / radius
    lines += ['*MATERIAL,NAME=NEEDLE', '*ELASTIC', f'{young!r},0.3', '*SOLID SECTION,ELSET=NEEDLE,MATERIAL=NEEDLE',
              '*SURFACE,NAME=MASTER,TYPE=ELEMENT', 'NEEDLE,S1', '*SURFACE,NAME=SLAVE,TYPE=ELEMENT']
    pole = (0, case.tip_height)
    sides = {}
    for number, (_, nodes) in enumerate(case.elements, 1):
        for side, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), 1):
            sides[frozenset((nodes[a], nodes[b]))] = f'{number},S{side}'
    for facet in case.surface:
        if all(math.dist(case.nodes[node], pole) < NEAR * case.tip_radius for node in facet[:2]):
            lines.append(sides[frozenset(facet[:2])])
    lines += ['*SURFACE INTERACTION,NAME=TOUCH', '*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR', f'{stiffness!r}']
    lines += ['*CONTACT PAIR,INTERACTION=TOUCH,TYPE=SURFACE TO SURFACE', 'SLAVE,MASTER']
    return lines
