#include "operation/control/break_detector.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "operation/control/contact_detector.h"
#include "operation/control/force_noise.h"

namespace microinjection {
namespace {

constexpr double kBaseline = 0.02;       ///< weight of a sample in the baseline, which begins with a mean
constexpr double kLeastAllowance = 0.5;  ///< deviations
constexpr double kNominalFrame = 0.02;   ///< s between two images
constexpr int kRestImages = 5;           ///< of which the interface's place at rest is the mean
constexpr double kStays = 0.5;           ///< share of the advance or fall that is left after a break
constexpr double kSure = 3.3;            ///< deviations
constexpr double kPatience = 0.5;        ///< s, for an image that confirms the alarm of images

}  // namespace

BreakDetectionConfig BreakDetectionConfig::read(ConfigReader& reader) {
  BreakDetectionConfig config;
  reader.number("interface_noise", config.interface_noise, Range::positive());
  reader.number("interface_speed", config.interface_speed, Range::positive());
  reader.number("flow_noise", config.flow_noise, Range::nonNegative());
  reader.number("flow_change", config.flow_change, Range::positive());
  reader.number("false_rate", config.false_rate, Range::open(0, 0.01));
  reader.number("fall", config.fall, Range::open(0, 1));
  reader.number("settle", config.settle, Range::nonNegative());
  reader.number("confirm", config.confirm, Range::positive());
  return config;
}

RiseDetector::RiseDetector(double deviation, double change, double false_rate)
    : deviation_(deviation),
      allowance_(std::max(0.5 * change / deviation, kLeastAllowance)),
      limit_(pageLimit(allowance_, false_rate)) {}

bool RiseDetector::step(double value) {
  if (count_ > 0) sum_ = std::max(0.0, sum_ + (value - baseline_) / deviation_ - allowance_);
  baseline_ += std::max(1.0 / ++count_, kBaseline) * (value - baseline_);
  return sum_ > limit_;
}

FallDetector::FallDetector(double deviation, double share, double false_rate)
    : smallest_(normalQuantile(false_rate) * deviation * std::sqrt(2.0 / kMean)), share_(share) {}

double FallDetector::mean(int begin) const {
  return std::accumulate(recent_.begin() + begin, recent_.begin() + begin + kMean, 0.0) / kMean;
}

double FallDetector::before() const { return mean(0); }
double FallDetector::now() const { return mean(static_cast<int>(recent_.size()) - kMean); }

bool FallDetector::step(double force) {
  recent_.push_back(force);
  return recent_.full() && before() - now() > std::max(smallest_, share_ * before());
}

bool FallDetector::couldFall() const { return recent_.full() && now() > 2 * smallest_; }

BreakDetector::BreakDetector(const BreakDetectionConfig& config, double force_noise)
    : config_(config),
      force_noise_(force_noise),
      force_(force_noise, config.fall, config.false_rate),
      interface_(std::sqrt(2.0) * config.interface_noise / kNominalFrame, config.interface_speed, config.false_rate),
      flow_(config.flow_noise > 0 ? config.flow_noise : 1, config.flow_change, config.false_rate) {}

std::string BreakDetector::watch(const std::optional<double>& force, const std::optional<InterfaceReading>& interface,
                                 const std::optional<double>& flow, double dt) {
  std::string alarm;
  since_image_ += dt;
  if (flow && config_.flow_noise > 0 && flow_.step(*flow)) alarm = "flow";
  if (interface && interface->is_new) {
    const double advance = interface->position - last_.value_or(interface->position);
    if (rest_.count < kRestImages) rest_.add(interface->position);
    last_ = interface->position;
    // Images that come apart show more of the same speed, and no more noise.
    const double speed = advance / std::max(std::exchange(since_image_, 0.0), kNominalFrame);
    if (interface_.step(speed)) {
      alarm = "image";
      image_alarmed_ = true;
    }
  }
  if (force && force_.step(*force)) {
    alarm = "force";
    force_alarmed_ = true;
    before_ = force_.before();
    fallen_ = force_.now();
  }
  if (!alarm.empty() && last_) alarm_.add(*last_);
  return alarm;
}

bool BreakDetector::canTell() const { return force_.couldFall() || rest_.count > 0 || config_.flow_noise > 0; }

std::optional<BreakDetector::Verdict> BreakDetector::confirm(const std::optional<double>& force,
                                                             const std::optional<InterfaceReading>& interface,
                                                             double dt) {
  confirming_ += dt;
  // An alarm of the force comes before the image that shows the interface at its furthest.
  if (interface && interface->is_new) {
    last_ = interface->position;
    if (confirming_ <= config_.settle / 2)
      alarm_ = {std::max(alarm_.count > 0 ? alarm_.value() : -INFINITY, *last_), 1};
  }
  if (confirming_ <= config_.settle) return std::nullopt;
  if (force) force_after_.add(*force);
  if (interface && interface->is_new) interface_after_.add(interface->position);
  const double late = confirming_ - config_.settle - config_.confirm;
  if (late <= 0 || (image_alarmed_ && interface_after_.count == 0 && late < kPatience)) return std::nullopt;
  const auto verdict = [](bool broken) { return broken ? Verdict::kBroken : Verdict::kWhole; };
  if (interface_after_.count > 0 && rest_.count > 0 && alarm_.count > 0) {
    const double advance = alarm_.value() - rest_.value(), left = interface_after_.value() - rest_.value();
    const double unsure = config_.interface_noise * std::sqrt(1.0 / interface_after_.count + 1.0 / rest_.count);
    const bool tells = advance > 2 * kSure * unsure;  // else it has not moved far enough to be seen to spring back
    if (tells || image_alarmed_) return verdict(left > std::max(kStays * advance, kSure * unsure));
  }
  if (!force_alarmed_ || force_after_.count == 0) return Verdict::kUnknown;
  const double unsure = force_noise_ * std::sqrt(1.0 / force_after_.count + 1.0 / FallDetector::kMean);
  return verdict(before_ - force_after_.value() > std::max(kStays * (before_ - fallen_), kSure * unsure));
}

void BreakDetector::resume() { *this = BreakDetector(config_, force_noise_); }

}  // namespace microinjection
