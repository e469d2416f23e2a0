#include "nodes/cell/piezo_train.h"

#include "base/errors.h"
#include "base/range.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kOldest = 0.5;  ///< s, of a message

void require(const Range& range, const char* field, double value) {
  if (!range.contains(value))
    throw ConfigError(std::string(field) + " = " + std::to_string(value) + ": must be " + range.text());
}

}  // namespace

PiezoTrain::PiezoTrain(Bus& bus)
    : bus_(bus), subscription_(subscribeGuarded(bus, "needle/piezo_pulses", 1, &PiezoTrain::receive, this)) {}

void PiezoTrain::receive(const cell_microinjection::PiezoPulses& message) {
  left_ = 0;
  if (message.number == 0) return;
  require(Range::closed(kShortestRise, kLongestRise), "rise_time", message.rise_time);
  require(Range::closed(0, kLargestAmplitude), "amplitude", message.amplitude);
  require(Range::closed(kSlowest, kFastest), "rate", message.rate);
  require(Range::closed(0, kMost), "number", message.number);
  const double age = message.header.stamp.isZero() ? 0 : secondsBetween(message.header.stamp, bus_.now());
  require(Range::closed(-kOldest, kOldest), "age of its stamp", age);
  pulse_ = {message.amplitude, message.rise_time};
  period_ = 1 / message.rate;
  left_ = message.number;
  next_ = bus_.now();
}

std::optional<PiezoPulse> PiezoTrain::due(const ros::Time& now) {
  if (left_ == 0 || now < next_) return std::nullopt;
  --left_;
  next_ = now + ros::Duration(period_);
  return pulse_;
}

}  // namespace microinjection
