#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace microinjection {

/// Sutter MP-285's protocol: a letter, little-endian numbers, a carriage return; answers end with a carriage return,
/// too.
using Mp285Position = std::array<std::int32_t, 3>;  ///< microsteps

constexpr char kMp285Stop = '\x03';  ///< alone, without a carriage return
inline std::string mp285AskPosition() { return "c\r"; }
inline std::string mp285AskStatus() { return "s\r"; }
inline std::string mp285AbsoluteMode() { return "a\r"; }
std::string mp285Move(const Mp285Position& place);  ///< answered when the move is over
/// `speed` in um/s, 1..32767; fine: 50 microsteps a step, otherwise 10.
std::string mp285SetVelocity(int speed, bool fine);

struct Mp285Status {
  double microstep = 0;  ///< m: 1 um / step_div
  bool fine = false;     ///< resolution under way
  int speed = 0;         ///< um/s
  bool absolute = true;  ///< moves are to a place, not by a distance
};

struct Mp285Answer {
  enum class Kind { kDone, kStopped, kPosition, kStatus, kError, kMalformed };
  Kind kind = Kind::kMalformed;
  Mp285Position position{};
  Mp285Status status;
  int error = 0;  ///< 0 overrun, 1 frame, 2 buffer full, 4 bad command, 8 move interrupted
};

std::string mp285ErrorName(int error);

/// Puts the answer to one command together. There are no marks in the bytes, so it must know what was asked, and an
/// error in place of a longer answer shows by the silence after it.
class Mp285Parser {
 public:
  enum class Expected { kDone, kPosition, kStatus };

  void expect(Expected expected);
  /// What has come; `silent`: nothing has followed for longer than there may be between two bytes. Empty: not all is
  /// there.
  std::optional<Mp285Answer> feed(const std::string& bytes, bool silent);
  bool begun() const { return !bytes_.empty(); }

 private:
  std::optional<Mp285Answer> shortAnswer() const;

  Expected expected_ = Expected::kDone;
  std::string bytes_;
};

}  // namespace microinjection
