#include "cell/mesh/section_mesher.h"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "cell/mesh/gmsh_session.h"
#include "cell/mesh/size_field.h"

namespace microinjection {
namespace {

/// Longest arc, rad: gmsh's arcs are shorter than half a circle.
constexpr double kLongestArc = 2.5;

/// Wanted element size, m: the smallest of `size`, the sizes of the layers, a ninth of each arc,
/// the refinements, and the distances between neighbouring named points. All but the first grow
/// with the distance.
class SectionSizes {
 public:
  explicit SectionSizes(const SectionMeshConfig& config) : config_(config), layers_(config.radii, config.growth) {
    const double radius = config.radii.front();
    for (const auto& [r, side, reach, size] : config.refinements) {
      zones_.push_back({pointOnArc(r, side, radius), reach, size});
    }
    const std::vector<Eigen::Vector2d> points = namedPoints(config, 0);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double apart = (points[i] - points[i - 1]).norm();
      if (apart < config.size) zones_.push_back({(points[i] + points[i - 1]) / 2, apart / 2, apart});
    }
  }

  double operator()(const Eigen::Vector2d& point) const {
    const double from_centre = point.norm();
    double size = std::min(config_.size, layers_.at(from_centre));
    for (double radius : config_.radii) {
      size = std::min(size, M_PI * radius / kElementsOfArc + config_.growth * std::abs(from_centre - radius));
    }
    for (const Zone& zone : zones_) {
      const double outside = std::max(0.0, (point - zone.centre).norm() - zone.reach);
      size = std::min(size, zone.size + config_.growth * outside);
    }
    return size;
  }

 private:
  struct Zone {
    Eigen::Vector2d centre;
    double reach, size;
  };
  const SectionMeshConfig& config_;
  LayerSizes layers_;
  std::vector<Zone> zones_;
};

/// Half a circle from the upper to the lower end of the axis, in gmsh's tags.
struct Arc {
  double radius;  // m
  std::vector<int> points, curves;
};

/// The section in gmsh, in units of the cell's radius, (r, z) as (x, y).
struct Section {
  std::vector<Arc> arcs;                    // outermost first
  std::vector<int> axis, surfaces;          // surfaces: of the layers, outermost first
  std::map<int, Eigen::Vector2d> vertices;  // positions of gmsh's points, m
};

/// Halves arcs that are too long for gmsh.
void divideLongArcs(std::vector<Eigen::Vector2d>& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double one = std::atan2(points[i - 1].x(), points[i - 1].y()),
                 next = std::atan2(points[i].x(), points[i].y());
    if (next - one < kLongestArc) continue;
    const double middle = (one + next) / 2;
    points.insert(points.begin() + i, points[i].norm() * Eigen::Vector2d(std::sin(middle), std::cos(middle)));
  }
}

Arc addArc(const SectionMeshConfig& config, std::size_t layer, int centre, std::map<int, Eigen::Vector2d>& vertices) {
  namespace geo = gmsh::model::geo;
  const double unit = config.radii.front();
  std::vector<Eigen::Vector2d> points = namedPoints(config, layer);
  divideLongArcs(points);
  Arc arc{config.radii[layer], {}, {}};
  for (const Eigen::Vector2d& point : points) {
    const int tag = geo::addPoint(point.x() / unit, point.y() / unit, 0);
    if (!arc.points.empty()) arc.curves.push_back(geo::addCircleArc(arc.points.back(), centre, tag));
    arc.points.push_back(tag);
    vertices[tag] = point;
  }
  return arc;
}

