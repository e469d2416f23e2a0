#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "vision/camera/frame_source.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// An image of a stack, and what it shows.
struct CellPlane {
  std::string name;        ///< of the image
  std::size_t number = 0;  ///< in the stack, from 1
  cv::Mat image;
  SpecimenView view;
  double sharpness = 0;
};

/// Searches the plane of a stack in which the cell is the sharpest, see cellSharpness(). Its verdict
/// is that of the stack: a plane in which the cell is found more clearly, but out of focus, would give
/// a wrong diameter. Each plane is searched as a whole, so that one does not mislead the next.
class SharpestPlane {
 public:
  explicit SharpestPlane(const SpecimenTrackerConfig& config, std::shared_ptr<SecondEye> eye = nullptr)
      : config_(config), eye_(std::move(eye)) {}

  void add(const CameraFrame& frame);
  std::size_t planes() const { return planes_; }                  ///< that were added
  std::size_t found() const { return found_; }                    ///< in which the cell's diameter is sure
  const std::optional<CellPlane>& best() const { return best_; }  ///< none: nothing was added
  /// Whether the best plane is the first or the last one: the focus may lie beyond it.
  bool isAtAnEnd() const { return best_ && planes_ > 1 && (best_->number == 1 || best_->number == planes_); }

 private:
  SpecimenTrackerConfig config_;
  std::shared_ptr<SecondEye> eye_;
  std::size_t planes_ = 0, found_ = 0;
  std::optional<CellPlane> best_;
};

}  // namespace microinjection
