#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

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
