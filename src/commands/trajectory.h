#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// A moment of a recorded session in which the tip touched the cell.
struct ContactSample {
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< m, in the world
  double axial_force = 0;                         ///< N, predicted, along the pipette
};

/// The longest way in of a session's table (force_depth.csv of the session recorder): from the first touch to the
/// deepest place before the contact ended, or to where a layer gave way (column punctured, where there is one: the
/// cell says so some milliseconds late, hence the largest force before). Throws ConfigError when the file cannot be
/// read, lacks a column or has no contact.
std::vector<ContactSample> readIndentationPath(const std::string& path);

/// `count` moments of a way in, evenly in depth, the deepest the last.
std::vector<ContactSample> thinOut(const std::vector<ContactSample>& way, int count);

}  // namespace microinjection
