"""Table II and Figures 2, 3 and 11 to 13: the tensegrity cell."""
import math

import numpy

from common import DIFFERENCE, MEASURED_FORCE, NOT_REPRODUCIBLE, REPRODUCED, item, missing, table, verdict
from tensegrity_data import curve, figure_13, members, numbers, rows_of, slack_cables, values
from tensegrity_pictures import draw_depth, draw_prestress, draw_shapes

TUBULE = 5e-9                 # m, diameter of a microtubule in Table II
MESH = {'vertices': 1014, 'tetrahedra': 1798}
SIZE = 0.05                   # relative, that these may be off
TENTH = 0.1 * MEASURED_FORCE  # N


def tasks(programs, root, data_dir):
    return [('tensegrity', [programs['paper_tensegrity'], '--out', str(data_dir)], 900)]


def slope(depths, forces, depth):
    """Force over depth at a depth, N/m; None where the curve ends before."""
    if not depths or depths[-1] < depth:
        return None
    return float(numpy.interp(depth, depths, forces)) / depth


def items_of_table(data_dir):
    found = members(data_dir)
    if not found:
        return [missing('Table II', 'sections from the bending stiffness', 'I = BS / E', '', 'the tensegrity program')]
    tubule = found['microtubule']
    diameter, printed = 2 * tubule['filament_radius_m'], tubule['bending_stiffness_Nm2']
    rod = tubule['young_modulus_Pa'] * math.pi * TUBULE**4 / 64
    return [
        item('Table II', 'diameter of a microtubule, from I = BS / E', f'D = {1e9 * TUBULE:.0f}',
             f'{1e9 * diameter:.3g}', 'nm', verdict(diameter, TUBULE, SIZE),
             f'the table contradicts itself: a solid rod of {1e9 * TUBULE:.0f} nm and the printed E has EI = '
             f'{rod:.1e} N m2, {printed / rod:.0f} times below the printed BS of {printed:.1e}. BS is used; 25 nm is what is known of '
             'microtubules from elsewhere'),
        item('Table II', 'Euler load of one microtubule, hinged, as long as a strut', 'not given',
             f'{1e12 * tubule["filament_euler_N"]:.3g}', 'pN', DIFFERENCE,
             'a strut of one filament buckles under a ten-millionth of the forces shown: struts must be bundles, of a number '
             'of filaments that the paper does not give')]


def items_of_mesh(data_dir):
    found = numbers(data_dir)
    if not found:
        return [missing('Figure 3', 'mesh of the struts', '1014 / 1798', '', 'the tensegrity program')]
    relative = found['residual_N'] / found['prestress_N']
    same_size = all(verdict(found[f'strut_{key}'], count, SIZE) == REPRODUCED for key, count in MESH.items())
    served = found['force_99_s'] < 1e-3 and found['invalid_share'] == 0
    return [
        item('Figure 3', 'vertices and tetrahedra of the struts', '1014 / 1798',
             f'{found["strut_vertices"]:.0f} / {found["strut_tetrahedra"]:.0f}', '',
             REPRODUCED if same_size else DIFFERENCE),
        item('Figure 2', 'unbalanced force at rest over prestress', 'not given', f'{relative:.1e}', '',
             REPRODUCED if relative < 1e-9 else DIFFERENCE),
        item('Section III.C', 'stable explicit step of the tensegrity cell', 'not given',
             f'{1e9 * found["step_s"]:.2g}', 'ns', DIFFERENCE,
             f'true mass, bundles; {1e12 * found["single_filament_step_s"]:.2g} ps for elements as thin as one '
             'microtubule: a thousandth of a second is a million steps and more. It is solved implicitly'),
        item('Section V.B', 'force update of the tensegrity cell (median, 99 %)', '1 to 3.3 (300 Hz to 1 kHz)',
             f'{1e3 * found["force_median_s"]:.2g}, {1e3 * found["force_99_s"]:.2g}', 'ms',
             REPRODUCED if served else DIFFERENCE,
             f'extrapolated from the last solution, which a thread of its own makes in {1e3 * found["solution_median_s"]:.0f} ms '
             f'(median) of processor time; {100 * found["invalid_share"]:.2g} % of the forces were not valid')]


def items_of_loads(data_dir):
    loads = rows_of(data_dir, 'loads')
    result = []
    for case, where, name in ((1, 'middle', 'middle of a strut'), (2, 'end', 'end of a strut')):
        rows = [row for row in loads if row['case'] == where]
        if not rows:
            result.append(missing('Figure 11', f'case {case}, {name}', 'picture', '', 'the tensegrity program'))
            continue
        last = rows[-1]
        result.append(item('Figure 11', f'case {case}, {name}: force, mean and largest displacement of strut ends',
                           'picture',
                           f'{1e6 * last["force_N"]:.3g} uN at {1e6 * last["depth_m"]:.0f} um; '
                           f'{1e6 * last["mean_end_m"]:.2g}, {1e6 * last["largest_end_m"]:.2g} um', '', DIFFERENCE,
                           'the paper shows pictures without figures: that one load moves all of the structure is '
                           'reproduced, by how much is that of the assumed counts'))
    return result


