#include "hardware/manipulator/commanded_path.h"

#include <algorithm>

namespace microinjection {

void CommandedPath::add(double time, const Eigen::Vector3d& place) {
  points_.push_back({time, place});
  // The one before the kept ones held until they began.
  while (points_.size() > 2 && points_[1].time < time - duration_) points_.pop_front();
}

CommandedPath::Nearest CommandedPath::nearest(const Eigen::Vector3d& place, double from, double to) const {
  Nearest best;
  const auto offer = [&best](double distance, double time) {
    if (distance <= best.distance) best = {distance, time};
  };
  for (std::size_t i = 0; i < points_.size() && points_[i].time <= to; ++i) {
    const Point& point = points_[i];
    const bool held = i + 1 == points_.size() || points_[i + 1].time > from;  // at some time of the interval
    if (i > 0 && point.time >= from) {
      const Point& before = points_[i - 1];
      const Eigen::Vector3d way = point.place - before.place;
      const double length = way.squaredNorm();
      const double share = length > 0 ? std::clamp((place - before.place).dot(way) / length, 0.0, 1.0) : 1;
      offer((before.place + share * way - place).norm(), before.time + share * (point.time - before.time));
    }
    if (held) {
      const double until = i + 1 == points_.size() ? to : std::min(to, points_[i + 1].time);
      offer((point.place - place).norm(), until);
    }
  }
  return best;
}

double CommandedPath::length(double from, double to) const {
  double length = 0;
  for (std::size_t i = 1; i < points_.size(); ++i)
    if (points_[i].time >= from && points_[i].time <= to) length += (points_[i].place - points_[i - 1].place).norm();
  return length;
}

}  // namespace microinjection
