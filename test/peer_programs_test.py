#!/usr/bin/python3
"""What CalculiX and GetFEM are given by ./dev bench peers: input, and energies. Neither has to be installed."""
import math
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'benchmark' / 'peers'))
sys.path.insert(0, str(ROOT / 'test'))

import calculix_cell  # noqa: E402
import getfem_energy  # noqa: E402
import numpy  # noqa: E402
import peer_format  # noqa: E402
from in_folder import InFolder  # noqa: E402
from peer_case import CASE  # noqa: E402


class CalculiX(InFolder):
    def test_input_and_output(self):
        case = peer_format.read_case(self.write('case', CASE))
        text = calculix_cell.input_text(case)
        self.assertIn('*ELEMENT,TYPE=C3D4,ELSET=L0\n1,1,2,3,4\n', text)
        self.assertIn('*ELASTIC\n0.0179,0.45\n', text)
        self.assertNotIn('NLGEOM', text)
        self.assertEqual(text.count('*STEP'), 2)
        self.assertIn('GLUED,3,3,-0.2\n', text)
        output = ' total force (fx,fy,fz) for set HELD and time  0.1E+01\n\n   1.0E+00  2.0E+00  3.0E+00\n'
        self.assertEqual(calculix_cell.read_forces(2 * output, 3), [3e-6, 3e-6])
        self.assertAlmostEqual(calculix_cell.read_forces(output, 2)[0], 360e-6)

    def test_the_law_is_the_isochoric_one_of_the_same_moduli(self):
        lines = calculix_cell.material(0, 'neo_hookean', 3e6, 0.25)
        self.assertEqual([float(value) for value in lines[2].split(',')], [0.6, 1.0])  # mu/2 and 2/K with mu 1.2, K 2


class GetFEM(unittest.TestCase):
    GRADIENT = numpy.array([[0.1, 0, 0.05], [0, -0.07, 0], [0.02, 0, 0.03]])  # without twist
    MU, LAMBDA = 1.2, 0.9

    def energy(self, law, dimension, mixed=False, pressure=0.0):
        """The value of an energy in GetFEM's language, at a point of radius 2; that of a section is per angle."""
        young = self.MU * (3 * self.LAMBDA + 2 * self.MU) / (self.LAMBDA + self.MU)
        poisson = self.LAMBDA / (2 * (self.LAMBDA + self.MU))
        text = getfem_energy.strain_energy(law, young, poisson, dimension, mixed)
        gradient = self.GRADIENT if dimension == 3 else self.GRADIENT[numpy.ix_((0, 2), (0, 2))]
        radius = 2.0
        words = {'Id': lambda n: numpy.matrix(numpy.eye(n)), 'Grad_u': numpy.matrix(gradient), 'log': math.log, 'pow': pow,
                 'Det': numpy.linalg.det, 'Trace': numpy.trace, 'Norm_sqr': lambda a: float(numpy.square(a).sum()),
                 'Sym': lambda a: (a + a.T) / 2, 'sqr': lambda a: a * a, 'X': lambda k: radius, 'pi': math.pi, 'p': pressure,
                 'u': lambda k: radius * self.GRADIENT[1, 1]}
        value = eval(text.replace("'", '.T'), words)  # noqa: S307
        return value / (2 * math.pi * radius) if dimension == 2 else value

    def test_has_the_energies_of_the_materials(self):
        gradient = numpy.eye(3) + self.GRADIENT
        green, strain = (gradient.T @ gradient - numpy.eye(3)) / 2, (self.GRADIENT + self.GRADIENT.T) / 2
        log = math.log(numpy.linalg.det(gradient))
        stretches = numpy.linalg.svd(gradient, compute_uv=False)
        first, jacobian, m = (gradient ** 2).sum(), math.exp(log), 4 / 3 * self.MU
        expected = {
            'stable_neo_hookean': m / 2 * (first - 3) - m / 2 * math.log((first + 1) / 4) - 0.75 * m * (jacobian - 1)
            + (self.LAMBDA + 5 / 6 * self.MU) / 2 * (jacobian - 1) ** 2,
            'ogden': self.MU / 8 * ((stretches ** 4).sum() - 3) - self.MU / 2 * log + self.LAMBDA / 2 * log ** 2,
            'gent': -15 * self.MU * math.log(1 - (first - 3) / 30) - self.MU * log
            + (self.LAMBDA - self.MU / 15) / 2 * log ** 2,
            'linear': self.MU * (strain ** 2).sum() + self.LAMBDA / 2 * numpy.trace(strain) ** 2,
            'st_venant_kirchhoff': self.MU * (green ** 2).sum() + self.LAMBDA / 2 * numpy.trace(green) ** 2,
            'neo_hookean': self.MU / 2 * ((gradient ** 2).sum() - 3) - self.MU * log + self.LAMBDA / 2 * log ** 2,
            'neo_hookean_isochoric': self.MU / 2 * (math.exp(-2 / 3 * log) * (gradient ** 2).sum() - 3)
            + (self.LAMBDA / 2 + self.MU / 3) * (math.exp(log) - 1) ** 2}
        for law, value in expected.items():
            for dimension in (2, 3):
                with self.subTest(f'{law}, {dimension}'):
                    self.assertAlmostEqual(self.energy(law, dimension), value, 12)
        self.assertIsNone(getfem_energy.strain_energy('corotated', 1, 0.3, 3, False))

    def test_a_materials_own_numbers_are_the_defaults(self):
        header = (ROOT / 'src' / 'cell' / 'material' / 'material.h').read_text(encoding='utf-8')
        for name, value in (('ogden_exponent', getfem_energy.OGDEN_EXPONENT), ('gent_limit', getfem_energy.GENT_LIMIT)):
            self.assertIn(f'double {name} = {value};', header)

    def test_a_stationary_pressure_leaves_the_energy(self):
        log = math.log(numpy.linalg.det(numpy.eye(3) + self.GRADIENT))
        self.assertAlmostEqual(self.energy('neo_hookean', 3, True, self.LAMBDA * log), self.energy('neo_hookean', 3), 12)


if __name__ == '__main__':
    unittest.main()
