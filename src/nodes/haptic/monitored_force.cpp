#include "nodes/haptic/monitored_force.h"

#include <geometry_msgs/WrenchStamped.h>

#include <utility>

#include "nodes/haptic/device_settings.h"
#include "nodes/haptic/geomagic_messages.h"
#include "nodes/haptic/omni_messages.h"
#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

template <typename Message>
Message zeroLike(const Message&, const ros::Time&) {
  return {};
}
geometry_msgs::WrenchStamped zeroLike(const geometry_msgs::WrenchStamped& last, const ros::Time& now) {
  return toWrench(Eigen::Vector3d::Zero(), now, last.header.frame_id);
}

template <typename Message>
class TopicForce : public MonitoredForce {
 public:
  TopicForce(const std::string& topic, Bus& bus, Handler handler)
      : bus_(bus),
        handler_(std::move(handler)),
        publisher_(bus.advertise<Message>(topic, 10)),
        subscription_(
            bus.subscribe<Message>(topic, 100, [this](const Delivery<Message>& delivery) { process(delivery); })) {}

  void publishZeroForce(const ros::Time& now) override { publisher_.publish(zeroLike(last_, now)); }

 private:
  void process(const Delivery<Message>& delivery) {
    if (delivery.raw.sender == bus_.name()) return;
    last_ = *delivery.message;
    handler_();
  }

  const Bus& bus_;
  Handler handler_;
  Message last_;
  Publisher<Message> publisher_;
  Subscription subscription_;
};

}  // namespace

std::unique_ptr<MonitoredForce> MonitoredForce::make(const std::string& kind, const std::string& device,
                                                     const std::string& force, Bus& bus, Handler handler) {
  const auto on = [&](auto message, const std::string& topic) -> std::unique_ptr<MonitoredForce> {
    return std::make_unique<TopicForce<decltype(message)>>(deviceTopic(device, topic), bus, std::move(handler));
  };
  if (kind == "crtk") return on(geometry_msgs::WrenchStamped(), force);
  if (kind == "omni") return on(OmniFeedback(), "force_feedback");
  return on(DeviceFeedback(), "force_feedback");
}

}  // namespace microinjection
