#include "hardware/devices/sensapex/sensapex_protocol.h"

#include <algorithm>
#include <utility>

namespace microinjection {
namespace {

constexpr unsigned char kProtocolVersion = 0x10;
constexpr std::size_t kHeader = 16, kBlockHeader = 4;      // bytes
constexpr unsigned kIntegers = 6, kUnsigned = 5;           // types of data
constexpr std::size_t kMostBlocks = 4, kMostNumbers = 64;  // of messages that a manipulator sends
constexpr std::uint16_t kAllPcs = 0x2ff, kAllUnits = 0x1ff, kAllUnitsAndPcs = 0x3ff;
constexpr double kDatagram = 0.02;  // s; the bytes of one do not come further apart

void appendNumber(std::string& bytes, std::uint32_t value, int count) {
  for (int i = count - 1; i >= 0; --i) bytes += static_cast<char>((value >> (8 * i)) & 0xff);
}

std::uint32_t numberAt(const std::string& bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  return value;
}

}  // namespace

std::string sensapexBytes(const SensapexMessage& message) {
  std::string bytes{static_cast<char>(kProtocolVersion), '\0'};
  for (const std::uint16_t each : {message.receiver, message.sender, message.number}) appendNumber(bytes, each, 2);
  appendNumber(bytes, message.options, 4);
  appendNumber(bytes, message.type, 2);
  appendNumber(bytes, static_cast<std::uint32_t>(message.blocks.size()), 2);
  for (const auto& block : message.blocks) {
    appendNumber(bytes, kIntegers, 2);
    appendNumber(bytes, static_cast<std::uint32_t>(block.size()), 2);
    for (const std::int32_t each : block) appendNumber(bytes, static_cast<std::uint32_t>(each), 4);
  }
  return bytes;
}

/// Whether the bytes begin as a message of the device does.
SensapexParser::Fit SensapexParser::fit() const {
  if (static_cast<unsigned char>(bytes_[0]) != kProtocolVersion) return Fit::kNo;
  if (bytes_.size() >= 4) {
    const std::uint32_t to = numberAt(bytes_, 2, 2);
    if (to != SensapexMessage::kPc && to != kAllPcs && to != kAllUnits && to != kAllUnitsAndPcs) return Fit::kNo;
  }
  if (bytes_.size() >= 6 && numberAt(bytes_, 4, 2) != device_) return Fit::kNo;
  return bytes_.size() < kHeader ? Fit::kMaybe : Fit::kYes;
}

/// Bytes of the message, as far as its headers have come; 0: it is none.
std::optional<std::size_t> SensapexParser::size() const {
  const std::uint32_t blocks = numberAt(bytes_, 14, 2);
  if (blocks > kMostBlocks) return 0;
  std::size_t at = kHeader;
  for (std::uint32_t i = 0; i < blocks; ++i) {
    if (bytes_.size() < at + kBlockHeader) return std::nullopt;
    const std::uint32_t type = numberAt(bytes_, at, 2), count = numberAt(bytes_, at + 2, 2);
    if ((type != kIntegers && type != kUnsigned) || count > kMostNumbers) return 0;
    at += kBlockHeader + 4 * count;
  }
  return at;
}

std::vector<SensapexMessage> SensapexParser::feed(const std::string& bytes, double time) {
  const auto skip = [&](std::size_t count) {
    bytes_.erase(0, count);
    if (!std::exchange(skipping_, true)) ++malformed_;
  };
  if (!bytes_.empty() && time - last_ > kDatagram) skip(bytes_.size());
  if (!bytes.empty()) last_ = time;
  bytes_ += bytes;
  std::vector<SensapexMessage> messages;
  while (!bytes_.empty()) {
    const Fit fits = fit();
    if (fits == Fit::kMaybe) break;
    const std::optional<std::size_t> whole = fits == Fit::kYes ? size() : 0;
    if (!whole || (*whole > 0 && bytes_.size() < *whole)) break;
    if (*whole == 0) {
      skip(1);
      continue;
    }
    SensapexMessage message;
    message.receiver = static_cast<std::uint16_t>(numberAt(bytes_, 2, 2));
    message.sender = device_;
    message.number = static_cast<std::uint16_t>(numberAt(bytes_, 6, 2));
    message.options = numberAt(bytes_, 8, 4);
    message.type = static_cast<std::uint16_t>(numberAt(bytes_, 12, 2));
    for (std::size_t at = kHeader; at < *whole;) {
      std::vector<std::int32_t>& block = message.blocks.emplace_back(numberAt(bytes_, at + 2, 2));
      at += kBlockHeader;
      for (std::int32_t& each : block) {
        each = static_cast<std::int32_t>(numberAt(bytes_, at, 4));
        at += 4;
      }
    }
    bytes_.erase(0, *whole);
    skipping_ = false;
    messages.push_back(std::move(message));
  }
  return messages;
}

}  // namespace microinjection
