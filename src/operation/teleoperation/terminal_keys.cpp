#include "operation/teleoperation/terminal_keys.h"

#include <map>
#include <utility>

namespace microinjection {
namespace {

constexpr char kEscape = '\x1b';
constexpr std::size_t kLongest = 8;     // bytes; no sequence below is longer
constexpr double kSequenceTime = 0.05;  // s, time in which a terminal sends a whole sequence, also over a network
const char* const kOther = "other";

const std::map<std::string, std::string>& sequences() {
  static const std::map<std::string, std::string> all{
      {"[A", "up"},   {"[B", "down"},  {"[C", "right"}, {"[D", "left"},     {"OA", "up"},
      {"OB", "down"}, {"OC", "right"}, {"OD", "left"},  {"[5~", "page_up"}, {"[6~", "page_down"}};
  return all;
}

/// A sequence ends with a letter or a tilde; [ and O only introduce it.
bool ends(const std::string& sequence) {
  const char last = sequence.back();
  return sequence.size() > 1 && (last == '~' || (last >= 'A' && last <= 'Z') || (last >= 'a' && last <= 'z'));
}

}  // namespace

std::optional<std::string> TerminalKeys::feed(char byte) {
  waiting_time_ = 0;
  if (byte == kEscape) {
    const bool before = !std::exchange(pending_, kEscape).empty();
    return before ? std::optional<std::string>(kOther) : std::nullopt;
  }
  if (pending_.empty()) return byte < ' ' || byte > '~' ? kOther : std::string(1, byte);
  pending_ += byte;
  const std::string sequence = pending_.substr(1);
  if (sequence.size() == 1 && byte != '[' && byte != 'O') {  // escape alone, then a key
    pending_.clear();
    return feed(byte);
  }
  if (!ends(sequence) && sequence.size() < kLongest) return std::nullopt;
  pending_.clear();
  const auto found = sequences().find(sequence);
  return found == sequences().end() ? kOther : found->second;
}

std::optional<std::string> TerminalKeys::wait(double dt) {
  if (pending_.empty() || (waiting_time_ += dt) < kSequenceTime) return std::nullopt;
  pending_.clear();
  return kOther;
}

}  // namespace microinjection
