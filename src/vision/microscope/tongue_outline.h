#pragma once

#include "vision/microscope/microscope_scene.h"

namespace microinjection {

/// The mouth of a pipette that has drawn in a part of a cell, in the image plane (m).
struct DrawingMouth {
  Eigen::Vector2d place{0, 0};  ///< (x, z), m, the middle of the mouth
  Eigen::Vector2d axis{0, -1};  ///< (x, z), of unit length, from the mouth towards the shaft
  double radius = 0;            ///< m, inner
  double length = 0;            ///< m along the axis, from the mouth to the tongue's end
};

/// Returns the outline of a cell (m) with a tongue: in place of what lies before the mouth a cap, part of a sphere, or
/// where it would be more than half of one a cylinder with half a sphere on it. That is the shape of a membrane under
/// a pressure; an elastic shell's tongue (FamilyTongue::outline) is flatter near the lip. Unchanged where the outline
/// does not cross the mouth's edge on both sides, or reaches as far by itself.
CellOutline withTongue(const CellOutline& outline, const DrawingMouth& mouth);

/// Gives the tongue to the outer border of a cell. The others follow it as bell curves, the lower and wider the deeper
/// they are, as in a thick layer. `zona`, `gap`: m, thickness of the zona, 0 without one, and of the gap between it and
/// the ooplasm.
void drawIn(const DrawingMouth& mouth, double zona, double gap, CellScene& cell);

}  // namespace microinjection
