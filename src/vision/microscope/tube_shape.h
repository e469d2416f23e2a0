#pragma once

#include "vision/camera/camera_view.h"
#include "vision/microscope/microscope_scene.h"

namespace microinjection {

/// The outline of a pipette in the image; lengths in px, `s` along the axis from the end face towards the shaft.
struct TubeShape {
  Eigen::Vector2f end, axis;
  double radius;   ///< at the end
  double growth;   ///< of the radius per px
  double largest;  ///< radius where the growth ends
  double inner;    ///< inner over outer radius
  double lip;      ///< px, radius to which the end of the wall is rounded; 0: cut straight

  TubeShape(const HoldingPipette& pipette, const CameraView& view);
  TubeShape(const InjectionPipette& pipette, const CameraView& view);

  /// Straight near the end, and bending to its largest value.
  double radiusAt(double s) const;
  double slopeAt(double s) const;
  /// px along the axis at which the end face lies behind that of the middle, at the distance `r` (px) from the axis.
  double lipAt(double r) const;

 private:
  double bent(double s) const;
};

}  // namespace microinjection
