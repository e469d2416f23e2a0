"""Robotic cell micro-injection from Python: a cell and its forces, what a record or an image tells of it, and, where ROS
is installed, whole sessions on virtual time.

Lengths are in m, forces in N, moduli in Pa, times in s. The cell's centre is the origin; the needle comes from above,
along -z, and a force is that of the cell on the needle. An error is a ConfigError, which is a ValueError, and has the text
that the commands print: what is wrong, and what is allowed.

    scene = Scene.load('config/cells/mouse_oocyte_injection.yaml')
    cell = Cell(scene)
    depths = numpy.linspace(0, 12e-6, 100)
    tips = cell.tips(depths)            # (100, 3), straight down on the axis
    forces = cell.force(tips)[:, 2]     # (100,), of a microsecond each
"""
import dataclasses
import os
import tempfile

import numpy

from cell_microinjection import _core
from cell_microinjection._core import Calibration, ConfigError, FamilyTongue, Vision, WriteError, aspirate, indent, package_folder

__all__ = ['Calibration', 'Cell', 'ConfigError', 'Estimate', 'Identification', 'Measurement', 'Scene', 'Vision', 'WriteError',
           'aspirate', 'combine_moduli', 'find_tip', 'identify', 'identify_tongue', 'indent', 'load_record', 'measure_cell', 'package_folder', 'render_specimen', 'tongue_family']
__version__ = _core.__version__


class Scene(_core.Scene):
    """One cell, the pipette that holds it and the needle: the keys of a scene file (doc/reference/scene_file.md).

    A scene does not change, so a cell that another thread uses stays what it is; replace() makes another one.
    """

    def __init__(self, keys=None, **sections):
        """keys: a dict as the file has it; or its sections: Scene(cell={...}, needle={...}).
        @raises ConfigError that names the key, its value and what is allowed"""
        super().__init__({**(keys or {}), **sections})

    @staticmethod
    def load(path):
        """@returns the Scene of a file, or of a name of config/cells such as 'mouse_oocyte_injection'."""
        path = os.fspath(path)
        if not os.path.exists(path) and os.sep not in path and not path.endswith('.yaml'):
            path = os.path.join(package_folder(), 'config', 'cells', path + '.yaml')
        scene = Scene.__new__(Scene)
        _core.Scene.__init__(scene, _core.Scene.load(path).to_dict(), path)
        return scene

    def replace(self, changes=None, **more):
        """@returns a Scene with other values: scene.replace({'needle/tip/radius': 2e-6})."""
        changed = super().replace({**(changes or {}), **more})
        scene = Scene.__new__(Scene)
        _core.Scene.__init__(scene, changed.to_dict(), changed.origin)
        return scene

    @staticmethod
    def problems(keys):
        """@returns what is wrong with the keys of a scene, a line each; empty: nothing."""
        try:
            _core.Scene(keys)
        except ConfigError as error:
            return str(error)
        return ''


class Cell(_core.Cell):
    """The force of a scene's cell, by the model that a session would serve (doc/guide/prepare.md#models)."""

    def __init__(self, scene, model='auto', families=None):
        """scene: a Scene, a path or a name of config/cells. model: auto, surrogate or live. families: a folder."""
        self.scene = scene if isinstance(scene, _core.Scene) else Scene.load(scene)
        self._families = families
        super().__init__(self.scene, model, families)

    def tips(self, depths, lateral=(0, 0)):
        """@returns (n, 3), m: places of the tip these depths (m) below where it touches, beside the axis by (x, y)."""
        depths = numpy.atleast_1d(numpy.asarray(depths, dtype=float))
        touch = self.touch(lateral)
        return touch - depths[:, None] * numpy.array([0.0, 0.0, 1.0])

    def __reduce__(self):
        return Cell, (self.scene, self.model, self._families)


@dataclasses.dataclass(frozen=True)
class Estimate:
    """A value with its interval of 95 %; `bounded`: the record bounds it on both sides."""
    value: float
    low: float
    high: float
    bounded: bool
    unit: str