def items_of_prestress(data_dir):
    result, ratios = [], {}
    for where, name in (('end', "on a strut's end"), ('between', 'on the membrane between ends')):
        stiffness = {}
        for prestrain in values(data_dir, 'figure_12', 'prestrain'):
            found = slope(*curve(data_dir, 'figure_12', where, prestrain=prestrain), 5)
            if found is not None:
                stiffness[prestrain] = found
        if len(stiffness) < 2:
            result.append(missing('Figure 12', f'stiffening with prestress {name}', 'yes', '', 'the tensegrity program'))
            continue
        low, high = min(stiffness), max(stiffness)
        ratios[where] = ratio = stiffness[high] / stiffness[low]
        stiffens = 1.1 < ratio and (where == 'end' or ratio < ratios.get('end', ratio))
        result.append(item('Figure 12', f'force at 5 um {name}, prestrain {high:g} over {low:g}',
                           'more' if where == 'end' else 'more, less pronounced', f'{ratio:.3g}', '',
                           REPRODUCED if stiffens else DIFFERENCE,
                           'there the membrane alone bears the needle: whether the structure below is felt depends on the '
                           'membrane, of which the paper gives nothing' if where == 'between' and not stiffens else ''))
    return result


def hardening(data_dir, where):
    """{prestrain: slope at the end of a curve of figure 12 over that at the touch}"""
    result = {}
    for prestrain in values(data_dir, 'figure_12', 'prestrain'):
        depths, forces = curve(data_dir, 'figure_12', where, prestrain=prestrain)
        if len(depths) > 2:
            slopes = numpy.diff(forces) / numpy.diff(depths)
            result[prestrain] = float(slopes[-1] / slopes[0])
    return result


def items_of_hardening(data_dir):
    ratios = hardening(data_dir, 'end')
    quantity = "slope at the end of the curve over that at the touch, on a strut's end (prestrain)"
    if not ratios:
        return [missing('Figure 12', quantity, 'above 1: strain hardening', '', 'the tensegrity program')]
    slack = ', '.join(f'{slack_cables(data_dir, "end", prestrain, 10)} ({100 * prestrain:g} %)' for prestrain in ratios)
    return [item('Figure 12', quantity, 'above 1: strain hardening',
                 ', '.join(f'{ratio:.2g} ({100 * prestrain:g} %)' for prestrain, ratio in ratios.items()), '',
                 REPRODUCED if min(ratios.values()) > 1 else DIFFERENCE,
                 'cables are slack at first where there is no prestress, and tighten; with prestress all bear from the '
                 f'touch on, and some go slack as the end goes down, which softens: at 10 um {slack} of 36')]


def items_of_depth(data_dir):
    curves = [entry for entry in figure_13(data_dir) if entry[1]]
    if not curves:
        return [missing('Figure 13', 'force at 45 um', '0.75', 'uN', 'the tensegrity program')]
    count, depths, forces = curves[-1]
    tubules = members(data_dir)['microtubule']['count']
    share = max(forces) * 1e-6 / MEASURED_FORCE
    return [item('Figure 13', f"force on a strut's end at {depths[-1]:.0f} um (largest on the way)", '0.75 at 45 um',
                 f'{forces[-1]:.2g} ({max(forces):.2g} at {depths[int(numpy.argmax(forces))]:.0f} um)', 'uN',
                 DIFFERENCE if 0.05 < share < 0.2 else NOT_REPRODUCIBLE,
                 f'with {count} filaments in a cable and {tubules:.0f} microtubules in a strut, which are fitted: the force is '
                 'proportional to the first, and Table II alone (one each) gives a hundredth of it at the most. It rises less '
                 'than linearly and falls in the end, since cables go slack, where the measured one stiffens')]


def items(data_dir, out_dir):
    return (items_of_table(data_dir) + items_of_mesh(data_dir) + items_of_loads(data_dir) + items_of_prestress(data_dir)
            + items_of_hardening(data_dir) + items_of_depth(data_dir))


