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
    : bus_(bus),
      subscription_(subscribeGuarded(bus, "needle/piezo_pulses", 1, &PiezoTrain::receive, this, StampRule::kAny)) {}

void PiezoTrain::receive(const cell_microinjection::PiezoPulses& message) {
  left_ = 0;
  if (message.number == 0) return;
  require(Range::closed(kShortestRise, kLongestRise), "rise_time", message.rise_time);
  require(Range::closed(0, kLargestAmplitude), "amplitude", message.amplitude);
  require(Range::closed(kSlowest, kFastest), "rate", message.rate);
  require(Range::closed(0, kMost), "number", message.number);
  require(Range::closed(0, 0.5 / message.rise_time), "rate, of pulses that go ahead and come back,", message.rate);
  require(Range::closed(-kOldest, kOldest), "age of its stamp, s,", secondsBetween(message.header.stamp, bus_.now()));
  pulse_ = {message.amplitude, message.rise_time};
  period_ = 1 / message.rate;
  left_ = message.number;
  next_ = bus_.now();
}

std::optional<PiezoPulse> PiezoTrain::due(const ros::Time& now) {
  bool is_due = false;
  for (; left_ > 0 && next_ <= now; --left_, next_ += ros::Duration(period_)) is_due = true;
  return is_due ? std::optional(pulse_) : std::nullopt;
}

}  // namespace microinjection
