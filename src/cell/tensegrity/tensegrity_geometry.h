#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cell/tensegrity/tensegrity_config.h"

namespace microinjection {

/// Positions of the twelve ends of the six struts, and their connections: the expanded octahedron
/// (section III.A).
///
/// Before rotation, the two struts of length L parallel to axis k lie s apart along axis k + 1
/// (cyclic): end 4 k + 2 side + end is at +-L/2 along k and +-s/2 along k + 1. An actin cable
/// connects each end to the four nearest ends of other directions: 24. The paper's "12 cables ...
/// connected to the parallel struts" are all connections between the ends of a parallel pair: its
/// two sides (nearest ends; 12 ends make 6 of these, not 12) and its two diagonals. No other set of
/// end-to-end cables has 12 members and the structure's symmetry; the diagonals all pass through
/// the cell's centre.
///
/// Equilibrium of an end under force densities q = tension / length (strut: compression / L) along
/// both axes:
///
///     q_strut = (2 - s/L) q_actin + q_diagonal        L/s = 2 + (q_side + q_diagonal) / q_actin
///
/// so that L = 2 s with actin cables only, and the strut bears sqrt(6) times a cable's tension
/// (e.g. Stamenovic et al. 1996). All ends lie on the sphere of radius R: L^2 + s^2 = 4 R^2.
///
/// Orientation, by the point on top: `face`, the middle of a triangle of actin cables, with three
/// ends lowest; `edge`, the middle between two ends, with the middle of a strut below it; `vertex`,
/// a strut's end. The three lowest ends are held (at equal height those of lower number).
struct TensegrityGeometry {
  enum class Kind { kActin, kSide, kDiagonal };
  struct Cable {
    int a, b;  ///< ends
    Kind kind;
    double length;       ///< m, in equilibrium
    double rest_length;  ///< m
    double tension;      ///< N, in equilibrium
  };

  std::array<Eigen::Vector3d, 12> ends;       ///< m
  std::array<std::array<int, 2>, 6> struts;   ///< ends
  std::vector<Cable> cables;                  ///< 0 to 23 actin, 24 to 35 intermediate filaments
  std::vector<std::array<int, 3>> triangles;  ///< 20, of neighbouring ends, counter-clockwise seen from outside
  std::array<int, 3> held;                    ///< ends
  double strut_length = 0;                    ///< L, m
  double strut_distance = 0;                  ///< s, m
  double strut_force = 0;                     ///< N, compression in equilibrium

  /// @pre config.validate() passes.
  explicit TensegrityGeometry(const TensegrityConfig& config);
};

}  // namespace microinjection
