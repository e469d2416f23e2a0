#pragma once

#include <ros/ros.h>
#include <rosbag/bag.h>

#include <cerrno>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "nodes/runtime/ports.h"

namespace microinjection {

/// The bag of a session, written by the recorder from the messages that it gets anyway: a second process that
/// subscribes to everything would cost half a core. The file has its name only when it is whole; until then it ends in
/// .active. Where it cannot be written, the bag ends there, and trouble() says why.
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
    input.onMessage([this, topic](const Message& message, const ros::Time& now) { write(topic, now, message); });
  }

  /// From now on writes every message of a topic that is no input, in the thread that serves `node`.
  template <typename Message>
  void follow(ros::NodeHandle& node, const std::string& topic) {
    subscribers_.push_back(node.subscribe<Message>(
        topic, 100,
        [this, topic](const boost::shared_ptr<const Message>& message) { write(topic, ros::Time::now(), *message); }));
  }

  /// Completes the file; what comes later is not written. Empty, or why the bag is not whole.
  std::string close();

  /// Why the bag is not whole, with its path; empty where nothing is wrong.
  const std::string& trouble() const { return trouble_; }

 private:
  template <typename Message>
  void write(const std::string& topic, const ros::Time& now, const Message& message) {
    if (!bag_ || now <= ros::TIME_MIN) return;
    errno = 0;
    try {
      bag_->write(topic, now, message);
    } catch (const std::exception& error) {  // a full disk must not take the session with it
      const int reason = errno;
      abort(error.what(), reason);
    }
  }
  void abort(const std::string& what, int reason);

  std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;  ///< null when it is closed
  std::string trouble_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace microinjection