Section buildSection(const SectionMeshConfig& config) {
  namespace geo = gmsh::model::geo;
  Section section;
  const int centre = geo::addPoint(0, 0, 0);
  for (std::size_t layer = 0; layer < config.radii.size(); ++layer) {
    section.arcs.push_back(addArc(config, layer, centre, section.vertices));
  }
  for (std::size_t layer = 0; layer < section.arcs.size(); ++layer) {
    const Arc& outer = section.arcs[layer];
    std::vector<int> loop = outer.curves;
    const auto addAxis = [&](int from, int to) {
      section.axis.push_back(geo::addLine(from, to));
      loop.push_back(section.axis.back());
    };
    if (layer + 1 < section.arcs.size()) {
      const Arc& inner = section.arcs[layer + 1];
      addAxis(outer.points.back(), inner.points.back());
      for (auto curve = inner.curves.rbegin(); curve != inner.curves.rend(); ++curve) loop.push_back(-*curve);
      addAxis(inner.points.front(), outer.points.front());
    } else {
      addAxis(outer.points.back(), outer.points.front());
    }
    section.surfaces.push_back(geo::addPlaneSurface({geo::addCurveLoop(loop)}));
  }
  geo::synchronize();
  return section;
}

using SectionVertices = std::map<std::size_t, Eigen::Vector2d>;  // by gmsh's tag, m

/// Adds the vertices in the open entities of a dimension, each moved by `project`; entity -1: of
/// all of them.
void addSectionVertices(int dimension, int entity, double unit, SectionVertices& vertices,
                        const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& project) {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters, dimension, entity, false, false);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    vertices[tags[i]] = project(unit * Eigen::Vector2d(coordinates[3 * i], coordinates[3 * i + 1]));
  }
}

/// All vertices; those of the axis, the arcs and the points are projected onto them to the last
/// bit.
SectionVertices exactSectionVertices(const Section& section) {
  const double unit = section.arcs.front().radius;
  SectionVertices vertices;
  addSectionVertices(2, -1, unit, vertices, [](const Eigen::Vector2d& point) { return point; });
  for (int line : section.axis) {
    addSectionVertices(1, line, unit, vertices,
                       [](const Eigen::Vector2d& point) { return Eigen::Vector2d(0, point.y()); });
  }
  for (const Arc& arc : section.arcs) {
    for (int curve : arc.curves) {
      addSectionVertices(1, curve, unit, vertices, [&](const Eigen::Vector2d& point) {
        return Eigen::Vector2d(arc.radius * point.normalized());
      });
    }
  }
  for (const auto& vertex : section.vertices) {
    addSectionVertices(0, vertex.first, unit, vertices, [&](const Eigen::Vector2d&) { return vertex.second; });
  }
  return vertices;
}

TriangleMesh collectTriangles(const Section& section, const SectionVertices& vertices) {
  constexpr int kTriangle = 2;  // gmsh's element type
  TriangleMesh mesh;
  std::vector<std::size_t> all_corners;
  for (std::size_t layer = 0; layer < section.surfaces.size(); ++layer) {
    std::vector<std::size_t> elements, corners;
    gmsh::model::mesh::getElementsByType(kTriangle, elements, corners, section.surfaces[layer]);
    all_corners.insert(all_corners.end(), corners.begin(), corners.end());
    mesh.layers.resize(all_corners.size() / 3, static_cast<int>(layer));
  }
  std::map<std::size_t, int> index;
  for (std::size_t tag : std::set<std::size_t>(all_corners.begin(), all_corners.end())) {
    index[tag] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(vertices.at(tag));
  }
  for (std::size_t i = 0; i < all_corners.size(); i += 3) {
    mesh.triangles.push_back({index.at(all_corners[i]), index.at(all_corners[i + 1]), index.at(all_corners[i + 2])});
    std::array<int, 3>& triangle = mesh.triangles.back();
    if (triangleArea(mesh, static_cast<int>(i / 3)) < 0) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

}  // namespace

TriangleMesh makeSectionMesh(const SectionMeshConfig& config) {
  config.validate();
  const double unit = config.radii.front();
  const SectionSizes size(config);
  TriangleMesh mesh;
  inGmshSession("section of the cell", [&] {
    const Section section = buildSection(config);
    gmsh::model::mesh::setSizeCallback(
        [&](int, int, double x, double y, double) { return size(unit * Eigen::Vector2d(x, y)) / unit; });
    gmsh::model::mesh::generate(2);
    mesh = collectTriangles(section, exactSectionVertices(section));
  });
  return mesh;
}

}  // namespace microinjection
