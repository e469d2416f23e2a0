#include "rigs/mp285/mp285_protocol.h"

namespace microinjection {
namespace {

constexpr std::size_t kPositionBytes = 13, kStatusBytes = 33;  // with the carriage return
constexpr std::size_t kFlags = 0, kStepDiv = 24, kSpeed = 28;  // in the status (acq4, mp285.py)

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
  const std::uint32_t step_div = take(bytes, kStepDiv, 2), speed = take(bytes, kSpeed, 2);
  if (step_div == 0) return answer;
  answer.kind = Mp285Answer::Kind::kStatus;
  answer.status.microstep = 1e-6 / step_div;
  answer.status.fine = (speed & 0x8000) != 0;
  answer.status.speed = static_cast<int>(speed & 0x7fff);
  answer.status.absolute = (take(bytes, kFlags, 1) & 0x20) != 0;
  return answer;
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

std::string mp285ErrorName(int error) {
  switch (error) {
    case 0:
      return "a byte was overrun";
    case 1:
      return "frame error on the line";
    case 2:
      return "its buffer is full";
    case 4:
      return "bad command";
    case 8:
      return "the move was interrupted";
    default:
      return "error " + std::to_string(error);
  }
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
  if (bytes_[0] == '=') {
    answer.kind = Mp285Answer::Kind::kStopped;
    return answer;
  }
  int code = static_cast<unsigned char>(bytes_[0]);
  if (code >= '0' && code <= '8') code -= '0';  // Micro-Manager's form
  if (code != 0 && code != 1 && code != 2 && code != 4 && code != 8) return std::nullopt;
  answer.kind = Mp285Answer::Kind::kError;
  answer.error = code;
  return answer;
}

std::optional<Mp285Answer> Mp285Parser::feed(const std::string& bytes, bool silent) {
  bytes_ += bytes;
  std::optional<Mp285Answer> answer;
  const std::size_t whole = expected_ == Expected::kDone       ? 2
                            : expected_ == Expected::kPosition ? kPositionBytes
                                                               : kStatusBytes;
  if (expected_ == Expected::kDone) {
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
