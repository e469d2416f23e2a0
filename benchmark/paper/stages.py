"""Figure 9: stages of the cell's deformation, as pictures."""
from matplotlib.collections import PolyCollection
from matplotlib.patches import Wedge, Rectangle

from common import DIFFERENCE, MEASURED_DEPTH, item, missing, plt, read, save

RADIUS, TIP = 28, 3  # um


def tasks(programs, root, data_dir):
    return [('stages', [programs['paper_stages'], '--csv', str(data_dir / 'stages.csv')], 300)]


def stages_of(data_dir):
    """{depth in m: rows}"""
    stages = {}
    for row in read(data_dir / 'stages.csv'):
        stages.setdefault(row['depth_m'], []).append(row)
    return stages


def items(data_dir, out_dir):
    name, quantity, paper = 'Figure 9', 'stages of deformation', 'pictures, experiment beside simulation'
    stages = stages_of(data_dir)
    if not stages or max(stages) < MEASURED_DEPTH:
        return [missing(name, quantity, paper, '', 'the stages')]
    return [item(name, quantity, paper, f'figure_9.png, {len(stages)} stages to {1e6 * max(stages):.0f} um', '',
                 DIFFERENCE,
                 'the converged neo-Hookean cell instead of St-Venant-Kirchhoff; the photographs are not published '
                 'as data, '
                 'so that shapes can be compared by eye only')]


def draw(axis, rows, largest):
    for side in (1, -1):
        corners = [[(side * 1e6 * row[f'r{k}_m'], 1e6 * row[f'z{k}_m']) for k in (1, 2, 3)] for row in rows]
        patches = PolyCollection(corners, array=[1e6 * row['displacement_m'] for row in rows], cmap='viridis',
                                 edgecolor='face', linewidth=0.2)
        patches.set_clim(0, largest)
        axis.add_collection(patches)
    depth, force = 1e6 * rows[0]['depth_m'], 1e6 * abs(rows[0]['force_N'])
    bottom = RADIUS - depth
    for patch in (Wedge((0, bottom + TIP), TIP, 180, 360), Rectangle((-TIP, bottom + TIP), 2 * TIP, 80)):
        patch.set(facecolor='#cfd8dc', edgecolor='#607d8b')
        axis.add_patch(patch)
    axis.set(xlim=(-36, 36), ylim=(-34, 40), aspect='equal', title=f'{depth:.0f} um: {force:.2f} uN')
    axis.axis('off')
    return patches


def section(data_dir, out_dir):
    stages = stages_of(data_dir)
    if not stages:
        return '## Figure 9: stages of deformation\n\nNo result in this run.'
    largest = max(1e6 * row['displacement_m'] for rows in stages.values() for row in rows)
    made, axes = plt.subplots(2, 3, figsize=(9.5, 6.6), constrained_layout=True)
    for axis in axes.flat:
        axis.axis('off')
    for axis, depth in zip(axes.flat, sorted(stages)):
        patches = draw(axis, stages[depth], largest)
    made.colorbar(patches, ax=axes, label='displacement (um)', shrink=0.7)
    save(made, out_dir / 'figure_9.png')
    return ('## Figure 9: stages of deformation\n\n![sections](figure_9.png)\n\nThe section through the axis, '
            '`config/cells/mouse_oocyte_pipette.yaml` (neo-Hookean, round pipette, sticking), held at the circle of '
            'the '
            'holding pipette below.')
