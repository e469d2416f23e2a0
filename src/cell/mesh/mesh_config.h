#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// Configuration of a cell's mesh: a ball about the origin, made of concentric layers. A point on
/// its surface is given by its (x, y) and by its side: +1 on the upper half, -1 on the lower one.
/// Metres.
struct CellMeshConfig {
  enum class Shape {
    kBall,   ///< the ball of a radius about a point of the surface
    kCircle  ///< the curve on the surface at a distance from a vertical line
  };

  /// A region with smaller elements.
  struct Refinement {
    Shape shape = Shape::kBall;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, (x, y) of the vertical line
    double radius = 0;                                 ///< m, of the ball (0: a point) or of the circle
    double side = 1;                                   ///< +1 upper, -1 lower surface
    double size = 0;                                   ///< m, of elements in the ball or along the circle
  };

  /// A curve on the surface at distance `radius` from a vertical line. Edges of the mesh follow it.
  struct Circle {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, (x, y) of the vertical line
    double radius = 0;                                 ///< m
    double side = 1;                                   ///< +1 upper, -1 lower surface
  };

  std::vector<double> radii = {28e-6};  ///< m, outer radius of each layer, outermost first; the first is the cell's
  double size = 12e-6;                  ///< m, of the largest elements
  double growth = 1.0 / 3;              ///< growth of the size per distance from finer regions, in (0, 1]
  double stretch = 1;                   ///< height (z) of the elements over their width, in [1, 4], at the same volume
  std::vector<Refinement> refinements;
  std::vector<Circle> imprints;  ///< none may touch another

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// Configuration of a cell's axisymmetric mesh: half a disc r >= 0 about the origin, made of
/// concentric layers. A point on the outer arc is given by its distance from the axis and its side:
/// +1 on the upper quarter, -1 on the lower one. Metres.
struct SectionMeshConfig {
  /// A region with smaller elements about a point of the outer arc, which becomes a vertex.
  struct Refinement {
    double r = 0;      ///< m, distance of the point from the axis
    double side = 1;   ///< +1 upper, -1 lower quarter
    double reach = 0;  ///< m, the size applies up to this distance from the point
    double size = 0;   ///< m
  };

  /// A point of the outer arc that becomes a vertex.
  struct Point {
    double r = 0;     ///< m, distance from the axis
    double side = 1;  ///< +1 upper, -1 lower quarter
  };

  std::vector<double> radii = {28e-6};  ///< m, outer radius of each layer, outermost first; the first is the cell's
  double size = 4e-6;                   ///< m, of the largest elements
  double growth = 0.3;                  ///< growth of the size per distance from finer regions, in (0, 1]
  std::vector<Refinement> refinements;
  std::vector<Point> vertices;

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// The point (r, z) of a circle about the origin, m. @pre 0 <= r <= radius
Eigen::Vector2d pointOnArc(double r, double side, double radius);

/// Points (r, z) of a layer's arc, m, from top to bottom, each once: its ends on the axis and, of
/// the outer arc, the named points and the centres of refinements. @pre the configuration is valid
std::vector<Eigen::Vector2d> namedPoints(const SectionMeshConfig& config, std::size_t layer);

}  // namespace microinjection
