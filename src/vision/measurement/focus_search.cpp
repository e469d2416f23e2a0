#include "vision/measurement/focus_search.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kAtPlane = 0.1e-6;  // m, from the plane
constexpr double kRounding = 1e-3;   // steps

std::string micrometres(double value) {
  std::ostringstream text;
  text.precision(4);
  text << 1e6 * value << " um";
  return text.str();
}

}  // namespace

FocusSearchConfig FocusSearchConfig::read(ConfigReader& reader) {
  FocusSearchConfig config;
  reader.number("step", config.step, Range{0, 20e-6, true, false});
  reader.integer("planes", config.planes, Range::closed(7, 1000));
  reader.number("reach", config.reach, Range{0, 1e-3, true, false});
  reader.number("take_up", config.take_up, Range::closed(0, 100e-6));
  reader.integer("images", config.images, Range::closed(1, 100));
  reader.number("settle_time", config.settle_time, Range::closed(0, 10));
  reader.number("image_time", config.image_time, Range::positive());
  reader.number("move_time", config.move_time, Range::positive());
  ConfigReader curve = reader.section("curve");
  config.focus = TipFocusConfig::read(curve);
  if (0.5 * (config.planes - 1) * config.step > config.reach) reader.error("reach", "must have room for all planes");
  return config;
}

FocusSearch::FocusSearch(const FocusSearchConfig& config, double start, double origin)
    : config_(config), origin_(origin) {
  if (!std::isfinite(start)) {
    failure_ = "the focus' position is not finite";
    return;
  }
  const double half = 0.5 * (config.planes - 1) * config.step;
  lowest_ = std::max(start - half, origin_ - config.reach);
  highest_ = std::min(start + half, origin_ + config.reach);
  addPlanes(lowest_, highest_);
}

std::size_t FocusSearch::planes() const {
  const auto planned = std::count_if(targets_.begin(), targets_.end(), [](const Target& each) { return each.observe; });
  return samples_.size() + static_cast<std::size_t>(planned);
}

/// Planes in rising order: the focus comes to each from below.
void FocusSearch::addPlanes(double low, double high) {
  const bool goes_on = !samples_.empty() && low > samples_.back().height;
  if (!goes_on) targets_.push_back({low - config_.take_up, false});
  const int count = static_cast<int>(std::floor((high - low) / config_.step + kRounding));
  for (int i = 0; i <= count; ++i) targets_.push_back({low + i * config_.step, true});
}

std::optional<double> FocusSearch::step(const Input& input) {
  if (done() || !failure_.empty()) return std::nullopt;
  if (!input.position || !std::isfinite(*input.position)) {
    failure_ = "the focus axis does not answer: its position is not known";
    return std::nullopt;
  }
  const double goal = targets_.front().height;
  const bool arrived = std::abs(*input.position - goal) < kAtPlane;
  switch (phase_) {
    case Phase::kCommand:
      since_ = input.now;
      phase_ = Phase::kMove;
      return goal;
    case Phase::kMove:
      if (arrived) {
        since_ = input.now;
        phase_ = Phase::kObserve;
        if (!targets_.front().observe) next(input);
      } else if (input.now - since_ > config_.move_time) {
        failure_ = "the focus axis does not answer: it is at " + micrometres(*input.position) + ", must have come to " +
                   micrometres(goal);
      }
      return std::nullopt;
    case Phase::kObserve:
      if (arrived) {
        observe(input);
      } else {
        failure_ = "the focus has left the plane at " + micrometres(goal) + " by itself";
      }
      return std::nullopt;
    case Phase::kDone:
      break;
  }
  return std::nullopt;
}

void FocusSearch::observe(const Input& input) {
  const auto& reading = input.reading;
  const bool fresh = reading && reading->stamp > since_ + config_.settle_time && reading->stamp <= input.now &&
                     (readings_.empty() || reading->stamp > readings_.back().stamp);
  if (fresh && !std::isfinite(reading->sharpness)) {
    failure_ = "the sharpness is not finite";
  } else if (fresh) {
    readings_.push_back(*reading);
  } else if (input.now - since_ > config_.image_time) {
    failure_ = "no fresh image at " + micrometres(targets_.front().height) +
               (input.image_problem.empty() ? ": the images are stale" : ": " + input.image_problem);
  }
  if (static_cast<int>(readings_.size()) >= config_.images) next(input);
}

void FocusSearch::next(const Input& input) {
  const Target target = targets_.front();
  if (!readings_.empty()) {
    double sum = 0;
    for (const Reading& reading : readings_) sum += reading.sharpness / static_cast<double>(readings_.size());
    samples_.push_back({target.height, sum});
    readings_.clear();
  }
  since_ = input.now;
  phase_ = Phase::kCommand;
  targets_.pop_front();
  if (!targets_.empty()) return;
  if (returning_) {
    phase_ = Phase::kDone;
  } else {
    evaluate();
  }
}

std::optional<double> FocusSearch::sharpest() const {
  if (failure_.empty() || report_.verdict != FocusVerdict::kUnsure || samples_.empty()) return std::nullopt;
  return std::max_element(samples_.begin(), samples_.end(),
                          [](const FocusSample& a, const FocusSample& b) { return a.sharpness < b.sharpness; })
      ->height;
}

void FocusSearch::evaluate() {
  report_ = findFocus(samples_, config_.focus);
  if (report_.verdict == FocusVerdict::kFocus) {
    returning_ = true;
    targets_ = {{report_.height - config_.take_up, false}, {report_.height, false}};
    return;
  }
  failure_ = report_.text;
  if (report_.verdict != FocusVerdict::kBorder) return;
  const double more = 0.5 * config_.planes * config_.step, slack = kRounding * config_.step;
  const double low = std::max(lowest_ - more, origin_ - config_.reach);
  const double high = std::min(highest_ + more, origin_ + config_.reach);
  if (report_.towards > 0 && high - highest_ > config_.step - slack) {
    addPlanes(highest_ + config_.step, high);
    highest_ = targets_.back().height;
  } else if (report_.towards < 0 && lowest_ - low > config_.step - slack) {
    const double count = std::floor((lowest_ - low) / config_.step + kRounding), top = lowest_ - config_.step;
    lowest_ -= count * config_.step;
    addPlanes(lowest_, top);
  } else {
    failure_ += "; " + micrometres(config_.reach) + " from the start is the farthest allowed";
    return;
  }
  failure_.clear();
}

}  // namespace microinjection
