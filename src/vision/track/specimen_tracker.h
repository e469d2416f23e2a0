#pragma once

#include <algorithm>
#include <memory>

#include "vision/track/specimen_view.h"

namespace microinjection {

/// Measures the indentation of a view's cell under its injection pipette, and what the cell is with it. A
/// needle bends the border, and an ellipse through all of it leans into the dimple. The cell gets the centre
/// of the undisturbed outline. Where that is not found, the cell is uncertain. Its borders stay.
void measureIndentation(const Frame& frame, SpecimenView& view);

/// When the whole frame is searched for a thing: in each of the first frames in which it is lost or not sure, then
/// more and more rarely while the searches find nothing sure, since one takes as long as some tracked frames.
///
///     searches   1 2 3 4 5 6 7 8   9     10        11 ...
///     frame      1 2 3 4 5 6 7 8  10     14        22 ...     at last every 30 frames, or 8 for what is missing
///
/// A fixed period would either lose a needle for long that went back by more than the reach, or take the processor
/// for what the frame does not show.
class SearchPace {
 public:
  /// Counts a frame. @param most  frames from one search to the next, at most
  bool isDue(int most) { return ++since_ >= std::min(wait_, most); }
  void searched(bool sure);
  int waited() const { return wait_; }  ///< frames, from the search before to the one that is due

  static constexpr int kFirst = 8;  ///< searches in successive frames

 private:
  int since_ = 0, wait_ = 0;  ///< frames
  int searches_ = 0;          ///< without success
};

/// Follows cell and pipettes from frame to frame.
///
///     Frame --> scale --> near the last place --> sure ----+--> measureIndentation() --> SpecimenView, in px of the
///                         (the detectors' track)     |     |                             frame that came
///                                  lost, not sure    '--> pace --> FrameSearch: second eye, the detectors' detect
///
/// What was found is searched near its last place; what is lost is searched in the whole frame (SearchPace). To
/// search each frame anew would be simpler, but takes 37 ms for a cell instead of 6.6 (doc/reference/benchmarks.md).
/// No motion is predicted: a thing may be anywhere within `reach` of its last place.
///
/// A pipette that is uncertain is followed too, and so is a cell whose diameter is. What is followed gives way to
/// something sure only, or in the rarest searches to anything, since its lines would jump to others. In a frame that
/// shows another scene than the last one all is searched that is not followed surely. Where there is a second eye,
/// things are searched where that sees them, and are found where both eyes agree.
class SpecimenTracker {
 public:
  /// @param config  lengths in px of the frames that come
  /// @param eye  none: the whole frame is searched
  explicit SpecimenTracker(const SpecimenTrackerConfig& config, std::shared_ptr<SecondEye> eye = nullptr);

  /// A refused frame finds nothing, and the next one is searched as a whole. A frame wider than kWidest is
  /// searched at half, or a quarter, of its resolution: lines that are many pixels wide are no sharper for them. In one
  /// narrower than kNarrow the needle is searched at twice its resolution.
  const SpecimenView& next(const Frame& frame);
  const SpecimenView& view() const { return view_; }  ///< of the last frame

  /// Frames between two searches for something better than what is followed, and for what is missing, at most.
  static constexpr int kSearchEvery = 30, kSearchMissingEvery = 8;
  static constexpr int kWidest = 1800, kNarrow = 800;  ///< px

 private:
  /// How many px a px of the frame that came is wide in the frame that is searched, and in that of the needle.
  struct Scales {
    double all = 1, needle = 1;
    bool operator==(const Scales& other) const { return all == other.all && needle == other.needle; }
  };

  void setScales(const Scales& scales);
  bool isAnotherScene(const Frame& frame);
  /// @param enlarged  the frame at the needle's scale
  SpecimenView lookAt(const Frame& frame, const Frame& enlarged);

  SpecimenTrackerConfig config_;
  std::shared_ptr<SecondEye> eye_;
  Scales scales_;
  CellDetector cell_;
  PipetteDetector injection_, holding_;
  SpecimenView seen_, view_;  ///< in px of the frame that is searched, and of that which came
  SearchPace cell_pace_, injection_pace_, holding_pace_;
  cv::Mat samples_;  ///< of the last frame's grey values
};

}  // namespace microinjection
