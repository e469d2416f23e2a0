"""Table II and Figures 2, 3 and 11 to 13: the tensegrity cell."""
import numpy
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from common import (DIFFERENCE, MEASURED_DEPTH, MEASURED_FORCE, NOT_REPRODUCIBLE, REPRODUCED, figure, item, missing, plt,
                    read, save, table, verdict)

MEMBERS = ('actin', 'microtubule', 'intermediate')
COLOUR = {'strut': '#8c564b', 'actin': '#4c78a8', 'intermediate': '#54a24b'}
TUBULE = 12.5e-9              # m, radius of a microtubule: not the paper's
MESH = {'vertices': 1014, 'tetrahedra': 1798}
SIZE = 0.05                   # relative, that these may be off
TENTH = 0.1 * MEASURED_FORCE  # N


def tasks(programs, root, data_dir):
    return [('tensegrity', [programs['paper_tensegrity'], '--out', str(data_dir)], 900)]


def rows_of(data_dir, name):
    return read(data_dir / f'tensegrity_{name}.csv')


def members(data_dir):
    return {row['kind']: row for row in rows_of(data_dir, 'members')}


def numbers(data_dir):
    return {row['quantity']: row['value'] for row in rows_of(data_dir, 'numbers')}


def curve(data_dir, name, where='end', **chosen):
    """(depths in um, forces in uN) of one curve."""
    rows = [row for row in rows_of(data_dir, 'curves') if row['curve'] == name and row['where'] == where
            and all(row[key] == value for key, value in chosen.items())]
    return [1e6 * row['depth_m'] for row in rows], [1e6 * row['force_z_N'] for row in rows]


def values(data_dir, name, key):
    return sorted({row[key] for row in rows_of(data_dir, 'curves') if row['curve'] == name})


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
    return [
        item('Table II', 'radius of a microtubule from I = BS / E', 'not given (known: 12.5)',
             f'{1e9 * tubule["filament_radius_m"]:.3g}', 'nm', verdict(tubule['filament_radius_m'], TUBULE, SIZE)),
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
    served = found['force_99_s'] < 1e-3 and found['untrusted_share'] == 0
    return [
        item('Figure 3', 'vertices and tetrahedra of the struts', '1014 / 1798',
             f'{found["strut_vertices"]:.0f} / {found["strut_tetrahedra"]:.0f}', '',
             REPRODUCED if same_size else DIFFERENCE),
        item('Figure 2', 'unbalanced force at rest over prestress', 'not given', f'{relative:.1e}', '',
             REPRODUCED if relative < 1e-9 else DIFFERENCE),
        item('section III.C', 'stable explicit step of the tensegrity cell', 'not given', f'{1e9 * found["step_s"]:.2g}', 'ns',
             DIFFERENCE, f'true mass, bundles; {1e12 * found["single_filament_step_s"]:.2g} ps for elements as thin as one '
             'microtubule: a thousandth of a second is a million steps and more. It is solved implicitly'),
        item('section IV.B', 'force update of the tensegrity cell (median, 99 %)', '1 ms',
             f'{1e3 * found["force_median_s"]:.2g}, {1e3 * found["force_99_s"]:.2g}', 'ms',
             REPRODUCED if served else DIFFERENCE,
             f'extrapolated from the last solution, which a thread of its own makes in {1e3 * found["solution_median_s"]:.0f} ms '
             f'(median) of processor time; {100 * found["untrusted_share"]:.2g} % of the forces could not be trusted')]


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


def figure_13(data_dir):
    """[(count, depths, forces)] on a strut's end."""
    return [(int(count), *curve(data_dir, 'figure_13', 'end', count=count))
            for count in values(data_dir, 'figure_13', 'count')]


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
            + items_of_depth(data_dir))


