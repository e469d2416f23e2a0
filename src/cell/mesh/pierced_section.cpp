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
#include "cell/mesh/size_field.h"

namespace microinjection {
namespace {

constexpr int kTriangleType = 2;  // gmsh's
constexpr double kOnBall = 1e-6;  // of the radius
constexpr double kRoom = 0.25;    // between the bottom of a hole and a border, of its radius

double distanceFromSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double share = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - share * along).norm();
}

/// Points of the section, in the cell's radius.
class Corners {
 public:
  explicit Corners(const PiercedSectionConfig& config) : pierced_(config.hole_length > 0) {
    const double unit = config.radii.front(), hole = config.hole_radius / unit, fillet = config.rim_radius / unit;
    for (const double radius : config.radii) radii.push_back(radius / unit);
    held = pointOnArc(config.held_radius / unit, -1, 1);
    bottom = {0, 1 - config.hole_length / unit};
    corner = {hole, bottom.y()};
    if (fillet > 0) {  // touches the wall and, from inside, the sphere
      const double across = hole + fillet;
      fillet_centre = {across, std::sqrt((1 - fillet) * (1 - fillet) - across * across)};
      mouth = {hole, fillet_centre.y()};
      ends.emplace_back(fillet_centre.normalized());
    } else {
      mouth = pointOnArc(hole, +1, 1);
      ends.push_back(pierced_ ? mouth : Eigen::Vector2d(0, 1));
    }
    for (std::size_t i = 1; i < radii.size(); ++i) {
      const bool cut = pierced_ && radii[i] > bottom.y();
      ends.push_back(cut ? pointOnArc(hole, +1, radii[i]) : Eigen::Vector2d(0, radii[i]));
    }
  }

  bool cuts(std::size_t layer) const { return pierced_ && ends[layer].x() > 0; }  ///< the hole, its sphere

  std::vector<double> radii;
  std::vector<Eigen::Vector2d> ends;  ///< upper end of each layer's sphere
  Eigen::Vector2d held, mouth, corner, bottom, fillet_centre = Eigen::Vector2d::Zero();

 private:
  bool pierced_;
};

/// Curves of gmsh that end at a point, in order.
struct Way {
  int last = 0;  ///< point
  std::vector<int> curves;

  void lineTo(int point) {
    curves.push_back(gmsh::model::geo::addLine(last, point));
    last = point;
  }
  void arcTo(int point, int centre) {
    curves.push_back(gmsh::model::geo::addCircleArc(last, centre, point));
    last = point;
  }
};

/// Adds the layers to gmsh's model and returns their surfaces.
std::vector<int> addLayers(const PiercedSectionConfig& config, const Corners& at) {
  namespace geo = gmsh::model::geo;
  const auto add = [](const Eigen::Vector2d& point) { return geo::addPoint(point.x(), point.y(), 0); };
  const int centre = add({0, 0});
  const std::size_t count = at.radii.size();
  std::vector<Way> spheres, inwards;  // from the lower pole; from the end of a sphere to that of the next
  std::vector<int> poles, tops;
  for (std::size_t i = 0; i < count; ++i) {
    poles.push_back(add({0, -at.radii[i]}));
    Way way{poles.back(), {}};
    if (i == 0) way.arcTo(add(at.held), centre);
    way.arcTo(add({at.radii[i], 0}), centre);
    way.arcTo(add(at.ends[i]), centre);
    tops.push_back(way.last);
    spheres.push_back(std::move(way));
  }
  const bool pierced = config.hole_length > 0;
  for (std::size_t i = 0; i < count; ++i) {
    Way way{tops[i], {}};
    if (i == 0 && config.rim_radius > 0) way.arcTo(add(at.mouth), add(at.fillet_centre));
    const bool ends_here = pierced && (i == 0 || at.cuts(i)) && (i + 1 == count || !at.cuts(i + 1));
    if (ends_here) {
      way.lineTo(add(at.corner));
      way.lineTo(add(at.bottom));
    }
    way.lineTo(i + 1 < count ? tops[i + 1] : poles[i]);
    inwards.push_back(std::move(way));
  }
  std::vector<int> surfaces;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<int> loop = spheres[i].curves;
    loop.insert(loop.end(), inwards[i].curves.begin(), inwards[i].curves.end());
    if (i + 1 < count) {
      const std::vector<int>& inner = spheres[i + 1].curves;
      for (auto curve = inner.rbegin(); curve != inner.rend(); ++curve) loop.push_back(-*curve);
      loop.push_back(geo::addLine(poles[i + 1], poles[i]));
    }
    surfaces.push_back(geo::addPlaneSurface({geo::addCurveLoop(loop)}));
  }
  return surfaces;
}

