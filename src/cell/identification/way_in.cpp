#include "cell/identification/way_in.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr double kTurn = 0.02;        ///< of the way: a smaller step back is noise, or a needle that trembles
constexpr double kRests = 0.05;       ///< of the median speed of the way in, below which the tip rests
constexpr double kHeld = 0.05;        ///< of the median speed of a growing force, below which it is held
constexpr std::size_t kBeside = 2;    ///< samples on either side of one, for a median
constexpr double kFall = 0.25;        ///< of the force at its crest, that a puncture takes from it
constexpr double kLeastFall = 0.1;    ///< of the force's range: a smaller fall is no puncture
constexpr double kSudden = 0.05;      ///< of the way, within which a puncture does so
constexpr double kNoise = 20;         ///< times the median step of the force: a smaller fall may be noise
constexpr std::size_t kFewest = 4;    ///< samples of a hold
constexpr std::size_t kWindows = 60;  ///< of the way in, whose speeds are compared

std::vector<double> medians(const std::vector<double>& values, std::size_t beside) {
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t from = i < beside ? 0 : i - beside, to = std::min(values.size(), i + beside + 1);
    result[i] = upperMedian(
        {values.begin() + static_cast<std::ptrdiff_t>(from), values.begin() + static_cast<std::ptrdiff_t>(to)});
  }
  return result;
}

/// A median knows the deepest sample to some neighbours only. Of equally deep ones the last, when they are a hold.
std::size_t deepestSample(const std::vector<double>& position, std::size_t about) {
  std::size_t first = about < 2 * kBeside ? 0 : about - 2 * kBeside, last = first;
  for (std::size_t i = first; i < std::min(position.size(), about + 2 * kBeside + 1); ++i) {
    if (position[i] > position[last]) first = i;
    if (position[i] >= position[last]) last = i;
  }
  return last - first + 1 < kFewest ? first : last;
}

/// Where the last way down to `deepest` begins.
std::size_t lastTurn(const std::vector<double>& path, std::size_t deepest, double tolerance) {
  std::size_t turn = deepest;
  for (std::size_t i = deepest; i-- > 0;) {
    if (path[i] < path[turn]) turn = i;
    if (path[i] > path[turn] + tolerance) break;
  }
  return turn;
}

/// The sample behind the last one in which a quantity grows: at the end it stands, or grows much more slowly than the
/// median of where it grows. `share`: of that speed.
std::size_t endOfGrowth(const std::vector<double>& time, const std::vector<double>& values, std::size_t begin,
                        std::size_t end, double share) {
  const std::size_t window = std::max<std::size_t>(2, (end - begin) / kWindows);
  std::vector<double> speeds;
  for (std::size_t i = begin; i + window < end; ++i) {
    const double dt = time[i + window] - time[i];
    speeds.push_back(dt > 0 ? (values[i + window] - values[i]) / dt : 0);
  }
  if (speeds.empty()) return end;
  const double fastest = *std::max_element(speeds.begin(), speeds.end());
  std::vector<double> growing;
  std::copy_if(speeds.begin(), speeds.end(), std::back_inserter(growing),
               [&](double v) { return v > share * fastest; });
  const double slow = share * upperMedian(growing);
  std::size_t last = speeds.size();
  while (last > 0 && speeds[last - 1] < slow) --last;
  const std::size_t stands_from = begin + last + (last < speeds.size() ? window / 2 : window);
  return end - std::min(end, stands_from) < std::max(kFewest, window) ? end : stands_from;
}

std::string samples(std::size_t count) { return std::to_string(count) + (count == 1 ? " sample" : " samples"); }

}  // namespace

WayIn findWayIn(const std::vector<double>& time, const std::vector<double>& position) {
  WayIn way;
  way.end = position.size();
  if (position.size() < 2 * kFewest) return way;
  const std::vector<double> path = medians(position, kBeside);
  const auto [least, most] = std::minmax_element(path.begin(), path.end());  // of equal ones the last is the most
  const std::size_t deepest = deepestSample(position, static_cast<std::size_t>(most - path.begin()));
  if (deepest + 1 < way.end)
    way.notes.push_back("the " + samples(way.end - deepest - 1) + " behind the deepest one are left out");
  way.begin = lastTurn(path, deepest, kTurn * (*most - *least));
  if (way.begin > 0) way.notes.push_back("the " + samples(way.begin) + " before the last turn are left out");
  way.end = endOfGrowth(time, path, way.begin, deepest + 1, kRests);
  if (way.end <= deepest)
    way.notes.push_back("the " + samples(deepest + 1 - way.end) + " of a hold are left out: the tip rests");
  return way;
}

std::size_t endOfLoading(const std::vector<double>& time, const std::vector<double>& force) {
  if (force.size() < 2 * kFewest) return force.size();
  const std::vector<double> smooth = medians(force, kBeside);
  std::vector<double> steps;
  for (std::size_t i = 1; i < smooth.size(); ++i) steps.push_back(std::abs(smooth[i] - smooth[i - 1]));
  if (smooth.back() - smooth.front() < kNoise * upperMedian(steps)) return force.size();
  return endOfGrowth(time, smooth, 0, force.size(), kHeld);
}

std::optional<std::size_t> crestBeforePuncture(const std::vector<double>& position, const std::vector<double>& force) {
  if (force.size() < 2 * kFewest) return std::nullopt;
  const std::vector<double> smooth = medians(force, kBeside);
  const auto [least, most] = std::minmax_element(smooth.begin(), smooth.end());
  const double range = *most - *least, sudden = kSudden * (position.back() - position.front());
  std::vector<double> steps;
  for (std::size_t i = 1; i < smooth.size(); ++i) steps.push_back(std::abs(smooth[i] - smooth[i - 1]));
  const double least_fall = std::max(kLeastFall * range, kNoise * upperMedian(steps));
  if (least_fall > range) return std::nullopt;
  const auto at = [&](std::size_t i) { return smooth.begin() + static_cast<std::ptrdiff_t>(i); };
  std::size_t crest = 0;
  for (std::size_t i = 1; i < smooth.size(); ++i) {
    if (smooth[i] >= smooth[crest]) crest = i;
    // A crest that is too far back: the highest of those behind it takes its place.
    while (crest < i && position[i] - position[crest] > sudden)
      crest = static_cast<std::size_t>(std::max_element(at(crest + 1), at(i + 1)) - smooth.begin());
    // A force that falls from nothing is of a tip that snaps in.
    const double fall = smooth[crest] - smooth[i];
    if (fall < least_fall) continue;
    const double rise = smooth[crest] - *std::min_element(at(0), at(crest + 1));
    if (rise > least_fall && fall > kFall * rise) return crest;
  }
  return std::nullopt;
}

}  // namespace microinjection
