#include "mesh/cell_mesher.h"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

/// Raise it when the same configuration gives another mesh than before.
constexpr int kMesherVersion = 1;

/// Segments of a circle at the least, however coarse the mesh.
constexpr int kMinimumSegments = 8;

/// How near to a circle a point of its imprinted curve lies, in radii: OpenCASCADE and the spline are good to 1e-6.
constexpr double kOnCircle = 1e-4;

constexpr double kPi = 3.14159265358979323846;

/// gmsh keeps one global state: one session at a time, closed on every way out.
class GmshSession {
 public:
  GmshSession() : lock_(mutex()) {
    gmsh::initialize(0, nullptr, /*readConfigFiles=*/false);
    // Deterministic and silent: one thread, fixed seed, errors as exceptions.
    for (const auto& [name, value] : std::map<std::string, double>{{"General.Terminal", 0},
                                                                   {"General.NumThreads", 1},
                                                                   {"General.AbortOnError", 2},
                                                                   {"Mesh.RandomSeed", 1},
                                                                   {"Mesh.Algorithm", 6},
                                                                   {"Mesh.Algorithm3D", 1},
                                                                   {"Mesh.MeshSizeExtendFromBoundary", 0},
                                                                   {"Mesh.MeshSizeFromPoints", 0},
                                                                   {"Mesh.Optimize", 1}}) {
      gmsh::option::setNumber(name, value);
    }
    gmsh::model::add("cell");
  }
  ~GmshSession() { gmsh::finalize(); }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
};

/// A circle on the sphere, in units of the sphere's radius: distance `radius` from the vertical line through `centre`.
struct Circle {
  Eigen::Vector2d centre;
  double radius;
  double side;  ///< +1 upper surface, -1 lower

  Eigen::Vector3d at(const Eigen::Vector2d& direction) const {
    const Eigen::Vector2d xy = centre + radius * direction;
    return {xy.x(), xy.y(), side * std::sqrt(std::max(0.0, 1 - xy.squaredNorm()))};
  }
  Eigen::Vector3d project(const Eigen::Vector3d& point) const { return at((point.head<2>() - centre).normalized()); }
  double distance(const Eigen::Vector3d& point) const {
    return point.z() * side > 0 ? (point - project(point)).norm() : std::numeric_limits<double>::infinity();
  }
};

/// The unit sphere's surface, as pieces of dimension 2.
gmsh::vectorpair addSphere() {
  namespace occ = gmsh::model::occ;
  const gmsh::vectorpair ball = {{3, occ::addSphere(0, 0, 0, 1)}};
  // The parametrisation is singular at the sphere's poles: turn them to +-y, away from needle and holding pipette.
  occ::rotate(ball, 0, 0, 0, 1, 0, 0, kPi / 2);
  occ::synchronize();
  gmsh::vectorpair surface;
  gmsh::model::getBoundary(ball, surface, false, false);
  occ::remove(ball);
  return surface;
}

/// A vertical cylinder that cuts the sphere in the circle only.
gmsh::vectorpair addCylinder(const Circle& circle) {
  namespace occ = gmsh::model::occ;
  const int rim = occ::addCircle(circle.centre.x(), circle.centre.y(), 0, circle.radius);
  gmsh::vectorpair extruded, cylinder;
  occ::extrude({{1, rim}}, 0, 0, 2 * circle.side, extruded);
  std::copy_if(extruded.begin(), extruded.end(), std::back_inserter(cylinder), [](auto e) { return e.first == 2; });
  return cylinder;
}

/// The unit ball with the circles imprinted on its surface.
void buildGeometry(const std::vector<Circle>& circles) {
  namespace occ = gmsh::model::occ;
  const gmsh::vectorpair sphere = addSphere();
  gmsh::vectorpair cylinders, pieces, scrap;
  for (const Circle& circle : circles) {
    for (const auto& surface : addCylinder(circle)) cylinders.push_back(surface);
  }
  std::vector<gmsh::vectorpair> pieces_of;  // of each piece of the sphere, then of each cylinder
  occ::fragment(sphere, cylinders, pieces, pieces_of);
  std::vector<int> shell;
  for (std::size_t i = 0; i < pieces_of.size(); ++i) {
    for (const auto& piece : pieces_of[i]) {
      if (i < sphere.size()) {
        shell.push_back(piece.second);
      } else {
        scrap.push_back(piece);
      }
    }
  }
  occ::addVolume({occ::addSurfaceLoop(shell, -1, true)});
  occ::remove(scrap, true);
  occ::synchronize();
}

