#include "cell/identification/profile_interval.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kMostFits = 12;
constexpr double kExact = 0.03;   ///< relative, of the rise's root
constexpr double kFarthest = 40;  ///< deviations: beyond it the record does not bound the unknown

}  // namespace

ProfileInterval profileInterval(CurveModel& model, const CurveFit& best, int unknown, double rise, double deviation) {
  const CurveModel::Unknown& limits = model.unknowns()[static_cast<std::size_t>(unknown)];
  const double centre = best.internal[unknown], wanted = std::sqrt(rise);
  ProfileInterval result;
  for (const double side : {-1.0, 1.0}) {
    const double end = side < 0 ? std::max(limits.low, centre - kFarthest * deviation)
                                : std::min(limits.high, centre + kFarthest * deviation);
    // The root of the rise grows about linearly with the distance.
    double inside = 0, inside_root = 0, outside = -1, outside_root = 0;
    double distance = std::min(1.96 * deviation, std::abs(end - centre));
    Eigen::VectorXd start = best.internal;
    bool open = false;
    for (int step = 0; step < kMostFits; ++step) {
      start[unknown] = centre + side * distance;
      const CurveFit held = fitCurve(model, start, best.noise, {unknown});
      open = !held.converged;
      if (open) break;
      const double root = std::sqrt(std::max(0.0, held.cost - best.cost));
      if (std::abs(root / wanted - 1) < kExact) break;
      if (root < wanted) {
        inside = distance;
        inside_root = root;
        start = held.internal;
        open = distance >= std::abs(end - centre);
        if (open) break;
      } else {
        outside = distance;
        outside_root = root;
      }
      const double grown = root > 0 ? std::clamp(wanted / root, 1.2, 3.0) : 3;
      distance = outside < 0
                     ? std::min(grown * distance, std::abs(end - centre))
                     : inside + (outside - inside) *
                                    std::clamp((wanted - inside_root) / (outside_root - inside_root), 0.05, 0.95);
    }
    (side < 0 ? result.low : result.high) = centre + side * distance;
    (side < 0 ? result.bounded_below : result.bounded_above) = !open;
  }
  return result;
}

}  // namespace microinjection
