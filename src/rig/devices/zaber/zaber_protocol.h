#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// Zaber's ASCII protocol: "/<device> <axis> <command>\n" is answered by "@<device> <axis> OK IDLE -- <data>\r\n".
/// Device and axis 0 mean all of them.
struct ZaberAddress {
  int device = 0, axis = 0;
  bool operator==(const ZaberAddress& other) const { return device == other.device && axis == other.axis; }
};

/// `checksum`: ":XX" is put at the end, the two's complement of the sum of the characters after the first. `number` (0
/// to 99) stands before the command, and in the answer before OK or RJ (message ID of Zaber's manual): a belated answer
/// shows.
std::string zaberCommand(const ZaberAddress& to, const std::string& command, bool checksum,
                         std::optional<int> number = std::nullopt);

struct ZaberMessage {
  enum class Kind { kReply, kInfo, kAlert };  ///< begin with @, # and !
  Kind kind = Kind::kReply;
  ZaberAddress from;
  std::optional<int> number;  ///< of the command that it answers, when that had one
  bool rejected = false;      ///< of a reply: RJ; data has the reason
  bool busy = false;          ///< of a reply or an alert
  std::string flag = "--";    ///< the warning of the highest priority; F.: fault, W.: warning, N.: note
  std::string data;
  std::size_t size = 0;  ///< characters on the line, with the first and the line's end

  /// The data as a position in microsteps: one whole number of less than 2^31 in size.
  std::optional<std::int64_t> position() const;
  /// The data of an answer to `warnings`: the flags that are up. Empty: it is no such answer.
  std::optional<std::vector<std::string>> flags() const;
};

constexpr char kZaberNoReference[] = "WR";  ///< the flag of an axis without reference position

/// One whole number of less than 2^31 in size and nothing else.
std::optional<std::int64_t> zaberWholeNumber(const std::string& data);

/// Whether firmware of this version (MAJOR.MINOR, as `get version` tells it) takes moves to a place with a speed of
/// their own: from 7.25 on. Empty: that is no version.
std::optional<bool> zaberMovesHaveSpeeds(const std::string& version);

/// Whether the device's flag is a fault: the device has stopped and needs attention.
inline bool isZaberFault(const std::string& flag) { return !flag.empty() && flag[0] == 'F'; }
/// Whether the flag, shown in a reply, may stand before WR: a reply shows only the most important one. Notes (N.) are
/// less important than WR.
inline bool mayHideZaberReference(const std::string& flag) {
  return flag != kZaberNoReference && flag != "--" && flag[0] != 'N';
}

/// Finds messages in a stream of bytes. What is none is passed over; it is in step again with the next message.
class ZaberParser {
 public:
  /// `checksum`: a message without one is none. One that has a checksum must have the right one in any case.
  explicit ZaberParser(bool checksum) : checksum_(checksum) {}

  std::vector<ZaberMessage> feed(const std::string& bytes);
  void clear() { line_.clear(); }  ///< a message that has begun
  int malformed() const { return malformed_; }
  int unchecked() const { return unchecked_; }  ///< of these, that had no checksum and would have needed one

 private:
  std::optional<ZaberMessage> parse(std::string line);

  bool checksum_;
  std::string line_;  // empty: outside a message
  int malformed_ = 0, unchecked_ = 0;
};

}  // namespace microinjection
