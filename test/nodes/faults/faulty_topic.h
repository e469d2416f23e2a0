#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nodes/haptic/omni_messages.h"
#include "virtual_session.h"

namespace microinjection {

/// What becomes of the stream of a device.
enum class DeviceFault {
  kSilent,
  kFrozen,        ///< repeats its last numbers, with fresh stamps
  kNotFinite,     ///< all numbers
  kJumps,         ///< all numbers, by an offset that stays
  kSecondSender,  ///< a stranger sends others
  kLate,          ///< by 0.5 s
  kLine,          ///< the line to the device is silent, for a rig
};

struct FaultyDevice {
  std::string device;
  DeviceFault fault;
};

inline std::string nameOf(const FaultyDevice& of) {
  static const char* const names[] = {"Silent", "Frozen", "NotFinite", "Jumps", "SecondSender", "Late", "SilentLine"};
  return of.device + names[static_cast<int>(of.fault)];
}
inline void PrintTo(const FaultyDevice& of, std::ostream* out) { *out << nameOf(of); }
inline std::string faultyName(const testing::TestParamInfo<FaultyDevice>& info) { return nameOf(info.param); }

inline auto& pointOf(geometry_msgs::PoseStamped& message) { return message.pose.position; }
inline auto& pointOf(geometry_msgs::TransformStamped& message) { return message.transform.translation; }
inline auto& pointOf(geometry_msgs::WrenchStamped& message) { return message.wrench.force; }
inline auto& pointOf(OmniState& message) { return message.pose.position; }

/// The numbers of a device in a message.
template <typename Message, typename Act>
void eachNumber(Message& message, const Act& act) {
  if constexpr (std::is_same_v<Message, sensor_msgs::Joy>) {
    for (float& axis : message.axes) act(axis);
  } else {
    auto& point = pointOf(message);
    for (double* number : {&point.x, &point.y, &point.z}) act(*number);
  }
}

/// A topic whose messages have a fault from strike() on.
template <typename Message>
class FaultyTopic {
 public:
  /// @pre the topic is there
  FaultyTopic(VirtualSession& session, const std::string& topic) {
    session.executive().network().alter(topic, [this](const Passage& passage) { return pass(passage); });
  }
  FaultyTopic(const FaultyTopic&) = delete;
  FaultyTopic& operator=(const FaultyTopic&) = delete;

  /// `offset`: of a leap, in the message's unit.
  void strike(DeviceFault fault, double offset) {
    fault_ = fault;
    offset_ = offset;
  }
  /// The newest message as it was sent; null: none yet.
  const Message* sent() const { return sent_.get(); }

 private:
  std::vector<Passage> pass(const Passage& passage) {
    const auto before = std::exchange(sent_, boost::static_pointer_cast<const Message>(passage.message));
    if (!fault_ || fault_ == DeviceFault::kLine) return {passage};
    if (!first_) first_ = before ? before : sent_;
    const auto message = boost::make_shared<Message>(*sent_);
    Passage changed{passage.sender, message, 0};
    std::vector<double> kept;
    eachNumber(const_cast<Message&>(*first_), [&](auto& number) { kept.push_back(number); });
    std::size_t next = 0;
    switch (*fault_) {
      case DeviceFault::kSilent:
        return {};
      case DeviceFault::kFrozen:
        eachNumber(*message,
                   [&](auto& number) { number = static_cast<std::decay_t<decltype(number)>>(kept.at(next++)); });
        break;
      case DeviceFault::kNotFinite:
        eachNumber(*message,
                   [](auto& number) { number = std::numeric_limits<std::decay_t<decltype(number)>>::quiet_NaN(); });
        break;
      case DeviceFault::kSecondSender:
        eachNumber(*message, [](auto& number) { number *= 0.8; });
        changed.sender = "/stranger";
        return {passage, changed};
      case DeviceFault::kLate:
        return {{passage.sender, passage.message, 0.5}};
      default:
        eachNumber(*message, [&](auto& number) { number += offset_; });
    }
    return {changed};
  }

  std::optional<DeviceFault> fault_;
  double offset_ = 0;
  boost::shared_ptr<const Message> sent_, first_;
};

}  // namespace microinjection
