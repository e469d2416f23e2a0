#pragma once

#include "base/config_reader.h"
#include "vision/detection/cell_detector.h"
#include "vision/detection/indentation_contour.h"
#include "vision/detection/overlay.h"
#include "vision/detection/pipette_detector.h"

namespace microinjection {

struct SpecimenTrackerConfig {
  double reach = 40;  ///< px, largest motion from one frame to the next
  CellDetectorConfig cell;
  PipetteDetectorConfig injection, holding;

  /// Reads reach and the sections cell, injection_pipette and holding_pipette.
  static SpecimenTrackerConfig read(ConfigReader& reader);
};

/// What one frame shows.
struct SpecimenView {
  CellDetection cell;
  PipetteDetection injection, holding;
  Dimple indentation;

  OverlayContent overlay() const { return {&cell, &holding, &injection, &indentation}; }
};

/// Measures the indentation of a view's cell under its injection pipette, and what the cell is with it. A
/// needle bends the border, and an ellipse through all of it leans into the dimple. The cell gets the centre
/// of the undisturbed outline. Where that is not found, the cell is uncertain. Its borders stay.
void measureIndentation(const Frame& frame, SpecimenView& view);

/// Follows cell and pipettes from frame to frame. What was found is searched near its last place;
/// what is lost is searched in the whole frame. A pipette that is uncertain is followed too, and so is a
/// cell whose diameter is. The whole frame is then searched for a better one in each `kSearchEvery`-th
/// frame only, since a search takes as long as some images.
class SpecimenTracker {
 public:
  explicit SpecimenTracker(const SpecimenTrackerConfig& config);

  /// A refused frame finds nothing, and the next one is searched as a whole.
  const SpecimenView& next(const Frame& frame);
  const SpecimenView& view() const { return view_; }  ///< of the last frame

  static constexpr int kSearchEvery = 30;

 private:
  SpecimenTrackerConfig config_;
  CellDetector cell_;
  PipetteDetector injection_, holding_;
  SpecimenView view_;
  int cell_age_ = 0, injection_age_ = 0, holding_age_ = 0;  ///< frames, since the whole one was searched
};

}  // namespace microinjection
