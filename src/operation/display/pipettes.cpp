#include "operation/display/pipettes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "operation/display/colour_map.h"

namespace microinjection {
namespace {

constexpr Colour kGlass{0.72f, 0.88f, 0.97f, 0.16f};
constexpr int kSegments = 48;
constexpr int kArcSteps = 12;

/// Adds a quarter of an ellipse (m) that leaves `from` across the axis and arrives at `to` along
/// it.
void addQuarterEllipse(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::vector<Eigen::Vector2d>& profile) {
  for (int step = 0; step <= kArcSteps; ++step) {
    const double angle = M_PI / 2 * step / kArcSteps;
    profile.emplace_back(from.x() + (to.x() - from.x()) * std::sin(angle),
                         from.y() + (to.y() - from.y()) * (1 - std::cos(angle)));
  }
}

/// Glass with this profile (m) about the z axis.
TriangleSoup turned(std::vector<Eigen::Vector2d> profile, double enlargement) {
  for (Eigen::Vector2d& point : profile) point *= enlargement;
  TriangleSoup soup = lathe(profile, kSegments);
  for (std::size_t i = 0; i < soup.points.size(); i += 3) {
    const Eigen::Vector3d& origin = soup.points[i];
    const Eigen::Vector3d normal = (soup.points[i + 1] - origin).cross(soup.points[i + 2] - origin);
    const Colour colour = shaded(kGlass, lampLight(normal.stableNormalized()));
    soup.colours.insert(soup.colours.end(), 3, colour);
  }
  return soup;
}

}  // namespace

DrawnInjectionPipette DrawnInjectionPipette::read(ConfigReader& reader) {
  DrawnInjectionPipette pipette;
  reader.number("tip_radius", pipette.tip_radius, Range::positive());
  reader.number("bore_ratio", pipette.bore_ratio, Range::open(0, 1));
  reader.number("taper_angle", pipette.taper_angle, Range::open(0, 1));
  reader.number("shaft_radius", pipette.shaft_radius, Range::positive());
  reader.number("length", pipette.length, Range::positive());
  if (!(pipette.shaft_radius >= pipette.tip_radius)) reader.error("shaft_radius", "must not be below tip_radius");
  return pipette;
}

DrawnHoldingPipette DrawnHoldingPipette::read(ConfigReader& reader) {
  DrawnHoldingPipette pipette;
  reader.number("mouth_radius", pipette.mouth_radius, Range::positive());
  reader.number("outer_radius", pipette.outer_radius, Range::positive());
  reader.number("bore_ratio", pipette.bore_ratio, Range::open(0, 1));
  reader.number("length", pipette.length, Range::positive());
  if (!(pipette.outer_radius > pipette.mouth_radius)) reader.error("outer_radius", "must be above mouth_radius");
  if (!(pipette.length > pipette.outer_radius)) reader.error("length", "must be above outer_radius");
  return pipette;
}

TriangleSoup glass(const DrawnInjectionPipette& pipette, double enlargement) {
  const double taper = (pipette.shaft_radius - pipette.tip_radius) / std::tan(pipette.taper_angle);
  const double taper_end = std::min(taper, pipette.length);
  const double end_radius = pipette.tip_radius + taper_end * std::tan(pipette.taper_angle);
  const double bore = pipette.bore_ratio;
  return turned({{bore * pipette.tip_radius, 0},
                 {pipette.tip_radius, 0},
                 {end_radius, taper_end},
                 {end_radius, pipette.length},
                 {bore * end_radius, pipette.length},
                 {bore * end_radius, taper_end},
                 {bore * pipette.tip_radius, 0}},
                enlargement);
}

TriangleSoup glass(const DrawnHoldingPipette& pipette, double enlargement) {
  const double wall = pipette.outer_radius - pipette.mouth_radius;
  const Eigen::Vector2d rim(pipette.mouth_radius, 0);
  const double bore = std::max(pipette.bore_ratio * pipette.outer_radius, pipette.mouth_radius);
  std::vector<Eigen::Vector2d> profile;
  addQuarterEllipse(rim, {pipette.outer_radius, 0.8 * wall}, profile);
  profile.emplace_back(pipette.outer_radius, pipette.length);
  std::vector<Eigen::Vector2d> inside;
  addQuarterEllipse({rim.x(), 0.3 * wall}, {bore, 0.9 * wall}, inside);
  profile.emplace_back(bore, pipette.length);
  profile.insert(profile.end(), inside.rbegin(), inside.rend());
  profile.push_back(rim);
  return turned(profile, enlargement);
}

Mouth fitMouth(const std::vector<Eigen::Vector3d>& held) {
  Mouth mouth;
  for (const Eigen::Vector3d& point : held) {
    const double radius = point.head<2>().norm();
    if (radius >= mouth.radius) mouth = {radius, point.z()};
  }
  return mouth;
}

}  // namespace microinjection
