#include "cell/estimation/force_path.h"

#include <algorithm>

namespace microinjection {

void ForcePath::predict(const std::vector<SampleHistory::Sample>& samples, double shift, std::vector<Point>& points) {
  contact_.reset();
  memory_.reset();
  points.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SurrogateContact::Result step = contact_.step(samples[i].tip - shift * Eigen::Vector3d::UnitZ());
    const double duration = i > 0 ? std::max(0.0, samples[i].time - samples[i - 1].time) : 0;
    const Eigen::Vector3d viscous = memory_.step(step.force, duration);
    Point& point = points[i];
    point.touches = contact_.contactFrame().has_value();
    point.force = step.force.z() + viscous.z();
    point.depth = point.touches ? -contact_.displacement().z() : 0;
    point.prepared = step.prepared && !step.too_deep;
  }
}

}  // namespace microinjection
