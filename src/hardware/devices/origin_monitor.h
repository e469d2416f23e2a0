#pragma once

#include <Eigen/Core>
#include <optional>

namespace microinjection {

/// The possible positions of a device, in counts of its axes: where it rests, or between the ends
/// of its last move. The bounding box of these ends is kept while the device does not reply, to
/// detect a device that was switched off and counts from 0 again. A box, since not every device
/// moves its axes in a straight line.
class OriginMonitor {
 public:
  void setAtRest(const Eigen::Vector3d& position) {
    ends_ = Ends{position, position};
    departed_ = false;
  }
  /// A move is sent; the device may not have received it.
  void setMove(const Eigen::Vector3d& position) {
    if (ends_) ends_->to = position;
    departed_ = false;
  }
  void confirmMove() { departed_ = true; }  ///< the device has confirmed the move
  void clear() { ends_.reset(); }           ///< any position is accepted

  /// Distance (m) of a position from the box; `count`: m per count of each axis. 0 without a box.
  double outside(const Eigen::Vector3d& position, const Eigen::Vector3d& count) const {
    if (!ends_) return 0;
    const Eigen::Vector3d nearest =
        position.cwiseMax(ends_->from.cwiseMin(ends_->to)).cwiseMin(ends_->from.cwiseMax(ends_->to));
    return (position - nearest).cwiseProduct(count).norm();
  }
  /// Whether the device may rest at a position, within `margin` (m), without an interruption: at
  /// the end of its move, or at the start of an unconfirmed move.
  bool mayStandAt(const Eigen::Vector3d& position, const Eigen::Vector3d& count, double margin) const {
    if (!ends_) return true;
    const auto near = [&](const Eigen::Vector3d& end) { return (position - end).cwiseProduct(count).norm() <= margin; };
    return near(ends_->to) || (!departed_ && near(ends_->from));
  }
  /// Whether the last move starts and ends at a position, within `margin` (m).
  bool remainsAt(const Eigen::Vector3d& position, const Eigen::Vector3d& count, double margin) const {
    return !ends_ || ((position - ends_->from).cwiseProduct(count).norm() <= margin &&
                      (position - ends_->to).cwiseProduct(count).norm() <= margin);
  }

 private:
  struct Ends {
    Eigen::Vector3d from, to;
  };
  std::optional<Ends> ends_;
  bool departed_ = false;
};

}  // namespace microinjection
