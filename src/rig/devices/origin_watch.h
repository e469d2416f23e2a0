#pragma once

#include <Eigen/Core>
#include <optional>

namespace microinjection {

/// Where a device may be, in counts of its axes: where it stands, or between the ends of its last move. The box of
/// these ends is kept while nothing is heard of the device, so that one which was switched off and counts from 0 again
/// is noticed. A box, since not every device moves its axes in a straight line.
class OriginWatch {
 public:
  void stands(const Eigen::Vector3d& place) {
    ends_ = Ends{place, place};
    left_ = false;
  }
  /// A move is sent, which the device need not hear.
  void goesTo(const Eigen::Vector3d& place) {
    if (ends_) ends_->to = place;
    left_ = false;
  }
  void hasDeparted() { left_ = true; }  ///< the device has confirmed the move
  void clear() { ends_.reset(); }       ///< any place is believed

  /// Distance (m) of a place from the box; `count`: m of a count of each axis. 0 when nothing is known.
  double outside(const Eigen::Vector3d& place, const Eigen::Vector3d& count) const {
    if (!ends_) return 0;
    const Eigen::Vector3d nearest =
        place.cwiseMax(ends_->from.cwiseMin(ends_->to)).cwiseMin(ends_->from.cwiseMax(ends_->to));
    return (place - nearest).cwiseProduct(count).norm();
  }
  /// Whether it may stand at a place, within `margin` (m), without having been interrupted: at the end of its move, or
  /// where it was when the move has not been confirmed.
  bool mayStandAt(const Eigen::Vector3d& place, const Eigen::Vector3d& count, double margin) const {
    if (!ends_) return true;
    const auto near = [&](const Eigen::Vector3d& end) { return (place - end).cwiseProduct(count).norm() <= margin; };
    return near(ends_->to) || (!left_ && near(ends_->from));
  }
  /// Whether the last move begins and ends at a place, within `margin` (m).
  bool remainsAt(const Eigen::Vector3d& place, const Eigen::Vector3d& count, double margin) const {
    return !ends_ || ((place - ends_->from).cwiseProduct(count).norm() <= margin &&
                      (place - ends_->to).cwiseProduct(count).norm() <= margin);
  }

 private:
  struct Ends {
    Eigen::Vector3d from, to;
  };
  std::optional<Ends> ends_;
  bool left_ = false;
};

}  // namespace microinjection
