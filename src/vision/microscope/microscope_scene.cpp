#include "vision/microscope/microscope_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/config_errors.h"

namespace microinjection {
namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kLeastInImage = 0.05;  // of an axis: its share in the image plane
constexpr double kMeniscus = 0.25;      // of the bore's radius, bulge of the border between cytoplasm and liquid

void checkOutline(ConfigErrors& errors, const std::string& name, const CellOutline& outline) {
  if (outline.empty()) return;
  errors.require(outline.size() >= 3, name, outline.size(), " corners", "at least 3 corners, or none");
  for (const Eigen::Vector2d& corner : outline) {
    if (corner.allFinite()) continue;
    errors.add(name + " has a corner that is not finite");
    return;
  }
}

void checkBody(ConfigErrors& errors, const std::string& name, const std::optional<CellBody>& body) {
  if (!body) return;
  if (!body->centre.allFinite()) errors.add(name + " centre is not finite");
  errors.require(Range::positive(), name + " radius", body->radius, " m");
}

void checkCell(ConfigErrors& errors, const CellScene& cell) {
  checkOutline(errors, "zona_outer", cell.zona_outer);
  checkOutline(errors, "zona_inner", cell.zona_inner);
  checkOutline(errors, "ooplasm", cell.ooplasm);
  checkBody(errors, "polar body", cell.polar_body);
  checkBody(errors, "nucleus", cell.nucleus);
  errors.require(Range::finite(), "cell y", cell.y, " m");
  if (!cell.material.allFinite()) errors.add("cell material is not finite");
}

void checkHolding(ConfigErrors& errors, const HoldingPipette& pipette) {
  if (!pipette.mouth.allFinite() || !std::isfinite(pipette.y)) errors.add("holding mouth is not finite");
  errors.require(std::abs(pipette.axis.norm() - 1) < kUnitTolerance, "holding axis length", pipette.axis.norm(), "",
                 "1");
  errors.require(Range::positive(), "holding outer_radius", pipette.outer_radius, " m");
  errors.require(pipette.inner_radius > 0 && pipette.inner_radius < pipette.outer_radius, "holding inner_radius",
                 pipette.inner_radius, " m", "above 0 and below outer_radius");
  errors.require(Range::closed(0, 1), "holding taper", pipette.taper);
}

void checkInjection(ConfigErrors& errors, const InjectionPipette& pipette) {
  if (!pipette.tip.allFinite()) errors.add("injection tip is not finite");
  errors.require(std::abs(pipette.axis.norm() - 1) < kUnitTolerance, "injection axis length", pipette.axis.norm(), "",
                 "1");
  const double in_image = std::hypot(pipette.axis.x(), pipette.axis.z());
  errors.require(in_image > kLeastInImage, "injection axis in the image", in_image, "", "above 0.05");
  errors.require(Range::positive(), "injection tip_radius", pipette.tip_radius, " m");
  errors.require(pipette.shaft_radius >= pipette.tip_radius, "injection shaft_radius", pipette.shaft_radius, " m",
                 "at least tip_radius");
  errors.require(Range::open(0, 1), "injection wall", pipette.wall);
  errors.require(Range::closed(0, 1), "injection taper", pipette.taper);
  if (!pipette.column) return;
  errors.require(Range::positive(), "bore column length", pipette.column->length, " m");
  const double bore = (1 - pipette.wall) * pipette.tip_radius;
  errors.require(pipette.column->bulge >= 0 && pipette.column->bulge <= bore, "bore column bulge",
                 pipette.column->bulge, " m", "from 0 to the bore's radius");
}

}  // namespace

CellOutline circleOutline(const Eigen::Vector2d& centre, double radius, int corners) {
  return ellipseOutline(centre, radius, radius, 0, corners);
}

CellOutline ellipseOutline(const Eigen::Vector2d& centre, double a, double b, double angle, int corners) {
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-std::sin(angle), std::cos(angle));
  CellOutline outline;
  outline.reserve(corners);
  for (int i = 0; i < corners; ++i) {
    const double turn = 2 * M_PI * i / corners;
    outline.emplace_back(centre + a * std::cos(turn) * along + b * std::sin(turn) * across);
  }
  return outline;
}

CellBody CellBody::polarBody(const Eigen::Vector2d& centre, double radius) {
  return {centre, radius, {0.35, 0.05, 0.30, 0, 0.9e-6, 0.14, 0.6e-6, 0, 0.07}};
}

CellBody CellBody::nucleus(const Eigen::Vector2d& centre, double radius) {
  return {centre, radius, {-0.20, -0.03, 0.14, 0.5e-6, 0.5e-6, 0.04, 0.6e-6, 0, -0.04}};
}

BoreColumn BoreColumn::tongue(double length, double bore_radius) {
  BoreColumn column;
  column.length = length;
  column.bulge = std::min(length, bore_radius);
  return column;
}

BoreColumn BoreColumn::cytoplasm(double length, double bore_radius) {
  BoreColumn column;
  column.length = length;
  column.bulge = kMeniscus * bore_radius;
  column.optics.rim = 0.25;
  column.optics.line = 0.08;
  return column;
}

CellScene CellScene::round(const Eigen::Vector2d& centre, double radius, double zona_thickness,
                           double perivitelline_gap) {
  CellScene cell;
  cell.material = centre;
  if (zona_thickness > 0) {
    cell.zona_outer = circleOutline(centre, radius);
    cell.zona_inner = circleOutline(centre, radius - zona_thickness);
  }
  cell.ooplasm = circleOutline(centre, radius - zona_thickness - perivitelline_gap);
  return cell;
}

void MicroscopeScene::validate() const {
  ConfigErrors errors("microscope scene");
  for (const CellScene& cell : cells) checkCell(errors, cell);
  if (holding) checkHolding(errors, *holding);
  if (injection) checkInjection(errors, *injection);
  for (const Debris& body : debris) {
    if (!body.centre.allFinite()) errors.add("debris centre is not finite");
    errors.require(Range::positive(), "debris radius", body.radius, " m");
  }
  errors.throwAny();
}

}  // namespace microinjection
