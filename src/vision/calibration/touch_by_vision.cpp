#include "vision/calibration/touch_by_vision.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace microinjection {
namespace {

constexpr int kRobustSteps = 3;  ///< touches tried between two heights, of the robust fit
constexpr int kRobustIterations = 15;
constexpr int kSteps = 25;                ///< and of the profile
constexpr double kNormalMedian = 0.6745;  ///< of the size of a standard normal value

/// The samples along the approach, in micrometres, so that the columns are of one size.
struct Series {
  Eigen::VectorXd way;     ///< um from the first height
  Eigen::MatrixXd pixel;   ///< px times the weight, a row for each sample
  Eigen::VectorXd weight;  ///< reciprocal of the deviation
  double exponent = 1;

  int coordinates() const { return static_cast<int>(pixel.cols()); }
  double size() const { return static_cast<double>(way.size()); }
  double measured() const { return coordinates() * size(); }
  int lineParameters() const { return 2 * coordinates(); }       ///< a, c of each coordinate
  int touchParameters() const { return 3 * coordinates() + 1; }  ///< a, c, k of each, and tau
  double freedom() const { return measured() - touchParameters(); }
};

Eigen::MatrixXd regressors(const Series& series, double touch) {
  Eigen::MatrixXd rows(series.way.size(), 3);
  rows << Eigen::VectorXd::Ones(series.way.size()), series.way,
      (series.way.array() - touch).max(0).pow(series.exponent).matrix();
  return series.weight.asDiagonal() * rows;
}

Eigen::MatrixXd line(const Series& series) { return regressors(series, 0).leftCols(2); }

double squaresLeft(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& pixel) {
  return (pixel - rows * rows.colPivHouseholderQr().solve(pixel)).squaredNorm();
}

/// Touches (um) at which both segments have at least two samples of different height.
std::vector<double> touchesOf(const Series& series, int steps) {
  std::vector<double> touches;
  for (Eigen::Index i = 1; i + 2 < series.way.size(); ++i) {
    const double from = series.way[i], to = series.way[i + 1];
    for (int k = 0; k < steps; ++k) touches.push_back(from + (to - from) * k / steps);
  }
  return touches;
}

Series withoutOutliers(const Series& series) {
  double best = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best_distance = Eigen::VectorXd::Zero(series.way.size());
  for (const double touch : touchesOf(series, kRobustSteps)) {
    const Eigen::MatrixXd rows = regressors(series, touch);
    const Eigen::MatrixXd solution = leastDistances(rows, series.pixel, kRobustIterations);
    if (solution.size() == 0) continue;
    const Eigen::VectorXd distance = (series.pixel - rows * solution).rowwise().norm();
    if (distance.sum() >= best) continue;
    best = distance.sum();
    best_distance = distance;
  }
  const double median = medianOf({best_distance.data(), best_distance.data() + best_distance.size()});
  const double deviation = median / (series.coordinates() == 1 ? kNormalMedian : kRayleighMedian);
  const double limit = kOutlierDeviations * deviation * std::sqrt(series.measured() / series.freedom());
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < series.way.size(); ++i) {
    if (best_distance[i] <= limit) kept.push_back(i);
  }
  Series good{Eigen::VectorXd(kept.size()), Eigen::MatrixXd(kept.size(), series.pixel.cols()),
              Eigen::VectorXd(kept.size()), series.exponent};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    good.way[row] = series.way[kept[i]];
    good.pixel.row(row) = series.pixel.row(kept[i]);
    good.weight[row] = series.weight[kept[i]];
  }
  return good;
}

/// Sum of squares over the touch, its minimum and its 95 % interval (um).
struct Profile {
  double touch = 0;
  double squares = std::numeric_limits<double>::infinity();
  Interval interval;
};

Profile profileOf(const Series& series) {
  Profile profile;
  const std::vector<double> touches = touchesOf(series, kSteps);
  std::vector<double> squares;
  for (const double touch : touches) {
    squares.push_back(squaresLeft(regressors(series, touch), series.pixel));
    if (squares.back() >= profile.squares) continue;
    profile.squares = squares.back();
    profile.touch = touch;
  }
  const double limit = profile.squares * (1 + fisherLimit(kIntervalConfidence, 1, series.freedom()) / series.freedom());
  profile.interval = {profile.touch, profile.touch};
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (squares[i] > limit) continue;
    profile.interval.low = std::min(profile.interval.low, touches[i]);
    profile.interval.high = std::max(profile.interval.high, touches[i]);
  }
  // The true ends lie between two touches tried.
  const double step = series.way[series.way.size() - 1] / static_cast<double>(series.way.size() - 1) / kSteps;
  profile.interval.low -= 0.5 * step;
  profile.interval.high += 0.5 * step;
  return profile;
}

