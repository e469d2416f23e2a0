#include "rig/devices/mp285/mp285_protocol.h"

#include <cstdio>

namespace microinjection {
namespace {

constexpr std::size_t kPositionBytes = 13, kStatusBytes = 33;     // with the carriage return
constexpr std::size_t kStepDiv = 24, kStepMul = 26, kSpeed = 28;  // in the status (acq4, instrulink)
constexpr int kErrorBits = 0x0f;

void append(std::string& bytes, std::uint32_t number, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>((number >> (8 * i)) & 0xff);
}

std::uint32_t take(const std::string& bytes, std::size_t at, int size) {
  std::uint32_t number = 0;
  for (int i = size; i-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

Mp285Answer readPosition(const std::string& bytes) {
  Mp285Answer answer;
  answer.kind = Mp285Answer::Kind::kPosition;
  for (int i = 0; i < 3; ++i) answer.position[i] = static_cast<std::int32_t>(take(bytes, 4 * i, 4));
  return answer;
}

Mp285Answer readStatus(const std::string& bytes) {
  Mp285Answer answer;
  answer.kind = Mp285Answer::Kind::kStatus;
  answer.status.step_div = static_cast<int>(take(bytes, kStepDiv, 2));
  answer.status.step_mul = static_cast<int>(take(bytes, kStepMul, 2));
  const std::uint32_t speed = take(bytes, kSpeed, 2);
  answer.status.fine = (speed & 0x8000) != 0;
  answer.status.speed = static_cast<int>(speed & 0x7fff);
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    char text[4];
    std::snprintf(text, sizeof(text), i == 0 ? "%02x" : " %02x", static_cast<unsigned char>(bytes[i]));
    answer.status.bytes += text;
  }
  return answer;
}

/// The error's bits; -1: the byte is none. Micro-Manager's form is ASCII, '0' to '?'; acq4 reads the bits alone.
int errorBits(char byte) {
  const int value = static_cast<unsigned char>(byte);
  const bool bare = value <= kErrorBits && byte != '\r';
  return bare || (value >= '0' && value <= '0' + kErrorBits) ? value & kErrorBits : -1;
}

}  // namespace

std::string mp285Move(const Mp285Position& place) {
  std::string bytes = "m";
  for (const std::int32_t each : place) append(bytes, static_cast<std::uint32_t>(each), 4);
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

/// Of one or two bytes: done, stopped or an error.
std::optional<Mp285Answer> Mp285Parser::shortAnswer() const {
  Mp285Answer answer;
  if (bytes_ == "\r") {
    answer.kind = Mp285Answer::Kind::kDone;
    return answer;
  }
  if (bytes_.size() != 2 || bytes_[1] != '\r') return std::nullopt;
  if (bytes_[0] == '=' && expected_ == Expected::kStop) {  // to anything else it is three errors at once
    answer.kind = Mp285Answer::Kind::kStopped;
    return answer;
  }
  answer.error = errorBits(bytes_[0]);
  if (answer.error < 0) return std::nullopt;
  answer.kind = Mp285Answer::Kind::kError;
  return answer;
}

std::optional<Mp285Answer> Mp285Parser::feed(const std::string& bytes, bool silent) {
  bytes_ += bytes;
  std::optional<Mp285Answer> answer;
  const bool is_short = expected_ == Expected::kDone || expected_ == Expected::kStop;
  const std::size_t whole = is_short ? 2 : expected_ == Expected::kPosition ? kPositionBytes : kStatusBytes;
  if (is_short) {
    answer = shortAnswer();
  } else if (bytes_.size() == whole && bytes_.back() == '\r') {
    answer = expected_ == Expected::kPosition ? readPosition(bytes_) : readStatus(bytes_);
  } else if (silent) {
    answer = shortAnswer();
    if (answer && answer->kind != Mp285Answer::Kind::kError) answer->kind = Mp285Answer::Kind::kMalformed;
  }
  if (!answer && (bytes_.size() >= whole || (silent && !bytes_.empty()))) answer = Mp285Answer();
  if (answer) bytes_.clear();
  return answer;
}

}  // namespace microinjection
