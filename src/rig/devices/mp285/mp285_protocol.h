#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace microinjection {

/// Sutter MP-285's and MP-285A's protocol: a letter, little-endian numbers, a carriage return; answers end with a
/// carriage return, too. Sources: the clients of acq4, navigate and Micro-Manager, instrulink's of the MP-285A, and the
/// status that a MATLAB and Python client prints of a real MP-285. Not verified on a device:
/// - which of STEP_DIV and STEP_MUL counts: clients disagree, so only pairs of known size are taken;
/// - the order of V's two bytes: low first here, as most clients have it; Micro-Manager's has the high one first;
/// - the answers' errors: ASCII '0' and bits in Micro-Manager, the bits alone in acq4; both are read.
using Mp285Position = std::array<std::int32_t, 3>;  ///< microsteps

constexpr char kMp285Stop = '\x03';  ///< alone, without a carriage return
inline std::string mp285AskPosition() { return "c\r"; }
inline std::string mp285AskStatus() { return "s\r"; }
inline std::string mp285AbsoluteMode() { return "a\r"; }
std::string mp285Move(const Mp285Position& place);  ///< answered when the move is over
/// `speed` in um/s, 1..32767; fine: 50 microsteps a step, otherwise 10.
std::string mp285SetVelocity(int speed, bool fine);

struct Mp285Status {
  int step_div = 0, step_mul = 0;  ///< as told; what they mean is known of some pairs only
  bool fine = false;               ///< resolution under way
  int speed = 0;                   ///< um/s
  std::string bytes;               ///< all 32, hexadecimal, for messages
};

/// Size (m) of a microstep by STEP_DIV and STEP_MUL of the status. Known are (25, 4), of an MP-285, and (400, 400), of
/// an MP-285A. Empty for any other pair: a formula that fits one of them is wrong by 16 for the other.
std::optional<double> mp285Microstep(int step_div, int step_mul);

struct Mp285Answer {
  enum class Kind { kDone, kStopped, kPosition, kStatus, kError, kMalformed };
  Kind kind = Kind::kMalformed;
  Mp285Position position{};
  Mp285Status status;
  int error = 0;  ///< 0 overrun, or the sum of 1 frame, 2 buffer full, 4 bad command, 8 move interrupted
};

std::string mp285ErrorName(int error);  ///< names each bit

/// Puts the answer to one command together. There are no marks in the bytes, so it must know what was asked, and an
/// error in place of a longer answer shows by the silence after it.
class Mp285Parser {
 public:
  enum class Expected { kDone, kStop, kPosition, kStatus };

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
