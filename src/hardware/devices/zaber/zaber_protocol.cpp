#include "hardware/devices/zaber/zaber_protocol.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <limits>
#include <numeric>

namespace microinjection {
namespace {

constexpr std::size_t kLongestMessage = 256;  // characters

std::string checksum(const std::string& text) {
  const int sum = std::accumulate(text.begin(), text.end(), 0, [](int total, char each) {
    return (total + static_cast<unsigned char>(each)) & 0xff;
  });
  char digits[8];
  std::snprintf(digits, sizeof(digits), "%02X", (0x100 - sum) & 0xff);
  return digits;
}

/// Removes "<word> " from the front of `text` and returns the word.
std::string popToken(std::string& text) {
  const std::size_t space = text.find(' ');
  std::string word = text.substr(0, space);
  text = space == std::string::npos ? "" : text.substr(space + 1);
  return word;
}

std::optional<int> number(const std::string& word, std::size_t digits) {
  const auto value = zaberWholeNumber(word);
  return value && *value >= 0 && word.size() <= digits ? std::make_optional(static_cast<int>(*value)) : std::nullopt;
}

bool isPrintable(const std::string& text) {
  for (const char each : text) {
    if (each < ' ' || each > '~') return false;
  }
  return true;
}

bool isFlag(const std::string& text) {
  if (text == "--") return true;
  return text.size() == 2 && std::isupper(text[0]) && (std::isupper(text[1]) || std::isdigit(text[1]));
}

}  // namespace

std::string zaberCommand(const ZaberAddress& to, const std::string& command, bool with_checksum,
                         std::optional<int> id) {
  const std::string text =
      std::to_string(to.device) + " " + std::to_string(to.axis) + " " + (id ? std::to_string(*id) + " " : "") + command;
  return "/" + text + (with_checksum ? ":" + checksum(text) : "") + "\n";
}

std::optional<std::int64_t> ZaberMessage::position() const { return zaberWholeNumber(data); }

std::optional<std::vector<std::string>> ZaberMessage::flags() const {
  std::string text = data;
  const std::string count = popToken(text);
  std::vector<std::string> up;
  while (!text.empty()) up.push_back(popToken(text));
  const bool all_flags =
      std::all_of(up.begin(), up.end(), [](const auto& each) { return isFlag(each) && each != "--"; });
  const auto announced = zaberWholeNumber(count);
  if (count.size() != 2 || announced != static_cast<std::int64_t>(up.size()) || !all_flags) return std::nullopt;
  return up;
}

std::optional<std::int64_t> zaberWholeNumber(const std::string& data) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(data.data(), data.data() + data.size(), value);
  constexpr std::int64_t kLargest = std::numeric_limits<std::int32_t>::max();
  if (error != std::errc() || end != data.data() + data.size() || value > kLargest || value < -kLargest) {
    return std::nullopt;
  }
  return value;
}

std::optional<bool> zaberMovesHaveSpeeds(const std::string& version) {
  const std::size_t point = version.find('.');
  if (point == std::string::npos) return std::nullopt;
  const std::optional<int> major = number(version.substr(0, point), 2), minor = number(version.substr(point + 1), 2);
  if (!major || !minor) return std::nullopt;
  return *major > 7 || (*major == 7 && *minor >= 25);
}

std::vector<ZaberMessage> ZaberParser::feed(const std::string& bytes) {
  std::vector<ZaberMessage> messages;
  for (const char each : bytes) {
    if (each == '@' || each == '#' || each == '!') {
      if (!line_.empty()) ++malformed_;  // incomplete message
      line_ = each;
    } else if (line_.empty()) {
      continue;
    } else if (each == '\n') {
      if (auto message = parse(line_)) {
        message->size = line_.size() + 1;
        messages.push_back(*message);
      } else {
        ++malformed_;
      }
      line_.clear();
    } else if (line_.size() < kLongestMessage) {
      line_ += each;
    } else {
      line_.clear();
      ++malformed_;
    }
  }
  return messages;
}

std::optional<ZaberMessage> ZaberParser::parse(std::string line) {
  if (line.back() != '\r') return std::nullopt;
  line.pop_back();
  ZaberMessage message;
  message.kind = line[0] == '@'   ? ZaberMessage::Kind::kReply
                 : line[0] == '#' ? ZaberMessage::Kind::kInfo
                                  : ZaberMessage::Kind::kAlert;
  line.erase(0, 1);
  if (!isPrintable(line)) return std::nullopt;
  const bool has_checksum = line.size() > 3 && line[line.size() - 3] == ':';
  if (has_checksum) {
    const std::string received = line.substr(line.size() - 2);
    line.erase(line.size() - 3);
    if (received != checksum(line)) return std::nullopt;
  } else if (checksum_) {
    ++unchecked_;
    return std::nullopt;
  }
  const std::optional<int> device = number(popToken(line), 2), axis = number(popToken(line), 1);
  if (!device || !axis) return std::nullopt;
  message.from = {*device, *axis};
  if (message.kind == ZaberMessage::Kind::kReply) {
    std::string verdict = popToken(line);
    message.number = number(verdict, 2);
    if (message.number) verdict = popToken(line);
    if (verdict != "OK" && verdict != "RJ") return std::nullopt;
    message.rejected = verdict == "RJ";
  }
  if (message.kind != ZaberMessage::Kind::kInfo) {
    const std::string motion = popToken(line);
    message.flag = popToken(line);
    if ((motion != "BUSY" && motion != "IDLE") || !isFlag(message.flag)) return std::nullopt;
    message.busy = motion == "BUSY";
  }
  message.data = line;
  if (message.kind == ZaberMessage::Kind::kReply && line.empty()) return std::nullopt;
  return message;
}

}  // namespace microinjection
