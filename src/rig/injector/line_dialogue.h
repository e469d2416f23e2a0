#pragma once

#include <string>

#include "rig/serial/line_splitter.h"
#include "rig/serial/wire.h"

namespace microinjection {

/// One line at a time to a device, and the one that it answers. After a reply that was late, wrong or not asked for
/// nothing is sent before the line has been quiet for a while, so that a late reply is not taken for the next one.
/// Where replies look alike that is not enough: one that came twice would answer the next line, whose own reply the one
/// after it, and so on for ever. Between two commands whoever uses this waits until quiet().
class LineDialogue {
 public:
  struct Framing {
    std::string reply_end = "\r";  ///< of the device's lines; with a line feed alone, a carriage return before it too
    std::string send_end = "\r";   ///< of ours
    bool echo = false;             ///< before its reply the device may repeat the line, or send an empty one
    double quiet = 0.1;            ///< s without a byte until the line is in step again
  };
  enum class Answer { kNone, kReply, kLate, kUnclear };

  LineDialogue(Wire& wire, const Framing& framing);

  /// Nothing that comes is believed, and nothing can be sent, until the line has been quiet from `time` (s) on.
  void distrust(double time);
  /// No reply is owed, and the line is in step.
  bool free() const { return in_step_ && !waiting_; }
  bool waiting() const { return waiting_; }
  /// Nothing has come for a while, so that no reply is on its way that nobody waits for.
  bool quiet(double time) const { return time - heard_ >= framing_.quiet; }

  /// @pre free()
  void send(const std::string& line, double timeout, double time);
  /// Reads what has come. kReply: reply() is the answer to what was sent. kLate: there was none in time. kUnclear:
  /// there was more than one, so that nobody knows which it is.
  Answer receive(double time);
  const std::string& reply() const { return reply_; }

  unsigned badLines() const { return bad_ + lines_.tooLong(); }  ///< that were too long or not asked for

 private:
  bool echoes(const std::string& line);

  Wire& wire_;
  Framing framing_;
  LineSplitter lines_;
  std::string sent_, reply_;
  bool waiting_ = false, echoed_ = false;
  double deadline_ = 0;   ///< s, of the reply
  bool in_step_ = false;  ///< no reply is owed that could come late
  double heard_ = -1e9;   ///< s, when the last byte came, or the line was distrusted
  unsigned bad_ = 0;
};

}  // namespace microinjection
