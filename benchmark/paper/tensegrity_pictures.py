"""Pictures of the tensegrity cell: figures 11, 12 and 13."""
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from common import MEASURED_DEPTH, MEASURED_FORCE, converged, figure, micro, plt, save
from tensegrity_data import curve, figure_13, rows_of, values

COLOUR = {'strut': '#8c564b', 'actin': '#4c78a8', 'intermediate': '#54a24b'}
TENTH = 0.1 * MEASURED_FORCE  # N
LOAD = 14                     # um, length of an arrow


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


def strut_points(rows):
    """[points of one strut, in um]"""
    pieces = [row for row in rows if row['kind'] == 'strut']
    many = len(pieces) // 6
    ends = [[[1e6 * row[f'{axis}{end}_m'] for axis in 'xyz'] for end in (1, 2)] for row in pieces]
    return [[piece[0] for piece in ends[i:i + many]] + [ends[i + many - 1][1]] for i in range(0, 6 * many, many)]


def loaded_point(rest, rows, case):
    """Where the load acts: the middle or the end of a strut that went down most."""
    places = [(before[i], after[i]) for before, after in zip(strut_points(rest), strut_points(rows))
              for i in ((len(before) // 2,) if case == 'middle' else (0, -1))]
    return max(places, key=lambda place: place[0][2] - place[1][2])[1]


def draw_load(axes, point):
    x, y, z = point
    axes.quiver(x, y, z + LOAD + 1.5, 0, 0, -LOAD, color='#d62728', linewidth=2.5, arrow_length_ratio=0.35, zorder=10)


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
        axes = made.add_subplot(1, 3, place, projection='3d')
        draw_shape(axes, shapes[case], title)
        if case != 'rest':
            draw_load(axes, loaded_point(shapes['rest'], shapes[case], case))
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
    made, panels = figure(15, 4.4, 3)
    depths, forces = converged(data_dir / 'pipette.csv')
    panels[0].plot(micro(depths), micro(forces), 's-', color='#777777', markersize=4, label='homogeneous, nonlinear')
    curves = [(f"on a strut's end, {count} filaments a cable", '.-', *found) for count, *found in figure_13(data_dir)]
    curves.append(('on the membrane, between ends', ':', *curve(data_dir, 'figure_13', 'between')))
    for label, style, depths, forces in curves:
        above = [(depth, force) for depth, force in zip(depths, forces) if depth > 0 and force > 0]
        panels[0].plot([depth for depth, _ in above], [force for _, force in above], style)
        panels[1].plot(depths, forces, style, label=label)
    panels[0].plot([1e6 * MEASURED_DEPTH], [1e6 * MEASURED_FORCE], 'k*', markersize=10,
                   label='measured puncture')
    for axes in panels[:2]:
        axes.plot([1e6 * MEASURED_DEPTH], [1e6 * TENTH], 'kx', label='a tenth of the measured force')
        axes.set(xlabel='depth (um)')
    panels[0].set(yscale='log', ylabel='force (uN)', title='Figure 13: all, colours as beside')
    panels[1].set(title='the tensegrity cell')
    depths, forces = curve(data_dir, 'figure_12', 'end', prestrain=0.05)
    panels[2].plot(depths, forces, label='corotated')
    for model in ('st_venant_kirchhoff', 'linear'):
        panels[2].plot(*curve(data_dir, 'models', 'end', model=model), '--', label=model)
    panels[2].set(xlabel='depth (um)', title='material of the struts')
    for axes in panels:
        axes.legend(frameon=False, fontsize=8)
    save(made, out_dir / 'figure_13.png')