def table_of_members(data_dir):
    rows = []
    for kind, row in members(data_dir).items():
        rows.append((kind, f'{row["young_modulus_Pa"]:.3g}', f'{row["bending_stiffness_Nm2"]:.2g}',
                     f'{1e9 * row["filament_radius_m"]:.3g}', f'{1e18 * row["filament_section_m2"]:.3g}',
                     f'{1e9 * row["filament_EA_N"]:.3g}', f'{1e12 * row["filament_euler_N"]:.2g}' if kind == 'microtubule' else '',
                     f'{row["count"]:.0f}', f'{1e9 * row["radius_m"]:.3g}', f'{1e6 * row["EA_N"]:.3g}',
                     f'{1e6 * row["rest_force_N"]:.2g}', f'{1e6 * row["euler_N"]:.3g}' if kind == 'microtubule' else ''))
    return table(('member', 'E (Pa)', 'BS = EI (N m2)', 'radius (nm)', 'S (nm2)', 'ES (nN)', 'Euler load (pN)',
                  'filaments', 'bundle radius (nm)', 'ES (uN)', 'at rest (uN)', 'Euler load (uN)'), rows)


def table_of_bending(data_dir):
    rows = {}
    for row in rows_of(data_dir, 'bending'):
        rows.setdefault((int(row['count']), row['radius_m']), {})[f'{row["element"]}, {row["slices"]:.0f}'] = row['ratio']
    kinds = ('p1, 32', 'p1, 128', 'p2, 32')
    return table(('microtubules', 'radius (nm)') + tuple(f'{kind} slices' for kind in kinds),
                 [(count, f'{1e9 * radius:.3g}') + tuple(f'{found[kind]:.3g}' if kind in found else '-' for kind in kinds)
                  for (count, radius), found in rows.items()])


def section(data_dir, out_dir):
    if not rows_of(data_dir, 'curves') or not rows_of(data_dir, 'shapes'):
        return '## The tensegrity cell\n\nNo result in this run.'
    draw_shapes(data_dir, out_dir)
    draw_prestress(data_dir, out_dir)
    draw_depth(data_dir, out_dir)
    found, tubule = numbers(data_dir), members(data_dir)['microtubule']
    need = (TENTH / tubule['filament_euler_N'])
    return f"""## The tensegrity cell (section III.A, Table II, Figures 2, 3 and 11 to 13)

Six struts, two in each direction, 24 actin cables, 12 of intermediate filaments, all prestressed, and a membrane through the
twelve strut ends (`config/cells/mouse_oocyte_tensegrity.yaml`). The paper's "12 cables ... connected to the parallel struts"
are here all four connections between the ends of the two struts of each pair, its two sides and its two diagonals: no other
choice of end-to-end cables has 12 and the symmetry of the structure. The printed equation (10) lacks the section S in its
viscous term, and its text swaps l and l0; meant is equation (9) times S.

### Table II

{table_of_members(data_dir)}

One filament on the left, the bundles of this report on the right. A strut of one microtubule buckles (Euler, hinged, {1e6 * tubule['length_m']:.0f} um)
under {1e12 * tubule['filament_euler_N']:.2g} pN; that a strut bears a tenth of the measured force, {1e6 * TENTH:.2g} uN, takes {need:.2g} filaments that slide on
each other or {need ** 0.5:.0f} that are bonded (their number squared).

**P1 tetrahedra lock in bending**, more so the thinner the strut: bending stiffness of the strut's mesh over that of the beam,

{table_of_bending(data_dir)}

With the paper's number of tetrahedra a slice is {1e6 * tubule['length_m'] / 32:.1f} um long. The excess grows as the square of its length over the radius, so that a
strut as thin as one microtubule bends thousands of times too hard and would never buckle; it takes some ten thousand slices, or
second-order tetrahedra (`element: p2`), or a bundle as thick as its slices are long, where a factor of two remains. An explicit
step at the true mass must be below {1e9 * found['step_s']:.2g} ns for the bundles, and {1e12 * found['single_filament_step_s']:.2g} ps for elements as thin as one microtubule
(waves run at {found['wave_speed_m_s']:.0f} m/s). At rest {found['residual_N']:.1e} N are not balanced, of a prestress of {found['prestress_N']:.1e} N.

### Figures 2, 3 and 11

![the structure at rest and under two loads](figure_11.png)

Struts brown, actin blue, intermediate filaments green, slack cables grey; the membrane is solved with, but not drawn, as in the
paper. Both loads (arrows) act from above, on the strut below the cell's top.

### Figure 12: stiffening with prestress

![force against depth for several prestresses](figure_12.png)

### Figure 13: about a tenth of the measured force

![force against depth](figure_13.png)

On the left the three that the paper's figure compares: the measurement (the puncture, which its text tells), the
homogeneous nonlinear cell (here converged neo-Hookean under the round pipette, since St-Venant-Kirchhoff ends early) and the
tensegrity cell.
On the right what the struts are made of changes: linear tetrahedra, the paper's, take a strut's rotation for a strain.
Where a curve's stable equilibria end the structure snaps aside, and the curve goes on from where it comes to rest; a curve that
stops has no stable rest nearby that was found."""
