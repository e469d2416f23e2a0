#include "cell/mesh/cell_mesher.h"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cell/mesh/circle_on_sphere.h"
#include "cell/mesh/gmsh_session.h"
#include "cell/mesh/size_field.h"
#include "cell/mesh/tet_improvement.h"

namespace microinjection {
namespace {

constexpr int kSurfaceLoop = -2;  ///< gmsh's dimension of surface loops

/// Radius of the sphere's caps around +-y, over the sphere's radius. Imprinted circles are within
/// 0.95 of the z axis and cannot reach the caps.
constexpr double kCapRadius = 0.29;

/// Largest distance of a curve from its imprinted circle, over the sphere's radius. OpenCASCADE's
/// spline is accurate to 1e-6.
constexpr double kOnCurve = 1e-5;

/// Removes a solid and keeps its spherical faces.
gmsh::vectorpair sphericalFaces(const gmsh::vectorpair& solid) {
  namespace occ = gmsh::model::occ;
  occ::synchronize();
  gmsh::vectorpair faces, spherical, others;
  gmsh::model::getBoundary(solid, faces, false, false);
  for (const auto& face : faces) {
    std::string type;
    gmsh::model::getType(face.first, face.second, type);
    (type == "Sphere" ? spherical : others).push_back(face);
  }
  occ::remove(solid);
  occ::remove(others);
  return spherical;
}

/// Pieces of a sphere about the origin: a zone around the y axis and its two caps. Triangles
/// degenerate at the poles of a parametrisation. The zone has no pole, and the poles of the caps
/// are on the z axis, outside of the caps.
gmsh::vectorpair addSphere(double radius) {
  namespace occ = gmsh::model::occ;
  const double latitude = std::acos(kCapRadius), height = std::sin(latitude) * radius;
  gmsh::vectorpair zone = {{3, occ::addSphere(0, 0, 0, radius, -1, -latitude, latitude)}};
  occ::rotate(zone, 0, 0, 0, 1, 0, 0, M_PI / 2);
  gmsh::vectorpair ball = {{3, occ::addSphere(0, 0, 0, radius)}};
  gmsh::vectorpair boxes, pieces, caps;
  for (double y : {height, -2 * radius}) {
    boxes.emplace_back(3, occ::addBox(-2 * radius, y, -2 * radius, 4 * radius, 2 * radius - height, 4 * radius));
  }
  pieces = sphericalFaces(zone);
  std::vector<gmsh::vectorpair> unused;
  occ::intersect(sphericalFaces(ball), boxes, caps, unused);
  pieces.insert(pieces.end(), caps.begin(), caps.end());
  return pieces;
}

/// A vertical cylinder that intersects the unit sphere in the circle only.
gmsh::vectorpair addCylinder(const CircleOnSphere& circle) {
  namespace occ = gmsh::model::occ;
  const int rim = occ::addCircle(circle.centre().x(), circle.centre().y(), 0, circle.radius());
  gmsh::vectorpair extruded, cylinder;
  occ::extrude({{1, rim}}, 0, 0, 2 * circle.side(), extruded);
  std::copy_if(extruded.begin(), extruded.end(), std::back_inserter(cylinder), [](auto e) { return e.first == 2; });
  return cylinder;
}

/// Removes the copies of surfaces that OpenCASCADE leaves behind, because gmsh would mesh them,
/// too.
void removeLooseSurfaces() {
  gmsh::vectorpair surfaces, loose;
  gmsh::model::getEntities(surfaces, 2);
  for (const auto& surface : surfaces) {
    std::vector<int> volumes, curves;
    gmsh::model::getAdjacencies(surface.first, surface.second, volumes, curves);
    if (volumes.empty()) loose.push_back(surface);
  }
  gmsh::model::occ::remove(loose);
  gmsh::model::occ::synchronize();
}

/// The pieces of a sphere joined at their edges, with circles imprinted on them.
gmsh::vectorpair addImprintedSphere(double radius, const std::vector<CircleOnSphere>& circles) {
  namespace occ = gmsh::model::occ;
  const gmsh::vectorpair sphere = addSphere(radius);
  gmsh::vectorpair cylinders, pieces, shell, scrap;
  for (const CircleOnSphere& circle : circles) {
    for (const auto& surface : addCylinder(circle)) cylinders.push_back(surface);
  }
  std::vector<gmsh::vectorpair> pieces_of;  // of each piece of the sphere, then of each cylinder
  occ::fragment(sphere, cylinders, pieces, pieces_of);
  for (std::size_t i = 0; i < pieces_of.size(); ++i) {
    gmsh::vectorpair& heap = i < sphere.size() ? shell : scrap;
    heap.insert(heap.end(), pieces_of[i].begin(), pieces_of[i].end());
  }
  occ::remove(scrap, true);
  return shell;
}

/// Builds a ball of concentric layers in the current gmsh session, in units of its radius. `radii`:
/// of the layers, outermost first; the first is 1. `circles`: curves on the surface that become
/// edges of the geometry, within 0.95 of the z axis. `flattening`: divides all heights (z). Returns
/// gmsh's volumes, outermost first.
std::vector<int> buildCellGeometry(const std::vector<double>& radii, const std::vector<CircleOnSphere>& circles,
                                   double flattening) {
  namespace occ = gmsh::model::occ;
  std::vector<gmsh::vectorpair> spheres = {addImprintedSphere(1, circles)};
  for (std::size_t i = 1; i < radii.size(); ++i) spheres.push_back(addImprintedSphere(radii[i], {}));
  std::vector<int> loops, volumes;
  for (const gmsh::vectorpair& sphere : spheres) {
    std::vector<int> surfaces;
    for (const auto& surface : sphere) surfaces.push_back(surface.second);
    loops.push_back(occ::getMaxTag(kSurfaceLoop) + 1);  // explicit: gmsh 4.8 does not return it
    occ::addSurfaceLoop(surfaces, loops.back());
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const bool innermost = i + 1 == loops.size();
    volumes.push_back(occ::addVolume(innermost ? std::vector{loops[i]} : std::vector{loops[i], loops[i + 1]}));
  }
  occ::synchronize();
  removeLooseSurfaces();
  if (flattening != 1) {
    gmsh::vectorpair solids;
    for (int volume : volumes) solids.emplace_back(3, volume);
    occ::dilate(solids, 0, 0, 0, 1, 1, 1 / flattening);
    occ::synchronize();
  }
  return volumes;
}

/// The circle that gmsh's curve was made for; null for the seams between the pieces of a sphere.
const CircleOnSphere* imprintedCircle(int curve, const std::vector<CircleOnSphere>& circles, double flattening) {
  std::vector<double> low, high, middle;
  gmsh::model::getParametrizationBounds(1, curve, low, high);
  gmsh::model::getValue(1, curve, {(low[0] + high[0]) / 2}, middle);
  const Eigen::Vector3d point(middle[0], middle[1], flattening * middle[2]);
  const CircleOnSphere* nearest = nullptr;
  double distance = kOnCurve;
  for (const CircleOnSphere& circle : circles) {
    const double from_circle = (point - circle.project(point)).norm();
    if (from_circle > distance) continue;
    distance = from_circle;
    nearest = &circle;
  }
  return nearest;
}

/// Increase it when the same configuration gives another mesh than before, or the cache another
/// file.
constexpr int kMesherVersion = 4;

/// Vertices of tetrahedra with a radiusRatio below kPoor are moved. Below kBad the mesher tries
/// again.
constexpr double kPoor = 0.25, kBad = 0.15;

/// Factors on the element size for successive attempts. A few meshes in a hundred have a sliver
/// between two triangles of an interface, or gmsh fails. A slightly finer mesh then has other
/// triangles.
constexpr double kScales[] = {1, 0.98, 0.96, 0.94, 0.92};

// Within gmsh, lengths are in units of the cell's radius, and heights are divided by the elements'
// stretch, so that elements are as high as wide.

struct Vertex {
  Eigen::Vector3d point;
  Mobility mobility;
};
using Vertices = std::map<std::size_t, Vertex>;  // by gmsh's tag

/// Adds the vertices of the closed entities of a dimension, with heights multiplied by `stretch`;
/// entity -1: of all of them.
void addVertices(int dimension, int entity, double stretch, Vertices& vertices) {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters, dimension, entity, true, false);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const double* at = &coordinates[3 * i];
    vertices[tags[i]] = {Eigen::Vector3d(at[0], at[1], stretch * at[2]), {Mobility::Kind::kFree, 0}};
  }
}