def draw_shape(axes, rows, title):
    for kind, width in (('intermediate', 0.8), ('actin', 1.2), ('strut', 4)):
        chosen = [row for row in rows if row['kind'] == kind]
        lines = [[[1e6 * row[f'{axis}{end}_m'] for axis in 'xyz'] for end in (1, 2)] for row in chosen]
        slack = [kind != 'strut' and row['force_N'] <= 0 for row in chosen]
        colours = ['#bbbbbb' if loose else COLOUR[kind] for loose in slack]
        axes.add_collection3d(Line3DCollection(lines, colors=colours, linewidths=width))
    axes.set(xlim=(-28, 28), ylim=(-28, 28), zlim=(-28, 28), title=title)
    axes.set_box_aspect((1, 1, 1), zoom=1.35)
    axes.view_init(elev=12, azim=-62)
    axes.set_axis_off()


def draw_shapes(data_dir, out_dir):
    shapes = {}
    for row in rows_of(data_dir, 'shapes'):
        shapes.setdefault(row['case'], []).append(row)
    loads = {row['case']: row for row in rows_of(data_dir, 'loads')}  # the last of each
    titles = {'rest': 'at rest under its prestress'}
    for case, name in (('middle', 'case 1: middle of a strut'), ('end', 'case 2: end of a strut')):
        if case in loads:
            titles[case] = f'{name}\n{1e6 * loads[case]["force_N"]:.2g} uN, {1e6 * loads[case]["depth_m"]:.0f} um'
    made = plt.figure(figsize=(12, 4.4))
    for place, (case, title) in enumerate(titles.items(), 1):
        draw_shape(made.add_subplot(1, 3, place, projection='3d'), shapes[case], title)
    made.subplots_adjust(left=0, right=1, bottom=0, top=0.86, wspace=0)
    save(made, out_dir / 'figure_11.png')


def draw_prestress(data_dir, out_dir):
    made, panels = figure(10.5, 4.4, 2)
    for axes, where, title in zip(panels, ('end', 'between'), ("on a strut's end", 'on the membrane, between ends')):
        for prestrain in values(data_dir, 'figure_12', 'prestrain'):
            depths, forces = curve(data_dir, 'figure_12', where, prestrain=prestrain)
            axes.plot(depths, forces, marker='.', label=f'prestrain {100 * prestrain:g} %')
        axes.set(xlabel='depth (um)', ylabel='force (uN)', title=title)
        axes.legend(frameon=False, fontsize=8)
    save(made, out_dir / 'figure_12.png')


def draw_depth(data_dir, out_dir):
    made, panels = figure(10.5, 4.4, 2)
    for count, depths, forces in figure_13(data_dir):
        panels[0].plot(depths, forces, marker='.', label=f"on a strut's end, {count} filaments a cable")
    panels[0].plot(*curve(data_dir, 'figure_13', 'between'), ':', label='on the membrane, between ends')
    panels[0].plot([1e6 * MEASURED_DEPTH], [1e6 * TENTH], 'k*', label='a tenth of the measured puncture force')
    panels[0].set(xlabel='depth (um)', ylabel='force (uN)', title='Figure 13')
    depths, forces = curve(data_dir, 'figure_12', 'end', prestrain=0.05)
    panels[1].plot(depths, forces, label='corotated')
    for model in ('st_venant_kirchhoff', 'linear'):
        panels[1].plot(*curve(data_dir, 'models', 'end', model=model), '--', label=model)
    panels[1].set(xlabel='depth (um)', title='material of the struts')
    for axes in panels:
        axes.legend(frameon=False, fontsize=8)
    save(made, out_dir / 'figure_13.png')


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
paper. Both loads act from above, on the strut below the cell's top.

### Figure 12: stiffening with prestress

![force against depth for several prestresses](figure_12.png)

### Figure 13: about a tenth of the measured force

![force against depth](figure_13.png)

On the right what the struts are made of changes: linear tetrahedra, the paper's, take a strut's rotation for a strain.
Where a curve's stable equilibria end the structure snaps aside, and the curve goes on from where it comes to rest; a curve that
stops has no stable rest nearby that was found."""
