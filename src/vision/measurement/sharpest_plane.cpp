#include "vision/measurement/sharpest_plane.h"

#include "vision/measurement/sharpness.h"

namespace microinjection {

void SharpestPlane::add(const CameraFrame& frame) {
  ++planes_;
  SpecimenTracker tracker(config_, eye_);
  const Frame image(frame.image);
  const SpecimenView view = tracker.next(image);
  if (view.cell.size.isFound()) ++found_;
  const double sharpness = cellSharpness(image, view.cell);
  const bool has_values = view.cell.finding.hasValues();
  if (best_ && (!has_values || (best_->view.cell.finding.hasValues() && sharpness <= best_->sharpness))) return;
  best_ = CellPlane{frame.name, planes_, frame.image, view, sharpness};
}

}  // namespace microinjection