std::string refusalOf(const std::vector<TouchSample>& samples, const TouchByVisionConfig& config) {
  const std::size_t least = 2 * static_cast<std::size_t>(config.least_points);
  if (samples.size() < least) {
    return "samples = " + std::to_string(samples.size()) + ": must be at least " + std::to_string(least);
  }
  for (const TouchSample& each : samples) {
    if (!std::isfinite(each.height) || !each.pixel.allFinite()) return "a height or a pixel is not finite";
    if (!(each.deviation > 0) || !std::isfinite(each.deviation)) return "a deviation is not positive and finite";
  }
  const double direction = samples[1].height - samples[0].height;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if ((samples[i].height - samples[i - 1].height) * direction <= 0) {
      return "height " + std::to_string(i) + ": the heights must go in one direction";
    }
  }
  return "";
}

Series seriesOf(const std::vector<TouchSample>& samples, TouchCoordinates coordinates, double exponent) {
  const int columns = static_cast<int>(coordinates);
  Series series{Eigen::VectorXd(samples.size()), Eigen::MatrixXd(samples.size(), columns),
                Eigen::VectorXd(samples.size()), exponent};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    series.way[row] = 1e6 * std::abs(samples[i].height - samples[0].height);
    series.weight[row] = 1 / samples[i].deviation;
    series.pixel.row(row) = samples[i].pixel.head(columns).transpose() / samples[i].deviation;
  }
  return series;
}

/// Decides on a fit; `change` in px/um.
TouchVerdict verdictOf(const Series& series, const Profile& profile, double change, const TouchByVisionConfig& config,
                       std::string& why) {
  const Eigen::Index n = series.way.size();
  const double gained = squaresLeft(line(series), series.pixel) - profile.squares;
  const double more = series.touchParameters() - series.lineParameters();
  const double fisher =
      gained / more / std::max(profile.squares / series.freedom(), std::numeric_limits<double>::min());
  const double rate = config.false_rate / static_cast<double>(n);
  if (fisher <= fisherLimit(1 - rate, more, series.freedom())) {
    why = "no touch in this range: one line fits as well";
    return TouchVerdict::kNoTouch;
  }
  const double end_change = change * std::pow(series.way[n - 1] - profile.touch, config.exponent);
  std::ostringstream text;
  if (end_change < config.least_change) {
    text << "no touch in this range: the bend moves the last sample by " << end_change << " px, a touch by "
         << config.least_change << " px";
    why = text.str();
    return TouchVerdict::kNoTouch;
  }
  const auto before = (series.way.array() < profile.touch).count();
  if (before < config.least_points || n - before < config.least_points) {
    text << "the motion changes too close to an end: " << before << " samples before and " << n - before
         << " after it, " << config.least_points << " needed";
  } else if (1e-6 * profile.interval.half() > config.largest_interval) {
    text << "the height is vague: +- " << profile.interval.half() << " um, allowed " << 1e6 * config.largest_interval
         << " um";
  }
  why = text.str();
  return why.empty() ? TouchVerdict::kTouch : TouchVerdict::kUnsure;
}

}  // namespace

TouchByVisionConfig TouchByVisionConfig::read(ConfigReader& reader) {
  TouchByVisionConfig config;
  reader.integer("least_points", config.least_points, Range::closed(3, 1000));
  reader.number("least_change", config.least_change, Range::positive());
  reader.number("false_rate", config.false_rate, Range::open(0, 0.1));
  reader.number("exponent", config.exponent, Range::closed(1, 2));
  reader.number("largest_interval", config.largest_interval, Range::positive());
  return config;
}

TouchReport findTouch(const std::vector<TouchSample>& samples, const TouchByVisionConfig& config,
                      TouchCoordinates coordinates) {
  TouchReport report;
  report.text = refusalOf(samples, config);
  if (!report.text.empty()) return report;
  const Series series = withoutOutliers(seriesOf(samples, coordinates, config.exponent));
  if (series.way.size() < 2 * config.least_points) {
    report.text = "samples without outliers = " + std::to_string(series.way.size()) + ": must be at least " +
                  std::to_string(2 * config.least_points);
    return report;
  }
  const Profile profile = profileOf(series);
  const Eigen::MatrixXd solution = regressors(series, profile.touch).colPivHouseholderQr().solve(series.pixel);
  const double change = solution.row(2).norm();
  const double sign = samples[1].height > samples[0].height ? 1e-6 : -1e-6;
  report.height = samples[0].height + sign * profile.touch;
  const double one = samples[0].height + sign * profile.interval.low;
  const double other = samples[0].height + sign * profile.interval.high;
  report.interval = {std::min(one, other), std::max(one, other)};
  report.change = 1e6 * change;
  report.verdict = verdictOf(series, profile, change, config, report.text);
  if (report.verdict == TouchVerdict::kTouch) {
    std::ostringstream text;
    text << "touch at " << 1e6 * report.height << " um, 95 % interval [" << 1e6 * report.interval.low << ", "
         << 1e6 * report.interval.high << "] um";
    report.text = text.str();
  }
  return report;
}

}  // namespace microinjection
