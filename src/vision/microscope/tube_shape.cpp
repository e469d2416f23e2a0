#include "vision/microscope/tube_shape.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kLeastGrowth = 1e-3;  // px

}  // namespace

TubeShape::TubeShape(const HoldingPipette& pipette, const CameraView& view)
    : end(view.pixelOf(pipette.mouth).cast<float>()),
      axis(view.imageDirection(pipette.axis).cast<float>()),
      radius(pipette.outer_radius / view.pixel_size),
      growth(pipette.taper),
      largest(3 * radius),
      inner(pipette.inner_radius / pipette.outer_radius),
      lip((pipette.outer_radius - pipette.inner_radius) / 2 / view.pixel_size) {}

TubeShape::TubeShape(const InjectionPipette& pipette, const CameraView& view)
    : end(view.pixelOf({pipette.tip.x(), pipette.tip.z()}).cast<float>()),
      axis(view.imageDirection({pipette.axis.x(), pipette.axis.z()}).cast<float>()),
      radius(pipette.tip_radius / view.pixel_size),
      growth(pipette.taper / Eigen::Vector2d(pipette.axis.x(), pipette.axis.z()).norm()),
      largest(pipette.shaft_radius / view.pixel_size),
      inner(1 - pipette.wall),
      lip(0) {}

double TubeShape::radiusAt(double s) const { return growth == 0 ? radius : radius + bent(s) * s * growth; }

double TubeShape::slopeAt(double s) const { return growth == 0 ? 0 : std::pow(bent(s), 5) * growth; }

double TubeShape::lipAt(double r) const {
  if (lip == 0 || r < radius * inner) return 0;
  const double beside = std::min(std::abs(r - radius + lip) / lip, 1.0);
  return lip * (1 - std::sqrt(1 - beside * beside));
}

/// Share of the straight growth that is left at `s`.
double TubeShape::bent(double s) const {
  const double straight = growth * std::max(0.0, s) / std::max(largest - radius, kLeastGrowth);
  return std::pow(1 + std::pow(straight, 4), -0.25);
}

}  // namespace microinjection
