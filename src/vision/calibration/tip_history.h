#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// A pipette's tip as it was found in the holder. `place` (m): position (x, z) of the manipulator
/// that brings the tip to the reference pixel. A longer pipette has another place.
struct TipRecord {
  std::string date;  ///< UTC, YYYY-MM-DDTHH:MM:SSZ
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

/// Where the next tip is expected, from the ones before. For each coordinate
///     median +- t(99.75 %, n - 1) sqrt(1 + 1 / n) max(1.4826 MAD, 10 um).
/// Of tips with normal scatter, 3 to 7 in a hundred lie outside: MAD of few values is often small.
struct TipRegion {
  int count = 0;                   ///< n
  Eigen::Vector2d median, spread;  ///< m; the spread is 1.4826 MAD, at least 10 um
  Eigen::Vector2d low, high;       ///< m
  bool contains(const Eigen::Vector2d& place) const;
};

/// None below four tips.
std::optional<TipRegion> tipRegion(const std::vector<TipRecord>& history);

/// Empty, or a warning with numbers: the tip lies outside the region of `history`.
std::string tipWarning(const TipRecord& tip, const std::vector<TipRecord>& history);

/// Whether `text` is a date YYYY-MM-DDTHH:MM:SSZ.
bool isDate(const std::string& text);

}  // namespace microinjection
