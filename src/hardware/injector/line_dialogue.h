#pragma once

#include <optional>
#include <regex>
#include <string>

#include "hardware/serial/line_splitter.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// Sends one line at a time to a device and receives its reply. After a late, wrong or unexpected
/// reply, nothing is sent until the line has been quiet for a while, so that a late reply is not
/// mistaken for the next one. If all replies look alike that is not enough: a duplicate reply would
/// be taken for that of the next line, and so on. Therefore the caller waits for quiet() between
/// two commands.
class LineDialogue {
 public:
  struct Framing {
    std::string reply_end = "\r";        ///< of the device's lines; with a line feed, a carriage return may precede it
    std::string send_end = "\r";         ///< of the sent lines
    bool echo = false;                   ///< the device may repeat the line, or send an empty one, before its reply
    double quiet = 0.1;                  ///< s without a byte until the line is synchronized again
    std::optional<std::regex> ignore{};  ///< lines that the device sends by itself; they are neither reply nor noise
  };
  enum class Result { kNone, kReply, kLate, kUnclear };

  LineDialogue(Wire& wire, const Framing& framing);

  /// Discards input and sends nothing until the line has been quiet from `time` (s) on.
  void resynchronize(double time);
  /// No reply is pending, and the line is synchronized.
  bool free() const { return in_step_ && !waiting_; }
  bool waiting() const { return waiting_; }
  /// No byte was received for a while, so no unexpected reply is on its way.
  bool quiet(double time) const {
    return time - last_received_ >= framing_.quiet && (!lines_.inMidLine() || time - last_byte_ >= framing_.quiet);
  }

  /// @pre free()
  void send(const std::string& line, double timeout, double time);
  /// Reads the received bytes. kReply: reply() is the reply to the sent line. kLate: no reply
  /// within the time-out. kUnclear: more than one reply, so that the right one is unknown.
  Result receive(double time);
  const std::string& reply() const { return reply_; }

  unsigned badLines() const { return bad_ + lines_.tooLong(); }  ///< too long or unexpected

 private:
  bool echoes(const std::string& line);
  bool ignores(const std::string& line) const;

  Wire& wire_;
  Framing framing_;
  LineSplitter lines_;
  std::string sent_, reply_;
  bool waiting_ = false, echoed_ = false;
  double deadline_ = 0;   ///< s, for the reply
  bool in_step_ = false;  ///< no late reply can arrive
  double last_received_ =
      -1e9;                  ///< s, when the last byte came that is not of an ignored line, or resynchronization began
  double last_byte_ = -1e9;  ///< s, of any line
  unsigned bad_ = 0;
};

}  // namespace microinjection