@dataclasses.dataclass(frozen=True)
class Identification:
    """What a record says of a cell under one model."""
    model: str
    estimates: dict            # name -> Estimate, such as 'young_modulus'
    consistent: bool           # the model follows the record
    determined: bool           # each value of the cell has an interval
    warnings: list
    notes: list                # what was done to the record
    noise: float               # N
    misfit: float              # N, what the model cannot follow
    depth: float               # m, of the deepest sample
    position: numpy.ndarray    # m, (n,), of the samples that were used
    force: numpy.ndarray       # N, (n,)
    residuals: numpy.ndarray   # N, (n,)

    def __getitem__(self, name):
        return self.estimates[name]


def identify(record, scene=None, model=None, *, free=(), tip_radius=None, drift='auto', prony_terms=0, intervals=True,
             columns=None, spring_constant=None, segment='', whole=False, families=None, calibration_error=0.0):
    """Finds the cell that a recorded force is of (doc/guide/your_cell.md#you-have-a-recorded-force).

    record: the path of a table as an instrument wrote it; a pandas frame with such columns; or a dict of arrays, such as
        {'time_s': t, 'position_um': z, 'force_nN': f}.
    scene: a Scene, a path or a name, whose sizes hold and whose modulus is searched. model: family (with a scene),
    hertz, shell or membrane. free: ratios of the family to find, too. calibration_error: of the force as a whole,
    relative, half of its interval of 95 %, 0 to 1.
    @returns an Identification
    @raises ConfigError where there is no contact in the record, or a column cannot be found
    """
    if scene is not None and not isinstance(scene, _core.Scene):
        scene = Scene.load(scene)
    model = model or ('family' if scene is not None else 'hertz')

    def run(path):
        return _core.identify_record(path, scene, model, list(free), tip_radius, drift, prony_terms, intervals,
                                     columns or {}, spring_constant, segment, whole, families, calibration_error)

    if isinstance(record, (str, os.PathLike)):
        found = run(os.fspath(record))
    else:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'record.csv')
            _write_table(path, record)
            found = run(path)
    found['estimates'] = {name: Estimate(**each) for name, each in found['estimates'].items()}
    return Identification(**found)


def identify_tongue(pressure, length, scene):
    """Finds the modulus of a cell that suction holds, from images of its tongue (doc/guide/hold.md).

    pressure: (n,), Pa, gauge, at most 0, in the bore. length: (n,), m, of the tongue from any fixed place on the pipette's
    axis, growing into the bore; n is 4 or more. scene: a Scene with holding_pipette/mouth, a path or a name, whose sizes
    hold and whose modulus is searched.
    @returns an Identification: its estimates are young_modulus and offset, of the place from the lip; `noise` and `misfit`
        are in m, `position` has the lengths, `force` is empty
    @raises ConfigError where the tongue does not grow with the suction, or the record is too short
    """
    if not isinstance(scene, _core.Scene):
        scene = Scene.load(scene)
    found = _core.identify_tongue(pressure, length, scene)
    found['estimates'] = {name: Estimate(**each) for name, each in found['estimates'].items()}
    return Identification(**found, notes=[], position=numpy.asarray(length, dtype=float), force=numpy.empty(0))


def tongue_family(scene, families=None):
    """The tongue of a scene's cell from a family of solved ones, in microseconds (doc/guide/hold.md#at-once).

    scene: a Scene with holding_pipette/mouth, a path or a name. families: a folder; default: config/families.
    @returns a FamilyTongue: at(pressures) has the arrays of aspirate(), the slopes over the pressure and the expected
        error of the length, nan where it is not known; outline(pressure) the surface, (n, 2), r and z; strongest and end,
        Pa, the pressures to which it is known and at which the equilibria end
    @raises ConfigError that names what is outside of the families, its value and what is allowed
    """
    return FamilyTongue(scene if isinstance(scene, _core.Scene) else Scene.load(scene), families)


