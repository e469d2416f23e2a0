#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

/// Where a second eye sees a cell, to some pixels.
struct ProposedCell {
  Ellipse ooplasm;              ///< px; of a cell or vesicle without a zona all of it
  std::optional<Ellipse> zona;  ///< px, its outer border; none: no zona is seen
  bool perhaps_zona = false;    ///< parts of a zona are seen: whether there is one is not known
  bool held = false;            ///< at the mouth of a holding pipette
};

/// Where a second eye sees a pipette, to some pixels.
struct ProposedPipette {
  cv::Point2d end;        ///< px, tip or middle of the mouth
  cv::Point2d entry;      ///< px, where its axis leaves the frame
  double half_width = 0;  ///< px, mean over its length
  double tolerance = 0;   ///< px, within which an end is this one

  double direction() const;  ///< rad, from the end towards the shaft, from x towards y
};

/// Something round in a frame beside the cell.
struct OtherThing {
  std::string kind;  ///< "cell with zona", "cell", "bubble" or "debris"
  Ellipse ellipse;   ///< px

  bool isCell() const { return kind.rfind("cell", 0) == 0; }
};

/// How likely glass is at the places of a frame, coarsely.
struct GlassMap {
  cv::Mat probability;    ///< CV_32F; empty: not known
  double scale = 1;       ///< px of the map for a px of the frame
  cv::Point2d shift;      ///< px of the map, of the frame's px (0, 0)
  bool anywhere = false;  ///< it is likely somewhere

  double at(const cv::Point2d& place) const;
  /// Mean along a shaft of `length` px behind an end.
  double along(const cv::Point2d& end, double direction, double length) const;
};

/// What a second eye sees in a frame. Who proposes does not measure.
struct Proposal {
  std::vector<ProposedCell> cells;  ///< that which is held first, then the largest first
  std::vector<OtherThing> things;   ///< that are no cells
  std::optional<ProposedPipette> injection, holding;
  GlassMap glass;
};

/// Looks at a frame before anything is measured in it, and knows what cells and pipettes look like.
class SecondEye {
 public:
  virtual ~SecondEye() = default;
  /// The frame has no refusal.
  virtual Proposal propose(const Frame& frame) = 0;
  /// A closer look at one of the pipettes that it has proposed for this frame.
  virtual ProposedPipette lookCloser(const Frame& frame, const std::string& kind, const ProposedPipette& pipette) = 0;
};

inline double GlassMap::at(const cv::Point2d& place) const {
  const int x = static_cast<int>(std::lround(scale * place.x + shift.x));
  const int y = static_cast<int>(std::lround(scale * place.y + shift.y));
  const bool inside = x >= 0 && y >= 0 && x < probability.cols && y < probability.rows;
  return inside ? probability.at<float>(y, x) : 0;
}

inline double GlassMap::along(const cv::Point2d& end, double direction, double length) const {
  constexpr int kPlaces = 24;
  double sum = 0;
  for (int i = 1; i <= kPlaces; ++i)
    sum += at(end + length * i / kPlaces * cv::Point2d(std::cos(direction), std::sin(direction))) / kPlaces;
  return sum;
}

inline double ProposedPipette::direction() const { return std::atan2(entry.y - end.y, entry.x - end.x); }

}  // namespace microinjection