TriangleMesh triangles(const PiercedSectionConfig& config) {
  const Corners at(config);
  const double unit = config.radii.front();
  const LayerSizes layers(config.radii, config.growth);
  const bool pierced = config.hole_length > 0;
  const Eigen::Vector2d from = pierced ? at.mouth : Eigen::Vector2d(0, 1);
  const Eigen::Vector2d to =
      pierced ? Eigen::Vector2d(at.corner.x(), std::max(at.corner.y(), 1 - config.fine_length / unit))
              : Eigen::Vector2d(1e-9, 1);
  const auto size = [&](double x, double y) {
    const Eigen::Vector2d point(x, y);
    const double from_hole = unit * distanceFromSegment(point, from, to);
    const double from_contact = std::max(0.0, unit * (point - Eigen::Vector2d(0, 1)).norm() - config.contact_radius);
    const double from_held = unit * (point - at.held).norm();
    return std::min({config.size, layers.at(unit * point.norm()),
                     config.hole_size + config.growth * std::min(from_hole, from_contact),
                     config.held_size + config.growth * from_held}) /
           unit;
  };
  TriangleMesh mesh;
  inGmshSession("section of a pierced cell", [&] {
    const std::vector<int> surfaces = addLayers(config, at);
    gmsh::model::geo::synchronize();
    gmsh::model::mesh::setSizeCallback([&](int, int, double x, double y, double) { return size(x, y); });
    gmsh::model::mesh::generate(2);
    std::vector<std::size_t> tags, all_corners;
    std::vector<double> coordinates, parameters;
    gmsh::model::mesh::getNodes(tags, coordinates, parameters);
    std::map<std::size_t, Eigen::Vector2d> places;
    for (std::size_t i = 0; i < tags.size(); ++i) places[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1]};
    for (std::size_t layer = 0; layer < surfaces.size(); ++layer) {
      std::vector<std::size_t> elements, corners;
      gmsh::model::mesh::getElementsByType(kTriangleType, elements, corners, surfaces[layer]);
      all_corners.insert(all_corners.end(), corners.begin(), corners.end());
      mesh.layers.resize(all_corners.size() / 3, static_cast<int>(layer));
    }
    std::map<std::size_t, int> index;
    for (const std::size_t corner : all_corners) index[corner] = 0;
    for (auto& [tag, number] : index) {
      number = static_cast<int>(mesh.vertices.size());
      Eigen::Vector2d place = places.at(tag);
      for (const double radius : at.radii) {
        if (std::abs(place.norm() / radius - 1) < kOnBall) place = radius * place.normalized();
      }
      if (std::abs(place.x()) < 1e-12) place.x() = 0;
      mesh.vertices.push_back(unit * place);
    }
    for (std::size_t i = 0; i < all_corners.size(); i += 3) {
      mesh.triangles.push_back({index.at(all_corners[i]), index.at(all_corners[i + 1]), index.at(all_corners[i + 2])});
      if (triangleArea(mesh, static_cast<int>(i / 3)) < 0)
        std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
    }
  });
  return mesh;
}

}  // namespace

void PiercedSectionConfig::validate() const {
  ConfigErrors errors("section of a pierced cell");
  bool fall = !radii.empty() && radii.back() > 0;
  for (std::size_t i = 1; fall && i < radii.size(); ++i) fall = radii[i] < radii[i - 1];
  errors.require(fall, "radii", radii.empty() ? 0 : radii.front(), " m", "positive and falling (m)");
  errors.throwAny();
  const double radius = radii.front();
  errors.require(hole_length >= 0 && hole_length < radius + 0.9 * radii.back(), "hole_length", hole_length, " m",
                 "from 0 to the lower end of the innermost layer (m)");
  errors.require(hole_length == 0 || (hole_radius > 0 && hole_radius < 0.2 * radius), "hole_radius", hole_radius, " m",
                 "between 0 and 0.2 radii (m)");
  errors.require(!endsAtBorder(hole_length), "hole_length", hole_length, " m", "not at the border of two layers");
  errors.require(rim_radius >= 0 && (rim_radius == 0 || rim_radius < 0.9 * hole_length), "rim_radius", rim_radius, " m",
                 "from 0 to 0.9 lengths of the hole (m)");
  errors.require(held_radius > 0 && held_radius < 0.95 * radius, "held_radius", held_radius, " m",
                 "between 0 and 0.95 radii (m)");
  errors.require(hole_size > 0 && held_size > 0 && size > 0, "hole_size, held_size, size", std::min(hole_size, size),
                 " m", "positive (m)");
  errors.require(growth > 0 && growth <= 1, "growth", growth, "", "in (0, 1]");
  errors.throwAny();
}

bool PiercedSectionConfig::endsAtBorder(double length) const {
  if (length == 0) return false;
  return std::any_of(radii.begin() + 1, radii.end(), [&](double radius) {
    const double on_axis = radii.front() - radius;
    const double on_wall = radii.front() - std::sqrt(std::max(radius * radius - hole_radius * hole_radius, 0.0));
    return length > on_axis - kRoom * hole_radius && length < on_wall + kRoom * hole_radius;
  });
}

QuadraticMesh<2> makePiercedSection(const PiercedSectionConfig& config) {
  config.validate();
  QuadraticMesh<2> mesh = makeQuadratic(triangles(config), {});
  for (const auto& facet : mesh.facets) {
    const double radius = config.radii[facet.layer];
    const auto onSphere = [&](int node) { return std::abs(mesh.nodes[node].norm() / radius - 1) < kOnBall; };
    if (onSphere(facet.nodes[0]) && onSphere(facet.nodes[1]))
      mesh.nodes[facet.nodes[2]] = radius * mesh.nodes[facet.nodes[2]].normalized();
  }
  return mesh;
}

}  // namespace microinjection
