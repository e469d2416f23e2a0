#pragma once

#include <ros/time.h>

#include <algorithm>
#include <string>
#include <utility>

#include "nodes/runtime/stamps.h"

namespace microinjection {

/// Who sends the messages of a topic that one node sends. Another sender while the first one still sends is a rival: a
/// foreign publisher, a second session, a node that was started twice. A node that takes over from one that has ended
/// is none.
class SoleSender {
 public:
  static constexpr double kHandOver = 0.5;  ///< s without the other one, at least, until a sender is the only one
  /// Of a topic that has changes only, s from a sender's first message, while both are there. Not for ever, since a
  /// node that was killed is there for ever. Of another one: s without the other one, at most.
  static constexpr double kHandOverOfChanges = 3;

  void receive(const std::string& sender, const ros::Time& now) {
    if (sender != last_.name) {
      std::swap(last_, other_);
      if (sender != last_.name) last_ = {sender, {}, 0};
      began_ = now;
    }
    if (!last_.sent.isZero()) last_.interval = secondsBetween(last_.sent, now);
    last_.sent = now;
  }
  bool hasOther() const { return !other_.name.empty(); }  ///< whether there was ever another one
  /// Receives. @returns why the message does not count; empty: it does
  std::string refusalOf(const std::string& sender, const ros::Time& now) {
    receive(sender, now);
    const std::string both = rivals(now);
    return both.empty() ? "" : "it is sent by two nodes, " + both + ": none counts until one has stopped";
  }

  /// Both names while two nodes send; else empty. `both_are_there`: of a topic that has changes only, whose other
  /// sender may be silent for long and then send the next one.
  std::string rivals(const ros::Time& now, bool both_are_there = false) const {
    if (!hasOther()) return "";
    // One of a slow camera's two senders is silent for as long as its images are apart. One that is silent for longer
    // is no stream.
    const bool stream = other_.interval <= kHandOverOfChanges;
    const double silence = stream ? std::clamp(2 * other_.interval, kHandOver, kHandOverOfChanges) : kHandOver;
    if (both_are_there ? isDue(began_, now, kHandOverOfChanges) : isDue(other_.sent, now, silence)) return "";
    return std::min(other_.name, last_.name) + " and " + std::max(other_.name, last_.name);
  }

 private:
  struct Sender {
    std::string name;
    ros::Time sent;       ///< its last message
    double interval = 0;  ///< s, between its last two messages; 0: not known
  };

  Sender last_, other_;  ///< of the last message, and the last one before it that is another
  ros::Time began_;      ///< of the last one, since the other one's last message
};

}  // namespace microinjection
