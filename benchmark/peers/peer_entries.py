"""Programs of ./dev bench peers as entries of ./dev bench field."""
import numpy
import peer_process
import peer_programs
from peer_cases import CaseWriter

from cell_microinjection import Scene

PAPER = 'paper'  # meshes in space, made for the paper's cell
DISC = {'needle/tip/shape': 'disc'}  # of a program whose tip sticks to nodes: it knows no contact that grows

# Entry: program, mesh, its level (of the paper's: row of its table, from 0), what the program needs otherwise in the scene,
# steps from depth to depth, and at how many cells it is asked, because it is slow; None: at all.
ENTRIES = {
    'section': ('ours p2_p0', 'section', 0, {}, 1, None),
    'getfem': ('GetFEM p2_p1', 'section', 0, {}, 1, 12),
    'calculix': ('CalculiX', 'section', 0, {'needle/contact/mode': 'sliding'}, 1, 6),
    'bullet': ('Bullet, equilibrium', PAPER, 6, DISC, 4, None),  # it loses the force in larger steps
    'p1': ('ours p1', PAPER, 6, DISC, 1, None),
    'paper': ('ours explicit', PAPER, 3, {**DISC, 'cell/material/model': 'st_venant_kirchhoff'}, 1, None),
}


class Declined(RuntimeError):
    """The program does not serve such cells."""


class Peer:
    """The force of a cell by a program that is started once for each cell, and goes from depth to depth in some steps.

    Meshing and starting the program are no part of a force's time: `times` has the processor time of each force (s) of the
    last cell, that of its steps as the program states it. `cells`: at how many it is asked; None: at all.
    """

    def __init__(self, command, writer, time_limit, mesh, level, changes, steps, cells):  # pylint: disable=too-many-arguments
        self._command, self._writer, self._time_limit = command, writer, time_limit
        self._mesh, self._level, self._changes, self._steps = mesh, level, changes, steps
        self.cells, self.times, self._asked = cells, [], 0

    def force(self, scene, depths):
        """scene: a dict as a scene file; depths: m, (n,), each one deeper.
        @returns N, along the pipette, (n,); nan where there is no solution
        @raises Declined; RuntimeError when the program fails"""
        self.times, self._asked = [], self._asked + 1
        scale, scene = self._sized(Scene(scene).replace(self._changes))
        name = str(self._asked)
        scene.save(self._writer.folder / f'{name}.yaml')
        count = self._steps * len(depths)
        motion = numpy.interp(numpy.arange(1, count + 1) / self._steps, range(len(depths) + 1), [0, *depths])
        case = self._writer.write(name, self._mesh, self._level, (1e6 * scale * motion).tolist())
        outcome = peer_process.run(self._command, case, count, self._time_limit)
        if outcome.verdict.startswith(peer_process.DECLINED):
            raise Declined(outcome.verdict)
        if outcome.verdict != peer_process.DONE:
            raise RuntimeError(outcome.verdict)
        self.times = numpy.reshape(outcome.result.times, (-1, self._steps)).sum(axis=1)
        forces = numpy.array(outcome.result.forces)[self._steps - 1::self._steps, 2]
        return forces / scale**2  # F = E R^2 f(depth / R)

    def _sized(self, scene):
        """@returns (scale, scene): as large as the paper's cell where the mesh is the paper's"""
        if self._mesh != PAPER:
            return 1.0, scene
        scale, keys = Scene.load('mouse_oocyte').diameter / scene.diameter, scene.to_dict()
        return scale, scene.replace({'cell/diameter': scale * scene.diameter,
                                     'needle/tip/radius': scale * keys['needle']['tip']['radius'],
                                     'holding_pipette/contact_radius': scale * keys['holding_pipette']['contact_radius']})


def entries(programs, folder, time_limit):
    """programs: folder of those that were built. folder: of the cases. time_limit: s, for a program on one cell.
    @returns ({name: Peer}, {name: why it cannot enter})"""
    installed = {program.name: program for program in peer_programs.programs(programs)}
    found, missing = {}, {}
    for name, (program, *how) in ENTRIES.items():
        if not (programs / 'peer_write_case').exists():
            missing[name] = f'{programs} has no peer_write_case'
        elif installed[program].missing:
            missing[name] = f'not installed: {installed[program].missing}'
        else:
            writer = CaseWriter(programs / 'peer_write_case', folder / name, None, {})
            found[name] = Peer(installed[program].command, writer, time_limit, *how)
    return found, missing
