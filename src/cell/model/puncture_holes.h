#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace microinjection {

/// Holes of a needle in the outermost layer, one for each puncture. The newest kMost are kept.
class PunctureHoles {
 public:
  static constexpr int kMost = 64;
  struct Hole {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, of the tip at first contact
    int layers = 0;                                      ///< number of failed layers there, outermost first
    double length = 0;                                   ///< m, undeformed, of a hole by mechanics; else 0
    std::optional<double> left;                          ///< s, when the needle left it; none: the needle is in it
  };

  /// Returns the hole's index, valid until 64 others have been added.
  int add(const Hole& hole) {
    const int index = made_ % kMost;
    holes_[index] = hole;
    ++made_;
    return index;
  }

  /// Moves the holes with a surface that grows by `factor`.
  void scale(double factor) {
    for (int i = 0; i < count(); ++i) holes_[i].position *= factor;
  }

  int count() const { return made_ < kMost ? made_ : kMost; }
  Hole& operator[](int index) { return holes_[index]; }
  const Hole& operator[](int index) const { return holes_[index]; }

  /// The hole nearest to the line through `tip` (m) along `axis` (unit, out of the cell), within
  /// `radius`, m, of it and on the needle's side of the cell; empty if there is none.
  std::optional<int> under(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double radius) const {
    std::optional<int> nearest;
    for (int i = 0; i < count(); ++i) {
      if (!(distance(i, tip, axis) <= radius && holes_[i].position.dot(axis) > 0)) continue;
      radius = distance(i, tip, axis);
      nearest = i;
    }
    return nearest;
  }

 private:
  double distance(int index, const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) const {
    const Eigen::Vector3d offset = holes_[index].position - tip;
    return (offset - offset.dot(axis) * axis).norm();
  }

  std::array<Hole, kMost> holes_;
  int made_ = 0;
};

}  // namespace microinjection
