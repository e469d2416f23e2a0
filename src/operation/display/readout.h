#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// What the text beside the cell says; an absent value was never received or was not valid.
struct Readout {
  std::optional<double> indentation;    ///< m
  std::optional<double> predicted;      ///< N, magnitude
  std::optional<double> measured;       ///< N, magnitude
  std::optional<Eigen::Vector3d> hand;  ///< m, position of the haptic device
  std::string state;                    ///< for example "in contact"
  std::string injection;                ///< for example "indent"; empty: not known
};

/// A figure in millionths, with this many significant digits at the most: micro(12.5e-6, 3) is "12.5".
std::string micro(double value, int digits);

/// A line of the readout and what it is about, which decides on its colour.
struct ReadoutLine {
  enum class About { kState, kMotion, kPredicted, kMeasured };
  About about;
  std::string text;  ///< ASCII, since rviz's font has no Greek
};

/// Top to bottom; a long state takes several lines, broken at spaces, five at the most.
std::vector<ReadoutLine> lines(const Readout& readout);

}  // namespace microinjection
