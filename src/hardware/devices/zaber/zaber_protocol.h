#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// Zaber's ASCII protocol: the reply to "/<device> <axis> <command>\n" is
/// "@<device> <axis> OK IDLE -- <data>\r\n". Device and axis 0 mean all of them.
struct ZaberAddress {
  int device = 0, axis = 0;
  bool operator==(const ZaberAddress& other) const { return device == other.device && axis == other.axis; }
};

/// `checksum`: appends ":XX", the two's complement of the sum of the characters after the first.
/// `number` (0 to 99) precedes the command, and OK or RJ in the reply (message ID in Zaber's
/// manual), which identifies late replies.
std::string zaberCommand(const ZaberAddress& to, const std::string& command, bool checksum,
                         std::optional<int> number = std::nullopt);

struct ZaberMessage {
  enum class Kind { kReply, kInfo, kAlert };  ///< begin with @, # and !
  Kind kind = Kind::kReply;
  ZaberAddress from;
  std::optional<int> number;  ///< of the answered command, if it had one
  bool rejected = false;      ///< of a reply: RJ, with the reason in data
  bool busy = false;          ///< of a reply or an alert
  std::string flag = "--";    ///< the warning of the highest priority; F.: fault, W.: warning, N.: note
  std::string data;
  std::size_t size = 0;  ///< characters on the line, including the first and the line's end

  /// The data as a position in microsteps: a whole number below 2^31 in size.
  std::optional<std::int64_t> position() const;
  /// The data of a reply to `warnings`: the active flags. Empty for other replies.
  std::optional<std::vector<std::string>> flags() const;
};

constexpr char kZaberNoReference[] = "WR";  ///< the flag of an axis without reference position

/// A whole number below 2^31 in size and nothing else.
std::optional<std::int64_t> zaberWholeNumber(const std::string& data);

/// Whether firmware of this version (MAJOR.MINOR, from `get version`) supports absolute moves with
/// their own speed: from 7.25 on. Empty for an invalid version.
std::optional<bool> zaberMovesHaveSpeeds(const std::string& version);

/// Whether the device's flag is a fault: the device has stopped and needs attention.
inline bool isZaberFault(const std::string& flag) { return !flag.empty() && flag[0] == 'F'; }
/// Whether the flag in a reply may precede WR, since a reply shows only the most important one.
/// Notes (N.) are less important than WR.
inline bool mayHideZaberReference(const std::string& flag) {
  return flag != kZaberNoReference && flag != "--" && flag[0] != 'N';
}

/// Extracts messages from a stream of bytes. Other bytes are skipped until the next message.
class ZaberParser {
 public:
  /// `checksum`: rejects messages without a checksum. A wrong checksum is always rejected.
  explicit ZaberParser(bool checksum) : checksum_(checksum) {}

  std::vector<ZaberMessage> feed(const std::string& bytes);
  void clear() { line_.clear(); }  ///< drops an incomplete message
  int malformed() const { return malformed_; }
  int unchecked() const { return unchecked_; }  ///< of these, without a required checksum

 private:
  std::optional<ZaberMessage> parse(std::string line);

  bool checksum_;
  std::string line_;  // empty: outside a message
  int malformed_ = 0, unchecked_ = 0;
};

}  // namespace microinjection
