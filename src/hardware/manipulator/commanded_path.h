#pragma once

#include <Eigen/Core>
#include <deque>
#include <limits>

namespace microinjection {

/// The set-points of the last seconds, against which the readings of a device are judged that follows
/// them: a device with a lag of at most L is always on the part that was commanded within the last L,
/// whatever its speed. Times in s, places in m.
class CommandedPath {
 public:
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  ///< m
    double time = 0;                                            ///< s, at which that place was commanded
  };

  /// `duration`: s, for which a set-point is kept.
  explicit CommandedPath(double duration) : duration_(duration) {}

  void clear() { points_.clear(); }
  bool empty() const { return points_.empty(); }
  double begin() const { return points_.front().time; }  ///< s, of the oldest. @pre not empty

  /// The set-point from `time` on.
  void add(double time, const Eigen::Vector3d& place);

  /// Where a place is nearest to the straight parts that were commanded from `from` to `to`, and to the set-point that
  /// held at `from`; the latest of equal ones. Infinite without any.
  Nearest nearest(const Eigen::Vector3d& place, double from, double to) const;
  /// m, of the path from `from` to `to`.
  double length(double from, double to) const;

 private:
  struct Point {
    double time;
    Eigen::Vector3d place;
  };
  double duration_;
  std::deque<Point> points_;
};

}  // namespace microinjection
