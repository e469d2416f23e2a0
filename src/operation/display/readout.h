#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "operation/display/depth_gauge.h"

namespace microinjection {

/// The values of the text beside the cell; an absent value is invalid or was never received.
struct Readout {
  std::optional<double> indentation;    ///< m
  std::optional<double> predicted;      ///< N, magnitude
  std::optional<double> measured;       ///< N, magnitude
  std::optional<Eigen::Vector3d> hand;  ///< m, position of the haptic device
  std::optional<ExpectedPuncture> puncture;
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
