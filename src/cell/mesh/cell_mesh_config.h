#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// What determines the mesh of a cell: a ball about the origin, made of concentric layers. Places on its surface are
/// given by the vertical line (x, y) through them and by the side: +1 the upper half, -1 the lower one. Metres.
struct CellMeshConfig {
  enum class Shape {
    kBall,   ///< the ball of a radius about a point of the surface; no distance inside of it
    kCircle  ///< the curve on the surface at a distance from a vertical line
  };

  /// Where elements are smaller.
  struct Refinement {
    Shape shape = Shape::kBall;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, (x, y) of the vertical line
    double radius = 0;                                 ///< m, of the ball (0: a point) or of the circle
    double side = 1;                                   ///< +1 upper, -1 lower surface
    double size = 0;                                   ///< m, of elements in the ball or along the circle
  };

  /// A curve on the surface, at distance `radius` from a vertical line, that edges of the mesh follow.
  struct Circle {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, (x, y) of the vertical line
    double radius = 0;                                 ///< m
    double side = 1;                                   ///< +1 upper, -1 lower surface
  };

  std::vector<double> radii = {28e-6};  ///< m, outer radius of each layer, outermost first; the first is the cell's
  double size = 12e-6;                  ///< m, of the largest elements
  double growth = 1.0 / 3;              ///< the size grows by this times the distance from what is finer, in (0, 1]
  double stretch = 1;                   ///< height of the elements (z) over their width, from 1 to 4, same volume
  std::vector<Refinement> refinements;
  std::vector<Circle> imprints;  ///< none may touch another

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

}  // namespace microinjection
