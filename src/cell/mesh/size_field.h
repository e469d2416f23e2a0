#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "cell/mesh/cell_mesh_config.h"
#include "cell/mesh/circle_on_sphere.h"

namespace microinjection {

/// Element size that concentric layers need, of the distance from their centre: in a layer about its thickness, in
/// the innermost ball, if it has a layer around it, two thirds of its radius; growing with the distance from it.
class LayerSizes {
 public:
  /// `radii`: m, outermost first. `growth`: of the size with distance.
  LayerSizes(const std::vector<double>& radii, double growth);

  /// Size at a distance from the centre, m; infinity when nothing is asked for.
  double at(double from_centre) const;

 private:
  struct Layer {
    double inner, outer, size;
  };
  std::vector<Layer> layers_;
  double growth_;
};

/// Wanted element size in a cell: the smallest of `size`, of what the layers need, of the refinements and, along
/// imprinted circles, of a ninth of their length; each but the first grows with the distance. In metres.
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
  std::vector<std::pair<CircleOnSphere, double>> circles_;  // and the size along it
};

}  // namespace microinjection
