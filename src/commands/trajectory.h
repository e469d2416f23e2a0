#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// Sample of a recorded session in which the tip touched the cell.
struct ContactSample {
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< m, in the world
  double axial_force = 0;                         ///< N, predicted, along the pipette
};

/// The longest indentation in a session's table (force_depth.csv of the session recorder), from
/// first contact to the deepest point of that contact. When a layer fails (optional column
/// `punctured`), the path ends at the largest force before, because the cell reports a puncture
/// some milliseconds late. Throws ConfigError when the file cannot be read, lacks a column or has
/// no contact.
std::vector<ContactSample> readIndentationPath(const std::string& path);

/// `count` samples of an indentation, evenly in depth; the last is the deepest.
std::vector<ContactSample> thinOut(const std::vector<ContactSample>& path, int count);

}  // namespace microinjection
