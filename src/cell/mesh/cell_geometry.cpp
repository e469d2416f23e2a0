#include "cell/mesh/cell_geometry.h"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

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

}  // namespace

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

}  // namespace microinjection
