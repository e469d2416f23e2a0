#pragma once

#include <Eigen/Core>
#include <string>

namespace microinjection {

/// Empty, or why what began with images of one size (px, width and height) cannot go on with those of another. (0, 0):
/// not known.
inline std::string sizeChange(const Eigen::Vector2i& begun, const Eigen::Vector2i& now) {
  if (begun.isZero() || now.isZero() || begun == now) return "";
  const auto text = [](const Eigen::Vector2i& s) { return std::to_string(s.x()) + " x " + std::to_string(s.y()); };
  return "the images are of " + text(now) + " px now, and were of " + text(begun) +
         " px when this began: do not bin or crop them meanwhile, and begin anew";
}

}  // namespace microinjection
