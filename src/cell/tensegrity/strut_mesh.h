#pragma once

#include <Eigen/Core>

#include "cell/mesh/tet_mesh.h"

namespace microinjection {

struct StrutMeshConfig {
  double length = 50e-6;  ///< m, between the apexes
  double section = 0;     ///< m^2, of the strut
  int slices = 32;        ///< along the length
  double bow = 0;         ///< of the middle towards `bow_direction`, over the length: half a sine wave
};

/// Tetrahedra of one strut. Its section is a regular pentagon of the given area, whose second
/// moment is 1.7 % above that of the circle. Along the length it is divided into slices of nine
/// tetrahedra without a vertex inside of the section. At either end the five corners converge, over
/// half a circumradius of the section, to one apex. The apex is a hinge for cables and membrane.
/// Six struts of 32 slices have 1002 vertices and 1764 tetrahedra (the paper: 1014, 1798).
struct StrutMesh {
  static constexpr int kCorners = 5;
  TetMesh mesh;  ///< of this strut alone

  StrutMesh(const StrutMeshConfig& config, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
            const Eigen::Vector3d& bow_direction);

  int firstApex() const { return 0; }
  int lastApex() const { return static_cast<int>(mesh.vertices.size()) - 1; }
  int vertex(int section, int corner) const { return 1 + kCorners * section + corner; }  ///< section: 0 to slices

  /// Circumradius of the pentagon, m.
  static double circumradius(double section);
  /// Second moment of the pentagon, m^4.
  static double secondMoment(double section);
};

}  // namespace microinjection
