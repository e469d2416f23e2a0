#pragma once

#include <string>
#include <vector>

#include "base/config_reader.h"
#include "vision/calibration/statistics.h"

namespace microinjection {

struct TipFocusConfig {
  int planes_beside = 5;             ///< planes to either side of the sharpest one that are fitted
  double least_contrast = 0.15;      ///< 1, of the peak above its feet, over its height
  double false_rate = 1e-3;          ///< 1, peaks found in a series without one
  double largest_interval = 0.6e-6;  ///< m, largest half width of the 95 % interval
  double second_peak = 0.8;          ///< 1, share of the peak's height above which another peak is ambiguous

  static TipFocusConfig read(ConfigReader& reader);
};

/// Sharpness around the tip in one plane.
struct FocusSample {
  double height = 0;     ///< m, of the focal plane
  double sharpness = 0;  ///< any unit, larger where the tip is sharper
};

enum class FocusVerdict {
  kFocus,    ///< at `height`
  kBorder,   ///< the peak is at an end of the planes; `towards` says which planes to add
  kNoPeak,   ///< the planes do not differ
  kUnsure,   ///< two peaks, or the height is vague
  kInvalid,  ///< the samples are unusable
};

struct FocusReport {
  FocusVerdict verdict = FocusVerdict::kInvalid;
  double height = 0;  ///< m
  Interval interval;  ///< m, 95 % by Student's t
  int towards = 0;    ///< +1: the peak lies at or beyond the highest plane, -1: the lowest
  std::string text;   ///< one sentence with numbers
};

/// Best focus of the tip: the middle c of a bell fitted (Ceres) to the planes beside the sharpest,
///     sharpness = base + height exp(-(h - c)^2 / (2 w^2)).
/// Cauchy's loss first, then least squares without outliers; scaled by the residuals.
///
/// A transparent tip in bright field has no bell: its contrast vanishes in focus and is reversed beyond it.
/// Two peaks within 8 planes give the height of the valley between them as kUnsure, with an interval of
/// one plane to both sides. Only an image can show that the contrast is reversed.
FocusReport findFocus(std::vector<FocusSample> samples, const TipFocusConfig& config);

}  // namespace microinjection
