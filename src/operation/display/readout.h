#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "operation/display/depth_gauge.h"

namespace microinjection {

/// A force on the tip, along the pipette towards its shaft and across it (its size), N. A single norm would
/// show the noise of the lateral axes as a force.
struct ForceParts {
  double along = 0, across = 0;
};

/// @param axis  of unit length, from the tip to the shaft, in the frame of the force
ForceParts partsOf(const Eigen::Vector3d& force, const Eigen::Vector3d& axis);

/// The values of the text beside the cell; an absent value is invalid or was never received.
struct Readout {
  std::optional<double> indentation;  ///< m
  std::optional<ForceParts> predicted;
  std::optional<ForceParts> measured;
  std::optional<Eigen::Vector3d> hand;  ///< m, position of the haptic device
  std::optional<PunctureDepth> puncture;
  std::string state;      ///< for example "in contact"
  std::string injection;  ///< for example "indent"; empty: unknown
};

/// A value in millionths with at most this many significant digits: micro(12.5e-6, 3) is "12.5".
std::string micro(double value, int digits);

/// A line of the readout, with its subject, which determines the colour.
struct ReadoutLine {
  enum class About { kState, kMotion, kPredicted, kMeasured };
  About about;
  std::string text;  ///< ASCII, since rviz's font has no Greek
};

/// The lines from top to bottom; a long state takes up to five, broken at spaces.
std::vector<ReadoutLine> lines(const Readout& readout);

}  // namespace microinjection
