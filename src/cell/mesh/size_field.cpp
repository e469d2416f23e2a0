#include "cell/mesh/size_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

/// Element size over the thickness of a layer, and over the radius of the innermost ball.
constexpr double kSizeOverThickness = 1.25;
constexpr double kSizeOverRadius = 2.0 / 3;

}  // namespace

LayerSizes::LayerSizes(const std::vector<double>& radii, double growth) : growth_(growth) {
  for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
    layers_.push_back({radii[i + 1], radii[i], kSizeOverThickness * (radii[i] - radii[i + 1])});
  }
  if (radii.size() > 1) layers_.push_back({0, radii.back(), kSizeOverRadius * radii.back()});
}

double LayerSizes::at(double from_centre) const {
  double size = std::numeric_limits<double>::infinity();
  for (const Layer& layer : layers_) {
    const double distance = std::max({0.0, from_centre - layer.outer, layer.inner - from_centre});
    size = std::min(size, layer.size + growth_ * distance);
  }
  return size;
}

SizeField::SizeField(const CellMeshConfig& config)
    : size_(config.size), growth_(config.growth), layers_(config.radii, config.growth) {
  const double radius = config.radii.front();
  for (const CellMeshConfig::Refinement& refinement : config.refinements) {
    if (refinement.shape == CellMeshConfig::Shape::kBall) {
      balls_.push_back({pointOnSphere(refinement.centre, refinement.side, radius), refinement.radius, refinement.size});
    } else {
      circles_.emplace_back(CircleOnSphere(refinement.centre, refinement.radius, refinement.side, radius),
                            refinement.size);
    }
  }
  for (const CellMeshConfig::Circle& circle : config.imprints) {
    circles_.emplace_back(CircleOnSphere(circle.centre, circle.radius, circle.side, radius),
                          2 * M_PI * circle.radius / kElementsOfArc);
  }
}

double SizeField::operator()(const Eigen::Vector3d& point) const {
  double size = std::min(size_, layers_.at(point.norm()));
  for (const Ball& ball : balls_) {
    const double outside = std::max(0.0, (point - ball.centre).norm() - ball.radius);
    size = std::min(size, ball.size + growth_ * outside);
  }
  for (const auto& [circle, along] : circles_) size = std::min(size, along + growth_ * circle.distance(point));
  return size;
}

}  // namespace microinjection
