#include "cell/model/bore_tongue.h"

#include <algorithm>
#include <boost/math/special_functions/fpclassify.hpp>  // pchip.hpp takes isnan from it

#include <boost/math/interpolators/pchip.hpp>
#include <cmath>
#include <stdexcept>

#include "base/errors.h"
#include "cell/model/converged_tongue.h"

namespace microinjection {
namespace {

constexpr double kStep = 0.05;       ///< of the suction, over the modulus
constexpr double kStrongest = 1;     ///< same
constexpr double kAway = 0.4;        ///< radius of a tip that does not touch: of the length of the path's steps
constexpr double kTolerance = 0.01;  ///< of the tongue's length, relative

}  // namespace

struct BoreTongue::Curves {
  boost::math::interpolators::pchip<std::vector<double>> length, volume;
};

BoreTongue::BoreTongue(const std::vector<Point>& points) {
  std::vector<double> suctions, lengths, volumes;
  for (const Point& point : points) {
    suctions.push_back(point.suction);
    lengths.push_back(point.length);
    volumes.push_back(point.volume);
  }
  const auto rises = [](const std::vector<double>& values) {
    return values.front() == 0 &&
           std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  };
  if (points.size() < 4 || !rises(suctions) || !rises(lengths) || !rises(volumes))
    throw std::invalid_argument("a tongue needs four points or more that rise from zero");
  strongest_ = suctions.back();
  curves_ = std::make_shared<const Curves>(
      Curves{{std::vector<double>(suctions), std::move(lengths)}, {std::move(suctions), std::move(volumes)}});
}

double BoreTongue::length(double suction) const { return curves_->length(std::min(suction, strongest())); }

double BoreTongue::volume(double suction) const { return curves_->volume(std::min(suction, strongest())); }

Scene boreMouth(const Scene& scene) {
  if (!scene.needle.bore_radius) throw ConfigError("needle/bore_radius: is missing: nothing can be drawn in");
  scene.requireContinuum("suction in the needle");
  const double bore = *scene.needle.bore_radius, wall = scene.needle.tip.radius - bore;
  Scene mouth = scene;
  mouth.cell.layers = {scene.cell.layers.back()};
  mouth.cell.layers.front().surface_tension = 0;
  mouth.needle = {};
  mouth.needle.tip = {"hemisphere", kAway * mouth.radius(), 0};
  mouth.holding_pipette.mouth = Scene::Mouth{bore, scene.needle.tip.radius, wall / 2, 0, {"sliding", 0, 0, 0}};
  return mouth;
}

BoreTongue solveBoreTongue(const Scene& scene) {
  const Scene mouth = boreMouth(scene);
  const double bore = *scene.needle.bore_radius, modulus = mouth.cell.material().young_modulus;
  std::vector<double> pressures;
  for (int i = 0; i * kStep < kStrongest + kStep / 2; ++i) pressures.push_back(-i * kStep * modulus);
  ConvergedTongueConfig config;
  config.tolerance = kTolerance;
  config.finest = 1;
  const std::vector<TonguePoint> solved = convergedTongues(mouth, pressures, config);
  std::vector<BoreTongue::Point> points;
  for (std::size_t i = 0; i < solved.size() && solved[i].converged; ++i) {
    const double length = solved[i].held.tongue_length / bore,
                 volume = solved[i].held.tongue_volume / std::pow(bore, 3);
    if (!points.empty() && (length <= points.back().length || volume <= points.back().volume)) break;
    points.push_back({-pressures[i] / modulus, length, volume});
  }
  if (points.size() < 4) throw ConfigError("needle/bore_radius: the cell has no tongue in it: " + solved.back().reason);
  const BoreTongue::Point first = points.front();
  for (BoreTongue::Point& point : points) {
    point.length -= first.length;
    point.volume -= first.volume;
  }
  return BoreTongue(points);
}

}  // namespace microinjection