def combine_moduli(force, tongue):
    """Joins the moduli that a force curve and the tongues of one cell tell, with the weights of their intervals.

    force, tongue: the Identifications of identify() and identify_tongue().
    @returns an Identification; it is not `consistent` when the two are of different cells
    """
    found = _core.combine_moduli(*((each.value, each.low, each.high, each.bounded) for each in (force['young_modulus'], tongue['young_modulus'])))
    found['estimates'] = {name: Estimate(**each) for name, each in found['estimates'].items()}
    return Identification(**found, notes=[*force.notes, *tongue.notes], position=numpy.empty(0), force=numpy.empty(0))


def _write_table(path, record):
    names = [str(name) for name in record.keys()]
    values = [numpy.asarray(record[name], dtype=float) for name in record.keys()]
    if not values:
        raise ConfigError('record: must have a column of the position and one of the force')
    for name, each in zip(names, values):
        if each.ndim != 1 or len(each) != len(values[0]):
            raise ConfigError(f'record: {name} has the shape {each.shape}: must be ({len(values[0])},), as {names[0]}')
    numpy.savetxt(path, numpy.column_stack(values), delimiter=',', header=','.join(names), comments='', fmt='%.17g')


@dataclasses.dataclass(frozen=True)
class Measurement:
    """A cell in an image. A length is (value, low, high), m, of 95 %; None: not known."""
    verdict: str               # found, uncertain or not found
    reason: str
    diameter: tuple
    zona_thickness: tuple
    offset: tuple              # of the cell from the holding pipette's axis
    centre: tuple              # px
    polar_body: float          # rad in the image; None: not known


def measure_cell(image, pixel_size, config=None):
    """Measures the cell in an image (doc/guide/your_camera.md#measure-a-cell).

    image: (height, width) or (height, width, 3), uint8 or uint16. pixel_size: m, or a Calibration. config: keys of
    config/vision.yaml.
    @returns a Measurement; only a verdict of 'found' is sure
    """
    if isinstance(pixel_size, Calibration):
        pixel_size = pixel_size.pixel_size
    return Measurement(**Vision(config or {}).see(image, pixel_size)['cell'])


def find_tip(image, direction=None, config=None):
    """Finds the injection pipette's tip in an image.

    direction: rad in the image, from the tip towards the shaft, from x (right) towards y (down); None: any, or with the eyes `geometry` -1.5708.
    @returns a dict: verdict, reason and, unless the verdict is 'not found', place (x, y) and covariance in px,
        direction and half_width
    """
    config = dict(config or {})
    if direction is not None:
        config['injection_pipette'] = {**config.get('injection_pipette', {}), 'direction': float(direction)}
    return Vision(config).see(image, 1e-6)['injection_pipette']


def render_specimen(seed, config=None):
    """Renders a random cell between a holding and an injection pipette, which may press it (doc/design/microscope.md).

    seed: from 0; the same one gives the same image. config: keys of config/microscope.yaml, of the sections camera,
    objective, contrast, illumination and sensor.
    @returns (image, truth): (height, width), uint8 or uint16; and a dict: pixel_size, m; tip, (x, y), px, which may lie
        outside of the image; centre, (x, y), and diameter of the cell without its dimple, px
    """
    return _core.render_specimen(seed, config or {})


def load_record(path):
    """@returns a pandas frame of a session's force_depth.csv, or of the force over the travel in a ROS bag."""
    import pandas
    if os.fspath(path).endswith('.bag'):
        from cell_microinjection.bag import curve_of_bag
        return pandas.DataFrame(curve_of_bag(path))
    return pandas.read_csv(path)


def __getattr__(name):
    """The parts that need ROS are imported when they are asked for."""
    if name in ('Session', 'SessionError'):
        from cell_microinjection import session
        return getattr(session, name)
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