/// All vertices; those of spheres and circles are projected onto them to the last bit.
Vertices exactVertices(const std::vector<double>& radii, const std::vector<CircleOnSphere>& circles, double stretch) {
  Vertices vertices, on_sphere;
  addVertices(3, -1, stretch, vertices);
  addVertices(2, -1, stretch, on_sphere);
  for (const auto& [tag, vertex] : on_sphere) {
    const double from_centre = vertex.point.norm();
    const double radius = *std::min_element(radii.begin(), radii.end(), [&](double a, double b) {
      return std::abs(a - from_centre) < std::abs(b - from_centre);
    });
    vertices[tag] = {radius / from_centre * vertex.point, {Mobility::Kind::kOnSphere, radius}};
  }
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  for (const auto& curve : curves) {
    const CircleOnSphere* circle = imprintedCircle(curve.second, circles, stretch);
    if (circle == nullptr) continue;
    Vertices on_circle;
    addVertices(1, curve.second, stretch, on_circle);
    for (const auto& [tag, vertex] : on_circle) vertices[tag] = {circle->project(vertex.point), {}};
  }
  return vertices;
}

/// Adds the tetrahedra of a volume, corners by gmsh's tags.
void addTetrahedra(int volume, std::vector<std::array<std::size_t, 4>>& tetrahedra) {
  constexpr int kTetrahedron = 4;  // gmsh's element type
  std::vector<std::size_t> elements, corners;
  gmsh::model::mesh::getElementsByType(kTetrahedron, elements, corners, volume);
  for (std::size_t t = 0; t < elements.size(); ++t) {
    tetrahedra.push_back({corners[4 * t], corners[4 * t + 1], corners[4 * t + 2], corners[4 * t + 3]});
  }
}