/// Meshes so that no circle has fewer than kMinimumSegments edges. `size` is in units of the radius.
void generate(const std::vector<Circle>& circles, const std::function<double(const Eigen::Vector3d&)>& size) {
  gmsh::model::mesh::setSizeCallback([&](int, int, double x, double y, double z) { return size({x, y, z}); });
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  for (const auto& [dimension, tag] : curves) {
    std::vector<double> low, high, middle;
    gmsh::model::getParametrizationBounds(dimension, tag, low, high);
    gmsh::model::getValue(dimension, tag, {(low[0] + high[0]) / 2}, middle);
    const Eigen::Vector3d point(middle[0], middle[1], middle[2]);
    for (const Circle& circle : circles) {
      if (circle.distance(point) > kOnCircle) continue;
      double length = 0;
      gmsh::model::occ::getMass(dimension, tag, length);
      const double segment = std::min(size(point), 2 * kPi * circle.radius / kMinimumSegments);
      const int segments = std::max(1, static_cast<int>(std::round(length / segment)));
      gmsh::model::mesh::setTransfiniteCurve(tag, segments + 1);
    }
  }
  gmsh::model::mesh::generate(3);
}

/// Vertices of the surface and of the circles moved the last bit onto them, in units of the radius.
std::map<std::size_t, Eigen::Vector3d> exactVertices(const std::vector<Circle>& circles) {
  std::map<std::size_t, Eigen::Vector3d> vertices;
  for (int dimension = 3; dimension >= 0; --dimension) {
    std::vector<std::size_t> tags;
    std::vector<double> coordinates, parameters;
    gmsh::model::mesh::getNodes(tags, coordinates, parameters, dimension, -1, false, false);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      Eigen::Vector3d point = Eigen::Vector3d::Map(&coordinates[3 * i]);
      if (dimension < 3) point.normalize();
      for (const Circle& circle : circles) {
        if (dimension < 2 && circle.distance(point) < kOnCircle) point = circle.project(point);
      }
      vertices[tags[i]] = point;
    }
  }
  return vertices;
}

TetMesh collectMesh(const std::map<std::size_t, Eigen::Vector3d>& vertices, double radius) {
  constexpr int kTetrahedron = 4;  // gmsh's element type
  std::vector<std::size_t> elements, corners;
  gmsh::model::mesh::getElementsByType(kTetrahedron, elements, corners);
  const std::set<std::size_t> used(corners.begin(), corners.end());
  TetMesh mesh;
  std::map<std::size_t, int> index;
  for (std::size_t tag : used) {
    index[tag] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(radius * vertices.at(tag));
  }
  for (std::size_t t = 0; t < elements.size(); ++t) {
    std::array<int, 4> tetrahedron;
    for (int i = 0; i < 4; ++i) tetrahedron[i] = index.at(corners[4 * t + i]);
    mesh.tetrahedra.push_back(tetrahedron);
    if (tetrahedronVolume(mesh, static_cast<int>(t)) < 0) std::swap(mesh.tetrahedra[t][0], mesh.tetrahedra[t][1]);
  }
  return mesh;
}

}  // namespace

void CellMeshConfig::validate() const {
  std::vector<std::string> errors;
  const auto require = [&](bool good, const std::string& key, double value, const std::string& allowed) {
    std::ostringstream message;
    message << "cell mesh: " << key << " = " << value << ": must be " << allowed;
    if (!good) errors.push_back(message.str());
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  require(positive(diameter), "diameter", diameter, "positive");
  require(positive(size), "size", size, "positive");
  require(positive(zone_diameter), "zone_diameter", zone_diameter, "positive");
  require(std::isfinite(density) && density >= 1, "density", density, "at least 1");
  require(positive(tip_radius) && offset.norm() + tip_radius < 0.95 * diameter / 2, "tip_radius", tip_radius,
          "positive, and with the offset inside of 0.95 of the cell's radius");
  require(positive(contact_radius) && contact_radius < 0.95 * diameter / 2, "contact_radius", contact_radius,
          "in (0, 0.95 of the cell's radius)");
  if (!errors.empty()) throw ConfigError(errors);
}

Eigen::Vector3d CellMeshConfig::entry() const {
  return {offset.x(), offset.y(), std::sqrt(diameter * diameter / 4 - offset.squaredNorm())};
}

double CellMeshConfig::sizeAt(const Eigen::Vector3d& point) const {
  constexpr double kGrowth = 1.0 / 3;
  const double outside = std::max(0.0, (point - entry()).norm() - zone_diameter / 2);
  return std::min(size, size / density + kGrowth * outside);
}

TetMesh makeCellMesh(const CellMeshConfig& config) {
  config.validate();
  const double radius = config.diameter / 2;
  const std::vector<Circle> circles = {{config.offset / radius, config.tip_radius / radius, +1},
                                       {Eigen::Vector2d::Zero(), config.contact_radius / radius, -1}};
  const auto size = [&](const Eigen::Vector3d& point) { return config.sizeAt(radius * point) / radius; };
  try {
    const GmshSession session;
    buildGeometry(circles);
    generate(circles, size);
    return collectMesh(exactVertices(circles), radius);
  } catch (const std::string& message) {  // what gmsh's C++ interface throws
    throw std::runtime_error("gmsh could not mesh the cell: " + message);
  }
}

std::string mesherVersion() { return "gmsh " GMSH_API_VERSION " mesher " + std::to_string(kMesherVersion); }

}  // namespace microinjection
