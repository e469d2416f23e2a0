#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell_microinjection/StringStamped.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// All messages of a topic that a test has heard.
template <typename Message>
class Probe {
 public:
  explicit Probe(Bus& bus, const std::string& topic) {
    subscription_ = bus.subscribe<Message>(topic, 0, [this](const Delivery<Message>& delivery) {
      all_.push_back(delivery.message);
      arrivals_.push_back(delivery.raw.received);
      senders_.push_back(delivery.raw.sender);
    });
  }
  Probe(const Probe&) = delete;

  const Message* newest() const { return all_.empty() ? nullptr : all_.back().get(); }
  const std::vector<boost::shared_ptr<const Message>>& all() const { return all_; }
  const std::vector<ros::Time>& arrivals() const { return arrivals_; }
  const std::vector<std::string>& senders() const { return senders_; }
  std::size_t count() const { return all_.size(); }
  std::size_t publishers() const { return subscription_.publishers(); }
  void clear() {
    all_.clear();
    arrivals_.clear();
    senders_.clear();
  }

 private:
  std::vector<boost::shared_ptr<const Message>> all_;
  std::vector<ros::Time> arrivals_;
  std::vector<std::string> senders_;
  Subscription subscription_;
};

/// A node of the test's own: it hears topics, and says once, or in each step, what it is told to. It has a step
/// each `period` (s) before all nodes that its messages drive.
class TestNode {
 public:
  explicit TestNode(Bus& bus, double period = 1e-3) : bus_(bus) {
    bus.setStep(period, [this](const ros::Time&) {
      for (const auto& [topic, say] : repeated_) say();
    });
  }

  Bus& bus() { return bus_; }

  /// The topic's probe, which hears from the first call on.
  template <typename Message>
  Probe<Message>& hear(const std::string& topic) {
    std::shared_ptr<void>& probe = probes_[topic];
    if (!probe) probe = std::make_shared<Probe<Message>>(bus_, topic);
    return *static_cast<Probe<Message>*>(probe.get());
  }

  /// With the stamp that it has.
  template <typename Message>
  void say(const std::string& topic, const Message& message, bool latch = false) {
    publisher<Message>(topic, latch).publish(message);
  }
  template <typename Message>
  void sayNow(const std::string& topic, Message message, bool latch = false) {
    message.header.stamp = bus_.now();
    say(topic, message, latch);
  }
  /// A command such as /controller/state_command.
  void command(const std::string& topic, const std::string& word) {
    cell_microinjection::StringStamped message;
    message.string = word;
    sayNow(topic, message);
  }

  /// From now on in each step what `make` gives, stamped with the step's time; nothing when it gives nothing.
  template <typename Message>
  void repeat(const std::string& topic, std::function<std::optional<Message>()> make) {
    publisher<Message>(topic, false);
    repeated_[topic] = [this, topic, make] {
      if (const auto message = make()) sayNow(topic, *message);
    };
  }
  template <typename Message>
  void repeat(const std::string& topic, const Message& message) {
    repeat<Message>(topic, [message]() -> std::optional<Message> { return message; });
  }
  /// From now on in each step a message with stamp 0, which withdraws the last one (CRTK).
  template <typename Message>
  void repeatInvalid(const std::string& topic, Message message = {}) {
    publisher<Message>(topic, false);
    message.header.stamp = ros::Time();
    repeated_[topic] = [this, topic, message] { say(topic, message); };
  }
  /// Repeats it no more.
  void silence(const std::string& topic) { repeated_.erase(topic); }
  /// Ends the publication, as of a node that is gone.
  void hangUp(const std::string& topic) {
    silence(topic);
    publishers_.erase(topic);
  }

  template <typename Message>
  Publisher<Message>& publisher(const std::string& topic, bool latch = false) {
    std::shared_ptr<void>& publisher = publishers_[topic];
    if (!publisher) publisher = std::make_shared<Publisher<Message>>(bus_.advertise<Message>(topic, 10, latch));
    return *static_cast<Publisher<Message>*>(publisher.get());
  }

 private:
  Bus& bus_;
  std::map<std::string, std::shared_ptr<void>> probes_, publishers_;
  std::map<std::string, std::function<void()>> repeated_;
};

inline geometry_msgs::PoseStamped poseMessage(double x, double y, double z, const std::string& frame = "world") {
  geometry_msgs::PoseStamped message;
  message.header.frame_id = frame;
  message.pose.position.x = x;
  message.pose.position.y = y;
  message.pose.position.z = z;
  message.pose.orientation.w = 1;
  return message;
}
inline geometry_msgs::WrenchStamped wrenchMessage(double x, double y, double z, const std::string& frame = "world") {
  geometry_msgs::WrenchStamped message;
  message.header.frame_id = frame;
  message.wrench.force.x = x;
  message.wrench.force.y = y;
  message.wrench.force.z = z;
  return message;
}
inline sensor_msgs::Joy joyMessage(const std::vector<int>& buttons) {
  sensor_msgs::Joy message;
  message.buttons.assign(buttons.begin(), buttons.end());
  return message;
}

}  // namespace microinjection
