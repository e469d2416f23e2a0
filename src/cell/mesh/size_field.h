#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "cell/mesh/circle_on_sphere.h"
#include "cell/mesh/mesh_config.h"

namespace microinjection {

/// Elements along an arc or an imprinted circle. One of the nine is a margin for rounding.
constexpr int kElementsOfArc = 9;

/// Element size for concentric layers, as a function of the distance from their centre. In a layer
/// it is about the thickness; in the innermost ball below other layers it is two thirds of its
/// radius. It grows with the distance from the layer.
class LayerSizes {
 public:
  /// `radii`: m, outermost first. `growth`: of the size per distance.
  LayerSizes(const std::vector<double>& radii, double growth);

  /// Size at a distance from the centre, m; infinity for a single layer.
  double at(double from_centre) const;

 private:
  struct Layer {
    double inner, outer, size;
  };
  std::vector<Layer> layers_;
  double growth_;
};

/// Wanted element size in a cell, m: the smallest of `size`, the sizes of the layers, the
/// refinements and, along imprinted circles, a ninth of their length. All but the first grow with
/// the distance.
class SizeField {
 public:
  explicit SizeField(const CellMeshConfig& config);

  double operator()(const Eigen::Vector3d& point) const;

 private:
  struct Ball {
    Eigen::Vector3d centre;
    double radius, size;
  };
  double size_, growth_;
  LayerSizes layers_;
  std::vector<Ball> balls_;
  std::vector<std::pair<CircleOnSphere, double>> circles_;  // with the size along it
};

}  // namespace microinjection
