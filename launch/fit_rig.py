"""The rig's URDF for a cell of another size: holding pipette, dish, objective and the needle's start follow the cell."""

from xml.etree import ElementTree

HEIGHTS = {  # joint of the URDF: what its origin's z is
    "start_height": "world_to_manipulator_base",
    "mouth_height": "world_to_holding_pipette"}
FLOOR = -60e-6  # m, of the dish in the file
BELOW = ("world_to_dish", "world_to_objective")  # joints whose origin sinks with the floor


class Rig:
    """Heights (m, world) and sizes of a rig, from its URDF."""

    def __init__(self, path, error):
        """Raises `error`, a class of exceptions, with messages for the user."""
        self._path, self._error = path, error
        builder = ElementTree.TreeBuilder(insert_comments=True)
        try:
            self._tree = ElementTree.parse(path, ElementTree.XMLParser(target=builder))
        except (OSError, ElementTree.ParseError) as reason:
            raise error(f"{path}: {reason}") from reason
        for joint in (*HEIGHTS.values(), "manipulator_z"):
            self._joint(joint)
        self.start_height, self.mouth_height = (self._z(joint) for joint in HEIGHTS.values())
        self.floor_height = FLOOR
        limits = [self._joint(f"manipulator_{axis}").find("limit") for axis in "xyz"]
        self.axis_speed = min(float(limit.get("velocity")) for limit in limits)
        self.travel = -float(limits[2].get("lower"))  # m, down from the start
        self.pipette_radius = self._cylinder("holding_pipette")[0]
        self.pipette_length = self._cylinder("holding_pipette")[1]
        self._file = self._numbers()

    def _numbers(self):
        return {name: value for name, value in vars(self).items() if not name.startswith("_")}

    def _joint(self, name):
        joint = self._tree.getroot().find(f"joint[@name='{name}']")
        if joint is None:
            raise self._error(f"{self._path}: has no joint {name}")
        return joint

    def _z(self, joint):
        origin = self._joint(joint).find("origin")
        return float(origin.get("xyz").split()[2]) if origin is not None else 0.0

    def _cylinder(self, link):
        cylinder = self._tree.getroot().find(f"link[@name='{link}']/collision/geometry/cylinder")
        return (float(cylinder.get("radius")), float(cylinder.get("length")))

    def scale(self, factor, mouth_radius):
        """Fits everything to a cell of `factor` times the size, with `mouth_radius` (m; 0: unknown) of its holder."""
        if factor != 1:
            for name in ("start_height", "mouth_height", "floor_height", "travel", "pipette_length"):
                setattr(self, name, float(f"{factor * getattr(self, name):.6g}"))
        self._cell_factor = factor
        if mouth_radius:
            self.pipette_radius = float(f"{3 * mouth_radius:.6g}")

    def override(self, values, path):
        allowed = sorted(set(self._file) - {"axis_speed"})
        for name, value in values.items():
            if name not in allowed:
                raise self._error(f"{path}: unknown key rig/{name}; allowed: {', '.join(allowed)}")
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise self._error(f"{path}: rig/{name} = {value}: must be a number, in m")
            setattr(self, name, float(value))

    def misfits(self, radius, depth):
        """@param radius: m, of the cell; @param depth: m, that the needle may go into it"""
        found = []
        if self.start_height <= radius:
            found.append(f"rig/start_height = {self.start_height:g} m: the needle starts in the cell; must be above its "
                         f"radius, {radius:g} m")
        if self.start_height - self.travel > radius - depth:
            found.append(f"rig/travel = {self.travel:g} m: the needle does not reach injection_controller/depth_limit; must be "
                         f"at least {self.start_height - radius + depth:g} m")
        if self.mouth_height > -0.8 * radius or self.mouth_height < -1.2 * radius:
            found.append(f"rig/mouth_height = {self.mouth_height:g} m: the holding pipette does not hold the cell; must be "
                         f"about {-radius:g} m")
        if self.floor_height >= self.mouth_height:
            found.append(f"rig/floor_height = {self.floor_height:g} m: the cell lies in the dish's floor; must be below "
                         f"rig/mouth_height = {self.mouth_height:g} m")
        return found

    @property
    def changed(self):
        return self._numbers() != self._file or self._cell_factor != 1

    def text(self):
        """@returns the URDF."""
        root = self._tree.getroot()
        for name, joint in HEIGHTS.items():
            self._set_z(joint, getattr(self, name))
        for joint in BELOW:
            if root.find(f"joint[@name='{joint}']") is not None:
                self._set_z(joint, self._z(joint) + self.floor_height - FLOOR)
        self._joint("manipulator_z").find("limit").set("lower", repr(-self.travel))
        for sphere in root.findall("link[@name='cell']/visual/geometry/sphere"):
            sphere.set("radius", f"{self._cell_factor * float(sphere.get('radius')):.6g}")
        for part in ("visual", "collision"):
            for body in root.findall(f"link[@name='holding_pipette']/{part}"):
                cylinder = body.find("geometry/cylinder")
                cylinder.set("radius", repr(self.pipette_radius))
                cylinder.set("length", repr(self.pipette_length))
                body.find("origin").set("xyz", f"0 0 {self.pipette_length / 2!r}")
        return ElementTree.tostring(root, encoding="unicode")

    def _set_z(self, joint, height):
        element = self._joint(joint)
        origin = element.find("origin")
        if origin is None:
            origin = ElementTree.SubElement(element, "origin")
        x, y, _ = origin.get("xyz", "0 0 0").split()
        origin.set("xyz", f"{x} {y} {height!r}")
