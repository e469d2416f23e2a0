"""A held cell's scene, and the mesh of its half section, refined where the cell touches the lip."""
import math

import getfem
import numpy
import yaml
from scipy.spatial import Delaunay

FINEST, FINE_ZONE = 1 / 4, 2  # edge radii: longest edge of an element at the lip at factor 1, and how far around it
GROWTH, COARSEST = 0.3, 1 / 6  # of the longest edge with the distance from there; radii of the cell
SOUTH = 1  # region: the lower half of the surface


class Scene:
    """The scene's lengths in the bore's radius. unit_length: m, unit_stress: Pa, crest: z of the lip's crest."""

    def __init__(self, path):
        with open(path, encoding='utf-8') as file:
            self.path, self.document = path, yaml.safe_load(file)
        self.unit_length, self.unit_stress, self.poisson, diameter, outer, edge = [self.positive(key) for key in (
            'holding_pipette/mouth/inner_radius', 'cell/material/young_modulus', 'cell/material/poisson_ratio',
            'cell/diameter', 'holding_pipette/mouth/outer_radius', 'holding_pipette/mouth/edge_radius')]
        self.radius, self.outer, self.edge = (x / self.unit_length for x in (diameter / 2, outer, edge))
        if self.document['cell']['material'].get('model') != 'neo_hookean' or self.poisson >= 0.5:
            raise ValueError(f'{path}: cell/material must be a neo_hookean model of a poisson_ratio below 0.5')
        if self.outer < 1 + 2 * self.edge or self.radius <= 1 + self.edge:
            raise ValueError(f'{path}: enlarge outer_radius to inner_radius + 2 edge_radius, cell/diameter over the bore')
        self.touch = self.radius * (1 + self.edge) / (self.radius + self.edge)  # r of the circle of first contact
        self.crest = self.edge - math.sqrt((self.radius + self.edge) ** 2 - (1 + self.edge) ** 2)

    def positive(self, key):
        """Returns the number of a key like cell/diameter; YAML reads 56e-6 as a text."""
        value = self.document
        try:
            for part in key.split('/'):
                value = value[part]
            value = float(value)
        except (KeyError, TypeError, ValueError):
            value = math.nan
        if not 0 < value < math.inf:
            raise ValueError(f'{self.path}: {key} must be given as a positive number')
        return value


def round_off(points, segments):
    """Returns the points of a polygon of this many sides from pole to pole, moved along rays to fill the half disc."""
    step = math.pi / segments
    angle = numpy.arctan2(points[..., 1], points[..., 0]) + math.pi / 2
    away = angle - step * (numpy.clip(numpy.floor(angle / step), 0, segments - 1) + 0.5)
    return points * (numpy.cos(away) / math.cos(step / 2))[..., None]


def make_mesh(scene, factor):
    """Returns the quadratic mesh of the half disc of a scene, the sizes of all elements times a factor."""
    count, radius = round(1 / (COARSEST * factor)), scene.radius
    segments = [round(math.pi * k) for k in range(1, count + 1)]
    points = radius / count * numpy.array([(0, 0)] + [
        (math.sin(math.pi * j / m) * k if 0 < j < m else 0, -math.cos(math.pi * j / m) * k)
        for k, m in enumerate(segments, 1) for j in range(m + 1)])
    linear = getfem.Mesh('empty', 2)
    linear.add_convex(getfem.GeoTrans('GT_PK(2,1)'), points[Delaunay(points).simplices].transpose(2, 1, 0))
    touch = numpy.array([scene.touch, -math.sqrt(radius ** 2 - scene.touch ** 2)])
    while True:
        corners = round_off(linear.pts()[:, linear.pid_from_cvid()[0]].T.reshape(-1, 3, 2), segments[-1])
        longest = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max(axis=1)
        distance = numpy.linalg.norm(corners - touch, axis=2).min(axis=1)
        allowed = FINEST * scene.edge + GROWTH * numpy.maximum(distance - FINE_ZONE * scene.edge, 0)
        large = longest > factor * allowed
        if not large.any():
            break
        linear.refine(linear.cvid()[large])
    nodes = corners[:, [0, 0, 1, 0, 1, 2]] / 2 + corners[:, [0, 1, 1, 2, 2, 2]] / 2
    for middle, ends in ((1, (0, 2)), (3, (0, 5)), (4, (2, 5))):
        outside = (numpy.linalg.norm(nodes[:, ends], axis=2) > radius * (1 - 1e-9)).all(axis=1)
        nodes[outside, middle] *= radius / numpy.linalg.norm(nodes[outside, middle], axis=1)[:, None]
    mesh = getfem.Mesh('empty', 2)
    mesh.add_convex(getfem.GeoTrans('GT_PK(2,2)'), nodes.transpose(2, 1, 0))
    faces, middles = mesh.outer_faces(), nodes.mean(axis=1)
    on_axis = mesh.normal_of_faces(faces)[0] < -1 + 1e-9
    mesh.set_region(SOUTH, faces[:, ~on_axis & (middles[faces[0], 1] < 0)])
    return mesh
