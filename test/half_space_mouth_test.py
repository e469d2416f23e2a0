"""A mouth on a half-space: a crack's closed form, balance, and the wall that touches."""
import math
import sys
import unittest
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'benchmark' / 'peers'))

from half_space_mouth import RingPressures, disc, flat_phi, tongue  # noqa: E402


class HalfSpaceMouth(unittest.TestCase):

    def test_suction_on_a_disc_lifts_its_edge_by_two_over_pi_of_its_middle(self):
        middle, edge = disc([0, 1], 1)
        self.assertAlmostEqual(middle, 2 * 0.75, places=12)  # 2 (1 - nu^2) p a / E
        self.assertAlmostEqual(edge / middle, 2 / math.pi, places=9)
        self.assertAlmostEqual(disc([1 + 1e-9], 1)[0], edge, places=6)
        self.assertAlmostEqual(disc([100], 1)[0], 0.75 * math.pi / (math.pi * 100), places=6)  # of a point's force

    def test_an_infinite_wall_is_a_penny_shaped_crack(self):
        for held in (False, True):
            self.assertAlmostEqual(flat_phi(20, held), 2, delta=1e-3)

    def test_a_fixed_wall_has_the_closed_forms_spread(self):
        phis = [flat_phi(wall, False) for wall in (1, 0.5, 0.2)]
        self.assertEqual(phis, sorted(phis))
        self.assertTrue(2 < phis[0] and phis[-1] < 2.1, phis)

    def test_the_wall_of_a_held_cell_bears_the_suction(self):
        rings = RingPressures(numpy.linspace(1, 2, 101))
        pressures, _ = rings.solve(disc(rings.middle, 1), numpy.ones(100, dtype=bool), math.pi)
        self.assertAlmostEqual((pressures * rings.area).sum(), math.pi, places=9)

    def test_a_sphere_without_curvature_touches_all_over(self):
        (first, _, outside), (second, _, _) = (tongue(p, 1e5, 0.01, 2.0) for p in (0.04, 0.05))
        self.assertGreater(outside, 1.97)
        self.assertAlmostEqual(2 * math.pi / 3 * (second - first) / 0.01, flat_phi(1, True), delta=0.01)

    def test_a_sphere_touches_less_of_the_wall_and_grows_a_longer_tongue(self):
        def phi_and_contact(radius):
            (first, _, outside), (second, _, _) = (tongue(p, radius, 0.02, 2.0) for p in (0.02, 0.04))
            return 2 * math.pi / 3 * (second - first) / 0.02, outside

        (flat, wide), (round_, narrow) = phi_and_contact(200), phi_and_contact(20)
        self.assertGreater(round_, flat + 0.1)
        self.assertLess(narrow, wide - 0.2)


if __name__ == '__main__':
    unittest.main()
