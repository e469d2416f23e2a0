#include "vision/measurement/touch_search.h"

#include <cmath>
#include <sstream>

#include "vision/calibration/statistics.h"

namespace microinjection {
namespace {

constexpr double kLongest = 0.05;         // s, that the set-point advances in a step: a stall must not become a jump
constexpr double kAtSetpoint = 0.1e-6;    // m, of the needle from its set-point
constexpr double kAside = 1e-6;           // m, across the approach: the needle left its line
constexpr double kLeastDeviation = 0.05;  // px: no image is better
constexpr std::size_t kLeastGaps = 5;     // that tell where the tip meets the outline
constexpr double kStray = 3;              // px, of an uncertain tip from its place by the travel
constexpr int kLeastForces = 20;          // readings of a rest
constexpr char kMoreForces[] = "more readings of the force at rest";
constexpr int kRobustIterations = 15;
constexpr std::size_t kNewest = 40;  // samples of the fit: older ones cost time and add little

}  // namespace

TouchSearchConfig TouchSearchConfig::read(ConfigReader& reader) {
  TouchSearchConfig config;
  reader.number("step", config.step, Range{0, 5e-6, true, false});
  reader.number("speed", config.speed, Range{0, 100e-6, true, false});
  reader.number("largest_travel", config.largest_travel, Range{0, 500e-6, true, false});
  reader.number("largest_force", config.largest_force, Range::positive());
  reader.number("largest_depth", config.largest_depth, Range::positive());
  reader.number("largest_offset", config.largest_offset, Range::positive());
  reader.number("settle_time", config.settle_time, Range::closed(0, 10));
  reader.number("image_time", config.image_time, Range::positive());
  reader.number("move_time", config.move_time, Range::positive());
  ConfigReader curve = reader.section("curve");
  config.touch = TouchByVisionConfig::read(curve);
  return config;
}

TouchSearch::TouchSearch(const TouchSearchConfig& config, const Eigen::Vector3d& start,
                         const Eigen::Vector3d& direction, const Input& input)
    : config_(config),
      start_(start),
      stream_(start, kAtSetpoint, input.now),
      direction_(direction),
      force_at_start_(input.force),
      stepped_(input.now),
      since_(input.now) {
  if (!start.allFinite() || !direction.allFinite()) failure_ = "the needle's pose is not finite";
}

std::optional<Eigen::Vector3d> TouchSearch::step(const Input& input) {
  if (done() || !failure_.empty()) return std::nullopt;
  const double duration = std::clamp(input.now - stepped_, 0.0, kLongest);
  stepped_ = input.now;
  watch(input);
  if (!failure_.empty()) return std::nullopt;
  travel_ = std::min(goal_, travel_ + config_.speed * duration);
  waits_for_.clear();
  const Eigen::Vector3d setpoint = stream_.advance(start_ + travel_ * direction_, config_.speed * duration);
  const bool arrived = stream_.arrived(*input.position, input.now);
  if (travel_ < goal_) return setpoint;
  averageForce(input, arrived);
  const double elapsed = input.now - since_;
  if (!arrived) {
    waits_for_ = "the needle does not follow";
    if (elapsed > config_.move_time + config_.step / config_.speed) failure_ = waits_for_;
  } else if (!look(input)) {
    if (elapsed > config_.move_time + config_.image_time) failure_ = noStep() + waits_for_;
  }
  return failure_.empty() && !done() ? std::optional(setpoint) : std::nullopt;
}

/// Each reading counts once, and only when it was taken at this rest.
void TouchSearch::averageForce(const Input& input, bool arrived) {
  if (!arrived) rest_ = {};
  if (!arrived || !force_at_start_ || input.force_stamp <= std::max(force_stamp_, restedSince(input))) return;
  rest_.add(*input.force);
  force_stamp_ = input.force_stamp;
}

/// Takes the newest image if it counts; else sets what it waits for.
bool TouchSearch::look(const Input& input) {
  const double rested = restedSince(input) + config_.settle_time;
  if (!input.observation || input.observation->stamp <= rested || input.observation->stamp > input.now) {
    waits_for_ = input.image_problem.empty() ? "a fresh image" : input.image_problem;
  } else if (!input.observation->certain && !gapLine()) {
    waits_for_ = "a certain cell and tip";
  } else if (force_at_start_ && rest_.count < kLeastForces) {
    waits_for_ = kMoreForces;
  } else {
    take(*input.observation, input.now);
    return true;
  }
  return false;
}

/// The gap of an image, if its tip is certain or where the travel has it.
double TouchSearch::trustedGap(const Observation& observation) const {
  const std::optional<Eigen::Vector2d> line = observation.certain ? std::nullopt : gapLine();
  const bool stray = line && std::abs(line->x() + 1e6 * travel_ * line->y() - observation.gap) > kStray;
  return stray ? std::nan("") : observation.gap;
}

/// Begins the sentence that names what a step has waited for in vain.
std::string TouchSearch::noStep() const {
  return waits_for_ == kMoreForces ? "the needle does not go on without " : "no fresh image of cell and tip: ";
}

/// What must hold at all times.
void TouchSearch::watch(const Input& input) {
  if (!input.position || !input.position->allFinite()) {
    failure_ = "the needle's position is not known";
    return;
  }
  const Eigen::Vector3d away = *input.position - start_;
  if ((away - away.dot(direction_) * direction_).norm() > kAside)
    failure_ = "the needle has left the line of the approach";
  if (!force_at_start_) return;
  if (!input.force || !std::isfinite(*input.force)) {
    failure_ = "the force is not known any more";
    return;
  }
  force_ = *input.force - *force_at_start_;
  if (*force_ <= config_.largest_force) return;
  std::ostringstream text;
  text << "the force is " << 1e6 * *force_ << " uN, allowed " << 1e6 * config_.largest_force << " uN";
  failure_ = text.str();
}

void TouchSearch::take(const Observation& observation, double now) {
  if (!std::isfinite(observation.displacement) || !std::isfinite(observation.deviation) ||
      !std::isfinite(observation.gap)) {
    failure_ = "what the image shows is not finite";
    return;
  }
  if (samples_.empty() && observation.gap <= 0) {
    failure_ = "the tip is at the cell's outline already: begin above it";
    return;
  }
  if (force_at_start_) {
    if (samples_.empty()) force_at_start_ = rest_.value();
    resting_force_ = rest_.value() - *force_at_start_;
    rest_ = {};
  }
  const double gap = trustedGap(observation);
  displacement_ = observation.displacement;
  samples_.push_back({travel_, {observation.displacement, 0}, std::max(observation.deviation, kLeastDeviation)});
  gaps_.push_back(gap);
  const std::size_t newest = std::min(samples_.size(), kNewest);
  report_ = findTouch({samples_.end() - static_cast<std::ptrdiff_t>(newest), samples_.end()}, config_.touch,
                      TouchCoordinates::kOne);
  compareWithOutline();
  if (done() || !failure_.empty()) return;
  goal_ = travel_ + config_.step;
  since_ = now;
  if (goal_ > config_.largest_travel) fail("no touch within ", config_.largest_travel, " um: " + report_.text);
}

void TouchSearch::compareWithOutline() {
  const std::optional<double> outline = outlineTravel();
  if (!outline) return;
  const double past = travel_ - *outline;
  if (report_.verdict == TouchVerdict::kTouch) {
    const double offset = report_.height - *outline;
    if (std::abs(offset) > config_.largest_offset)
      fail("the outline gives way ", offset, " um after the tip has met it in the image: this is another contact");
  } else if (past > config_.largest_depth) {
    fail("the tip is ", past, " um past the outline, which does not give way: it may be before or behind the cell");
  }
}

std::optional<double> TouchSearch::outlineTravel() const {
  const std::optional<Eigen::Vector2d> line = gapLine();
  if (!line || !(line->y() < 0)) return std::nullopt;  // the tip does not come nearer: noise
  return -1e-6 * line->x() / line->y();
}

/// The gap as a line over the travel: px, px/um.
std::optional<Eigen::Vector2d> TouchSearch::gapLine() const {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < gaps_.size(); ++i) {
    if (std::isfinite(gaps_[i])) points.emplace_back(1e6 * samples_[i].height, gaps_[i]);
  }
  if (points.size() < kLeastGaps) return std::nullopt;
  Eigen::MatrixXd rows(points.size(), 2);
  Eigen::VectorXd gaps(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) << 1, points[i].x();
    gaps[static_cast<Eigen::Index>(i)] = points[i].y();
  }
  const Eigen::MatrixXd line = leastDistances(rows, gaps, kRobustIterations);
  if (line.size() == 0) return std::nullopt;
  return Eigen::Vector2d(line(0, 0), line(1, 0));
}

/// `value`: m, given in um.
void TouchSearch::fail(const std::string& text, double value, const std::string& rest) {
  std::ostringstream whole;
  whole << text << 1e6 * value << rest;
  failure_ = whole.str();
}

}  // namespace microinjection
