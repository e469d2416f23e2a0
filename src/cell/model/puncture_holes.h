#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace microinjection {

/// Where a needle was through the outermost layer: a hole a puncture. Of more than kMost the oldest are forgotten.
class PunctureHoles {
 public:
  static constexpr int kMost = 64;
  struct Hole {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m, of the tip as it touched there
    int layers = 0;                                   ///< that have failed there, outermost first
  };

  /// Its index, valid until the next add().
  int add(const Hole& hole) {
    const int index = made_ % kMost;
    holes_[index] = hole;
    ++made_;
    return index;
  }

  int count() const { return made_ < kMost ? made_ : kMost; }
  Hole& operator[](int index) { return holes_[index]; }
  const Hole& operator[](int index) const { return holes_[index]; }

  /// The nearest to the line through `tip` (m) along `axis` (unit, out of the cell) that is within `radius`, m, of it,
  /// on the side of the cell that the needle comes from; none if none is.
  std::optional<int> under(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double radius) const {
    std::optional<int> nearest;
    for (int i = 0; i < count(); ++i) {
      if (!isOnNeedleLine(i, tip, axis, radius)) continue;
      radius = distance(i, tip, axis);
      nearest = i;
    }
    return nearest;
  }
  bool isOnNeedleLine(int index, const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double radius) const {
    return distance(index, tip, axis) <= radius && holes_[index].place.dot(axis) > 0;
  }

 private:
  double distance(int index, const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) const {
    const Eigen::Vector3d way = holes_[index].place - tip;
    return (way - way.dot(axis) * axis).norm();
  }

  std::array<Hole, kMost> holes_;
  int made_ = 0;
};

}  // namespace microinjection
