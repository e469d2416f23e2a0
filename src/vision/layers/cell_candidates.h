#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/frame/frame.h"

namespace microinjection {

/// A place where a round border may be.
struct CellCandidate {
  cv::Point2d centre;  ///< px
  double radius = 0;   ///< px
  double share = 0;    ///< of the circle that has an edge along it, roughly
};

/// Finds circles of radius [low, high] (px) by the votes of edges along their normals, in a reduced
/// frame. Best first, at most `most`; circles about one centre are one candidate, the best of them.
/// After Ballard, Pattern Recognition 13 (1981), with radii in steps of 12 %.
std::vector<CellCandidate> findCellCandidates(const Frame& frame, double low, double high, int most);

}  // namespace microinjection
