#include "operation/display/polygon_triangles.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace microinjection {
namespace {

bool contains(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& x) {
  return turn(a, b, x) >= 0 && turn(b, c, x) >= 0 && turn(c, a, x) >= 0;
}

/// What is left of a polygon while its ears are cut off.
class EarClipping {
 public:
  explicit EarClipping(const std::vector<Eigen::Vector2d>& polygon)
      : polygon_(polygon), next_(polygon.size()), previous_(polygon.size()), left_(polygon.size()) {
    const int count = static_cast<int>(polygon.size());
    for (int i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
    }
    for (int i = 0; i < count; ++i) {
      if (!isConvex(i)) reflex_.push_back(i);
    }
  }

  std::vector<std::array<int, 3>> triangles() {
    // A stack: the corners beside an ear are the next candidates, since only theirs may have changed.
    std::vector<int> candidates(polygon_.size());
    std::iota(candidates.rbegin(), candidates.rend(), 0);
    int last = 0;
    while (left_ > 2) {
      // Without a candidate there is rounding, or a curve that crosses itself: go on with any corner.
      int ear = last;
      bool is_ear = candidates.empty();
      if (!is_ear) {
        ear = candidates.back();
        candidates.pop_back();
        is_ear = next_[ear] >= 0 && isEar(ear);
      }
      if (!is_ear) continue;
      last = next_[ear];
      cut(ear, candidates);
    }
    return std::move(triangles_);
  }

 private:
  bool isConvex(int i) const { return turn(polygon_[previous_[i]], polygon_[i], polygon_[next_[i]]) > 0; }

  bool isEar(int i) const {
    if (!isConvex(i)) return false;
    const int before = previous_[i], after = next_[i];
    // Where any corner lies in the triangle, a reflex one does.
    return std::none_of(reflex_.begin(), reflex_.end(), [&](int other) {
      return other != before && other != after &&
             contains(polygon_[before], polygon_[i], polygon_[after], polygon_[other]);
    });
  }

  void cut(int ear, std::vector<int>& candidates) {
    const int before = previous_[ear], after = next_[ear];
    triangles_.push_back({before, ear, after});
    next_[before] = after;
    previous_[after] = before;
    next_[ear] = -1;
    --left_;
    reflex_.erase(
        std::remove_if(reflex_.begin(), reflex_.end(),
                       [&](int i) { return i == ear || ((i == before || i == after) && left_ > 2 && isConvex(i)); }),
        reflex_.end());
    candidates.push_back(after);
    candidates.push_back(before);
  }

  const std::vector<Eigen::Vector2d>& polygon_;
  std::vector<int> next_, previous_;  ///< of each corner; -1: it is cut off
  std::vector<int> reflex_;           ///< corners that are left and not convex
  std::size_t left_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

std::vector<std::array<int, 3>> polygonTriangles(const std::vector<Eigen::Vector2d>& polygon) {
  return polygon.size() < 3 ? std::vector<std::array<int, 3>>() : EarClipping(polygon).triangles();
}

}  // namespace microinjection
