#pragma once

#include <functional>
#include <string>

namespace microinjection {

/// Finds out what is at a port before a driver sends anything that another device could take for a command to move: an
/// MPC-200 takes the S of STOP, and of SCIENTIFICA, and the twelve bytes behind it for the end of a move.
///
/// It listens first. Then it asks a question that moves and sets nothing in any device that is known
/// (doc/reference/devices.md), a few times. A device that was known on this port before, and that nobody else answers
/// for, is taken for that device although it does not answer: it may be moving, and has to be stopped.
class PortProbe {
 public:
  struct Question {
    std::string request;  ///< bytes; empty: nothing is asked, the device is known at once
    std::function<bool(const std::string& answer)> is_answer;
    std::string device;     ///< as in nameOfAnswer(): "a Zaber"
    double patience = 0.1;  ///< s, for an answer; each time longer
  };
  enum class Verdict { kAsks, kKnown, kOther };

  void setQuestion(const Question& question) { question_ = question; }
  bool asks() const { return !question_.request.empty(); }

  /// A new line, or another try. `time` in s.
  void begin(double time);
  /// Adds what was received. `send` is called with what is to be sent.
  Verdict step(const std::string& bytes, double time, const std::function<void(const std::string&)>& send);
  const std::string& reason() const { return reason_; }  ///< of kOther

 private:
  Verdict judge();

  Question question_;
  std::string heard_, answer_;  ///< since begin(), since the last question
  double due_ = 0;              ///< s
  int asked_ = 0;
  bool known_before_ = false;
  std::string reason_;
};

}  // namespace microinjection
