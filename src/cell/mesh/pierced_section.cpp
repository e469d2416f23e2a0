#include "cell/mesh/pierced_section.h"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/config_errors.h"
#include "cell/mesh/gmsh_session.h"
#include "cell/mesh/mesh_config.h"

namespace microinjection {
namespace {

constexpr int kTriangleType = 2;  // gmsh's
constexpr double kOnBall = 1e-6;  // of the radius

double distanceFromSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double share = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - share * along).norm();
}

/// Corners of the section from the lower pole to the upper end of the axis, in radii.
struct Corners {
  Eigen::Vector2d pole, held, side, rim, corner, bottom;

  explicit Corners(const PiercedSectionConfig& config) {
    pole = {0, -1};
    held = pointOnArc(config.held_radius / config.radius, -1, 1);
    side = {1, 0};
    const bool pierced = config.hole_length > 0;
    rim = pierced ? pointOnArc(config.hole_radius / config.radius, +1, 1) : Eigen::Vector2d(0, 1);
    bottom = {0, 1 - config.hole_length / config.radius};
    corner = {rim.x(), bottom.y()};
  }
};

TriangleMesh triangles(const PiercedSectionConfig& config) {
  namespace geo = gmsh::model::geo;
  const Corners at(config);
  const bool pierced = config.hole_length > 0;
  const auto size = [&](double x, double y) {
    const Eigen::Vector2d point(x, y);
    const double unit = config.radius;
    const double from_hole = unit * distanceFromSegment(point, at.rim, pierced ? at.corner : Eigen::Vector2d(1e-9, 1));
    const double from_contact = std::max(0.0, unit * (point - Eigen::Vector2d(0, 1)).norm() - config.contact_radius);
    const double from_held = unit * (point - at.held).norm();
    return std::min({config.size, config.hole_size + config.growth * std::min(from_hole, from_contact),
                     config.held_size + config.growth * from_held}) /
           unit;
  };
  TriangleMesh mesh;
  inGmshSession("section of a pierced cell", [&] {
    const auto add = [](const Eigen::Vector2d& point) { return geo::addPoint(point.x(), point.y(), 0); };
    const int centre = add({0, 0}), pole = add(at.pole), held = add(at.held), side = add(at.side), rim = add(at.rim);
    std::vector<int> loop = {geo::addCircleArc(pole, centre, held), geo::addCircleArc(held, centre, side),
                             geo::addCircleArc(side, centre, rim)};
    int last = rim;
    if (pierced) {
      const int corner = add(at.corner), bottom = add(at.bottom);
      loop.push_back(geo::addLine(rim, corner));
      loop.push_back(geo::addLine(corner, bottom));
      last = bottom;
    }
    loop.push_back(geo::addLine(last, pole));
    geo::addPlaneSurface({geo::addCurveLoop(loop)});
    geo::synchronize();
    gmsh::model::mesh::setSizeCallback([&](int, int, double x, double y, double) { return size(x, y); });
    gmsh::model::mesh::generate(2);
    std::vector<std::size_t> tags, elements, corners;
    std::vector<double> coordinates, parameters;
    gmsh::model::mesh::getNodes(tags, coordinates, parameters);
    gmsh::model::mesh::getElementsByType(kTriangleType, elements, corners);
    std::map<std::size_t, Eigen::Vector2d> places;
    for (std::size_t i = 0; i < tags.size(); ++i) places[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1]};
    std::map<std::size_t, int> index;
    for (const std::size_t corner : corners) index[corner] = 0;
    for (auto& [tag, number] : index) {
      number = static_cast<int>(mesh.vertices.size());
      Eigen::Vector2d place = places.at(tag);
      if (std::abs(place.norm() - 1) < kOnBall) place.normalize();
      if (std::abs(place.x()) < 1e-12) place.x() = 0;
      mesh.vertices.push_back(config.radius * place);
    }
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      mesh.triangles.push_back({index.at(corners[i]), index.at(corners[i + 1]), index.at(corners[i + 2])});
      if (triangleArea(mesh, static_cast<int>(i / 3)) < 0)
        std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
    }
    mesh.layers.assign(mesh.triangles.size(), 0);
  });
  return mesh;
}

}  // namespace

void PiercedSectionConfig::validate() const {
  ConfigErrors errors("section of a pierced cell");
  errors.require(radius > 0, "radius", radius, " m", "positive (m)");
  errors.require(hole_length >= 0 && hole_length < 1.9 * radius, "hole_length", hole_length, " m",
                 "from 0 to 1.9 radii (m)");
  errors.require(hole_length == 0 || (hole_radius > 0 && hole_radius < 0.2 * radius), "hole_radius", hole_radius, " m",
                 "between 0 and 0.2 radii (m)");
  errors.require(held_radius > 0 && held_radius < 0.95 * radius, "held_radius", held_radius, " m",
                 "between 0 and 0.95 radii (m)");
  errors.require(hole_size > 0 && held_size > 0 && size > 0, "hole_size, held_size, size", std::min(hole_size, size),
                 " m", "positive (m)");
  errors.require(growth > 0 && growth <= 1, "growth", growth, "", "in (0, 1]");
  errors.throwAny();
}

QuadraticMesh<2> makePiercedSection(const PiercedSectionConfig& config) {
  config.validate();
  QuadraticMesh<2> mesh = makeQuadratic(triangles(config), {});
  const auto onBall = [&](int node) { return std::abs(mesh.nodes[node].norm() / config.radius - 1) < kOnBall; };
  for (const auto& facet : mesh.facets) {
    if (onBall(facet.nodes[0]) && onBall(facet.nodes[1]))
      mesh.nodes[facet.nodes[2]] = config.radius * mesh.nodes[facet.nodes[2]].normalized();
  }
  return mesh;
}

}  // namespace microinjection
