#include "hardware/devices/mp285/mp285_protocol.h"

#include <cstdio>

namespace microinjection {
namespace {

constexpr std::size_t kPositionBytes = 13, kStatusBytes = 33;     // with the carriage return
constexpr std::size_t kStepDiv = 24, kStepMul = 26, kSpeed = 28;  // in the status (acq4, instrulink)
constexpr int kErrorBits = 0x0f;

void append(std::string& bytes, std::uint32_t number, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>((number >> (8 * i)) & 0xff);
}

std::uint32_t readNumber(const std::string& bytes, std::size_t at, int size) {
  std::uint32_t number = 0;
  for (int i = size; i-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

Mp285Reply readPosition(const std::string& bytes) {
  Mp285Reply reply;
  reply.kind = Mp285Reply::Kind::kPosition;
  for (int i = 0; i < 3; ++i) reply.position[i] = static_cast<std::int32_t>(readNumber(bytes, 4 * i, 4));
  return reply;
}

Mp285Reply readStatus(const std::string& bytes) {
  Mp285Reply reply;
  reply.kind = Mp285Reply::Kind::kStatus;
  reply.status.step_div = static_cast<int>(readNumber(bytes, kStepDiv, 2));
  reply.status.step_mul = static_cast<int>(readNumber(bytes, kStepMul, 2));
  const std::uint32_t speed = readNumber(bytes, kSpeed, 2);
  reply.status.fine = (speed & 0x8000) != 0;
  reply.status.speed = static_cast<int>(speed & 0x7fff);
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    char text[4];
    std::snprintf(text, sizeof(text), i == 0 ? "%02x" : " %02x", static_cast<unsigned char>(bytes[i]));
    reply.status.bytes += text;
  }
  return reply;
}

/// The error's bits; -1: the byte is no error. Micro-Manager's form is ASCII, '0' to '?'; acq4
/// reads the bits alone.
int errorBits(char byte) {
  const int value = static_cast<unsigned char>(byte);
  const bool bare = value <= kErrorBits && byte != '\r';
  return bare || (value >= '0' && value <= '0' + kErrorBits) ? value & kErrorBits : -1;
}

}  // namespace

std::string mp285Move(const Mp285Position& position) {
  std::string bytes = "m";
  for (const std::int32_t each : position) append(bytes, static_cast<std::uint32_t>(each), 4);
  return bytes + '\r';
}

std::string mp285SetVelocity(int speed, bool fine) {
  std::string bytes = "V";
  append(bytes, static_cast<std::uint32_t>(speed & 0x7fff) | (fine ? 0x8000u : 0u), 2);
  return bytes + '\r';
}

std::optional<double> mp285Microstep(int step_div, int step_mul) {
  const bool known = (step_div == 25 && step_mul == 4) || (step_div == 400 && step_mul == 400);
  return known ? std::optional<double>(0.04e-6) : std::nullopt;
}

std::string mp285ErrorName(int error) {
  if (error == 0) return "a byte was overrun";
  std::string names;
  const auto name = [&](int bit, const char* text) {
    if (error & bit) names += (names.empty() ? "" : ", ") + std::string(text);
  };
  name(1, "frame error on the line");
  name(2, "its buffer is full");
  name(4, "bad command");
  name(8, "the move was interrupted");
  return names;
}

void Mp285Parser::expect(Expected expected) {
  expected_ = expected;
  bytes_.clear();
}

/// A reply of one or two bytes: done, stopped or an error.
std::optional<Mp285Reply> Mp285Parser::shortReply() const {
  Mp285Reply reply;
  if (bytes_ == "\r") {
    reply.kind = Mp285Reply::Kind::kDone;
    return reply;
  }
  if (bytes_.size() != 2 || bytes_[1] != '\r') return std::nullopt;
  if (bytes_[0] == '=' && expected_ == Expected::kStop) {  // otherwise this byte is three errors at once
    reply.kind = Mp285Reply::Kind::kStopped;
    return reply;
  }
  reply.error = errorBits(bytes_[0]);
  if (reply.error < 0) return std::nullopt;
  reply.kind = Mp285Reply::Kind::kError;
  return reply;
}

std::optional<Mp285Reply> Mp285Parser::feed(const std::string& bytes, bool silent) {
  bytes_ += bytes;
  std::optional<Mp285Reply> reply;
  const bool is_short = expected_ == Expected::kDone || expected_ == Expected::kStop;
  const std::size_t whole = is_short ? 2 : expected_ == Expected::kPosition ? kPositionBytes : kStatusBytes;
  if (is_short) {
    reply = shortReply();
  } else if (bytes_.size() == whole && bytes_.back() == '\r') {
    reply = expected_ == Expected::kPosition ? readPosition(bytes_) : readStatus(bytes_);
  } else if (silent) {
    reply = shortReply();
    if (reply && reply->kind != Mp285Reply::Kind::kError) reply->kind = Mp285Reply::Kind::kMalformed;
  }
  if (!reply && (bytes_.size() >= whole || (silent && !bytes_.empty()))) reply = Mp285Reply();
  if (reply) bytes_.clear();
  return reply;
}

}  // namespace microinjection
