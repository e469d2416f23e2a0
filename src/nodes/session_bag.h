#pragma once

#include <ros/ros.h>
#include <rosbag/bag.h>

#include <string>
#include <vector>

#include "nodes/ports.h"

namespace microinjection {

/// The bag of a session, written by the recorder from the messages that it gets anyway: a second process that
/// subscribes to everything would cost half a core. The file has its name only when it is whole; until then it ends in
/// .active.
class SessionBag {
 public:
  /// Makes missing directories. @throws std::exception when the file cannot be written.
  explicit SessionBag(const std::string& path);
  ~SessionBag() { close(); }
  SessionBag(const SessionBag&) = delete;
  SessionBag& operator=(const SessionBag&) = delete;

  /// From now on writes every message that this input gets.
  template <typename Message>
  void follow(Input<Message>& input) {
    const std::string topic = "/" + input.topic;
    input.listen([this, topic](const Message& message, const ros::Time& now) { write(topic, now, message); });
  }

  /// From now on writes every message of a topic that is no input, in the thread that serves `node`.
  template <typename Message>
  void follow(ros::NodeHandle& node, const std::string& topic) {
    subscribers_.push_back(node.subscribe<Message>(
        topic, 100,
        [this, topic](const boost::shared_ptr<const Message>& message) { write(topic, ros::Time::now(), *message); }));
  }

  /// Completes the file; what comes later is not written.
  void close();

 private:
  template <typename Message>
  void write(const std::string& topic, const ros::Time& now, const Message& message) {
    if (!open_ || now <= ros::TIME_MIN) return;
    try {
      bag_.write(topic, now, message);
    } catch (const rosbag::BagException& error) {  // a full disk must not take the session with it
      ROS_ERROR_STREAM(path_ << ".active: " << error.what());
      open_ = false;
    }
  }

  std::string path_;
  rosbag::Bag bag_;
  bool open_ = true;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace microinjection
