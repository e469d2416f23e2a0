"""Types of the part that is written in C++; cell_microinjection/__init__.py says what it does."""
from os import PathLike
from typing import Any, Optional, Sequence, Union

import numpy
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[numpy.float64]
__version__: str
trial_observation: tuple[str, ...]
trial_states: tuple[str, ...]


class ConfigError(ValueError): ...


class WriteError(OSError): ...


def package_folder() -> str: ...


class Scene:
    def __init__(self, keys: dict[str, Any], origin: str = ...) -> None: ...
    @staticmethod
    def load(path: Union[str, PathLike[str]]) -> Scene: ...
    def replace(self, changes: dict[str, Any]) -> Scene: ...
    def save(self, path: Union[str, PathLike[str]]) -> None: ...
    def to_dict(self) -> dict[str, Any]: ...
    @property
    def origin(self) -> str: ...
    @property
    def diameter(self) -> float: ...  # m


class Cell:
    def __init__(self, scene: Scene, model: str = ..., families: Optional[str] = ...) -> None: ...
    # tip: (3,) or (n, 3), m. Returns N, of the same shape.
    def force(self, tip: ArrayLike, axis: Optional[ArrayLike] = ..., *, along: bool = ...) -> Floats: ...
    # Returns N/m, (3, 3) or (n, 3, 3): the force changes by -stiffness @ displacement.
    def stiffness(self, tip: ArrayLike, axis: Optional[ArrayLike] = ..., *, along: bool = ...) -> Floats: ...
    def touch(self, lateral: Sequence[float] = ...) -> Floats: ...  # (3,), m
    # vertices and at_rest: (m, 3), m; triangles: (k, 3).
    def surface(self, tip: ArrayLike) -> dict[str, NDArray[Any]]: ...
    @property
    def model(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def expected_error(self) -> Optional[tuple[float, float]]: ...  # median; exceeded by one of ten
    @property
    def family(self) -> Optional[str]: ...
    @property
    def place(self) -> dict[str, tuple[float, float, float]]: ...  # value, low, high
    @property
    def radius(self) -> float: ...  # m


# depth (n,), force (n, 3), error_estimate (n,), converged (n,), reason, wall_time (n,).
def indent(scene: Scene, depths: ArrayLike, *, lateral: Optional[ArrayLike] = ..., speed: Optional[float] = ...,
           hold: float = ..., withdrawal: Optional[ArrayLike] = ..., tolerance: float = ...,
           time: float = ...) -> dict[str, Any]: ...


# Arrays (n,) of pressure, tongue_length, tongue_volume, seal_radius, clamping_force, error_estimate, converged; lists of
# reason and outline, (m, 2): r and z of the deformed surface, m, or None. Pressures: Pa, gauge; default: the scene's.
# finest: halvings of the elements at the lip that may be tried.
def aspirate(scene: Scene, pressures: Optional[ArrayLike] = ..., *, tolerance: float = ...,
             finest: float = ...) -> dict[str, Any]: ...


class FamilyTongue:
    def __init__(self, scene: Scene, families: Optional[str] = ...) -> None: ...
    # Arrays (n,) of pressure, tongue_length, tongue_volume, seal_radius, clamping_force, length_slope (m/Pa),
    # volume_slope (m^3/Pa), expected_error.
    def at(self, pressures: ArrayLike) -> dict[str, Floats]: ...
    def outline(self, pressure: float) -> Optional[Floats]: ...  # (n, 2), m
    @property
    def strongest(self) -> float: ...  # Pa, gauge
    @property
    def end(self) -> float: ...  # Pa, gauge
    @property
    def equilibrium_ends(self) -> bool: ...  # there; else the solution does


# Of each (value, low, high, bounded) of the modulus.
def combine_moduli(force: tuple[float, float, float, bool], tongue: tuple[float, float, float, bool]) -> dict[str, Any]: ...


def suction_trial(seed: int, *, witnesses: str = ...) -> dict[str, Any]: ...


def identify_tongue(pressure: ArrayLike, length: ArrayLike, scene: Scene) -> dict[str, Any]: ...


def identify_record(path: str, scene: Optional[Scene], model: str, free: Sequence[str], tip_radius: Optional[float],
                    drift: str, prony_terms: int, intervals: bool, columns: dict[str, str],
                    spring_constant: Optional[float], segment: str, whole: bool,
                    families: Optional[str], calibration_error: float) -> dict[str, Any]: ...


class Vision:
    def __init__(self, config: dict[str, Any] = ...) -> None: ...
    def see(self, image: NDArray[Any], pixel_size: float) -> dict[str, dict[str, Any]]: ...


# The image, (height, width), and its truth: pixel_size, m; tip and centre, (x, y), and diameter, px.
def render_specimen(seed: int, config: dict[str, Any] = ...) -> tuple[NDArray[Any], dict[str, Any]]: ...


class Calibration:
    @staticmethod
    def load(path: Union[str, PathLike[str]]) -> Calibration: ...
    def pixel(self, place: ArrayLike) -> Floats: ...  # (2,) or (n, 2), px
    def place(self, pixel: ArrayLike, y: float = ...) -> Floats: ...  # (3,), m
    @property
    def date(self) -> str: ...
    @property
    def pixel_size(self) -> float: ...  # m
    @property
    def axes(self) -> Floats: ...  # (2, 3), px/m
    @property
    def backlash(self) -> Floats: ...  # (3,), m
    @property
    def residual(self) -> float: ...  # px


class Trial:
    def __init__(self, seed: int, *, force_delay: float = ..., noise: float = ..., faults: float = ...) -> None: ...
    def step(self, vx: float, vy: float, vz: float, inject: bool = ..., steps: int = ...) -> Floats: ...
    def score(self) -> dict[str, Any]: ...
    @property
    def observation(self) -> Floats: ...
    @property
    def over(self) -> bool: ...
    @property
    def state(self) -> str: ...
    @property
    def notice(self) -> str: ...
    @property
    def true_force(self) -> float: ...  # N
    @property
    def fault(self) -> Optional[dict[str, Any]]: ...
