#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "operation/display/display_scale.h"
#include "operation/display/triangle_soup.h"

namespace microinjection {

/// Struts and cables of a tensegrity cell, as the simulator reports them.
struct CellMembers {
  static constexpr int kStrut = 0, kActin = 1, kIntermediate = 2;

  std::vector<Eigen::Vector3d> points;  ///< m, start and end of each member
  std::vector<double> forces;           ///< N, of each member, positive in tension
  std::vector<int> kinds;               ///< of each member

  /// Empty when they can be drawn, otherwise the reason: not finite, or lengths that do not match.
  std::string defect() const;
  double largestTension() const;  ///< N; 0 without any
};

/// Segments with a colour for each of their points, display units.
struct ColouredLines {
  LineList lines;
  std::vector<Colour> colours;
};

/// The struts, in one colour.
ColouredLines strutLines(const CellMembers& members, double enlargement = kDisplayScale);
/// The cables, coloured by tension from 0 to `range` (N, > 0); a slack one is grey.
ColouredLines cableLines(const CellMembers& members, double range, double enlargement = kDisplayScale);

}  // namespace microinjection