/// `volumes`: outermost first.
TetMesh collectTetrahedra(const std::vector<int>& volumes, const Vertices& vertices) {
  std::vector<std::array<std::size_t, 4>> tetrahedra;
  TetMesh mesh;
  for (std::size_t layer = 0; layer < volumes.size(); ++layer) {
    addTetrahedra(volumes[layer], tetrahedra);
    mesh.layers.resize(tetrahedra.size(), static_cast<int>(layer));
  }
  std::map<std::size_t, int> index;  // of the vertices in use, in the order of their tags
  for (const auto& tetrahedron : tetrahedra) {
    for (std::size_t tag : tetrahedron) index[tag] = 0;
  }
  std::vector<Mobility> mobility;
  for (auto& [tag, number] : index) {
    number = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(vertices.at(tag).point);
    mobility.push_back(vertices.at(tag).mobility);
  }
  for (const auto& tags : tetrahedra) {
    const int t = static_cast<int>(mesh.tetrahedra.size());
    mesh.tetrahedra.push_back({index.at(tags[0]), index.at(tags[1]), index.at(tags[2]), index.at(tags[3])});
    if (tetrahedronVolume(mesh, t) < 0) std::swap(mesh.tetrahedra[t][0], mesh.tetrahedra[t][1]);
  }
  improveWorstTetrahedra(mesh, mobility, kPoor);
  return mesh;
}

/// The cell in units of its radius.
struct UnitCell {
  std::vector<double> radii;
  std::vector<CircleOnSphere> circles;
  double stretch;

  explicit UnitCell(const CellMeshConfig& config) : stretch(config.stretch) {
    const double unit = config.radii.front();
    for (double radius : config.radii) radii.push_back(radius / unit);
    for (const auto& [centre, radius, side] : config.imprints) {
      circles.emplace_back(centre / unit, radius / unit, side, 1);
    }
  }
};

/// `size`: wanted size at a point of the cell, of an element as high as wide. Stretched elements
/// have the same volume.
template <typename Size>
TetMesh makeUnitMesh(const UnitCell& cell, const Size& size) {
  TetMesh mesh;
  const double width = 1 / std::cbrt(cell.stretch);
  inGmshSession("cell", [&] {
    const std::vector<int> volumes = buildCellGeometry(cell.radii, cell.circles, cell.stretch);
    gmsh::model::mesh::setSizeCallback(
        [&](int, int, double x, double y, double z) { return width * size(Eigen::Vector3d(x, y, cell.stretch * z)); });
    gmsh::model::mesh::generate(3);
    mesh = collectTetrahedra(volumes, exactVertices(cell.radii, cell.circles, cell.stretch));
  });
  return mesh;
}

}  // namespace

TetMesh makeCellMesh(const CellMeshConfig& config) {
  config.validate();
  const double unit = config.radii.front();
  const UnitCell cell(config);
  const SizeField size(config);
  TetMesh best;
  std::string failure = "gmsh meshed the cell with flat tetrahedra";
  double quality = 0;
  for (double scale : kScales) {
    try {
      TetMesh mesh =
          makeUnitMesh(cell, [&](const Eigen::Vector3d& point) { return scale * size(unit * point) / unit; });
      const double worst = worstRadiusRatio(mesh);
      if (worst > quality) {
        quality = worst;
        best = std::move(mesh);
      }
    } catch (const std::runtime_error& error) {
      failure = error.what();
    }
    if (quality >= kBad) break;
  }
  if (best.tetrahedra.empty()) throw std::runtime_error(failure);
  for (Eigen::Vector3d& vertex : best.vertices) vertex *= unit;
  return best;
}

std::string mesherVersion() { return "gmsh " + gmshVersion() + " mesher " + std::to_string(kMesherVersion); }

}  // namespace microinjection
