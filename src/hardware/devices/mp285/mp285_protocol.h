#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace microinjection {

/// Protocol of Sutter's MP-285 and MP-285A: a letter, little-endian numbers, a carriage return;
/// replies also end with a carriage return. Sources: the clients of acq4, navigate and
/// Micro-Manager, instrulink's of the MP-285A, and the status of a real MP-285 as printed by a
/// MATLAB and Python client. Not verified on a device:
/// - which of STEP_DIV and STEP_MUL applies: clients disagree, so only pairs of known size are
///   accepted;
/// - the order of V's two bytes: low first here, as in most clients; Micro-Manager sends the high
///   one first;
/// - the errors in replies: ASCII '0' and bits in Micro-Manager, the bits alone in acq4; both are
///   read.
using Mp285Position = std::array<std::int32_t, 3>;  ///< microsteps

constexpr char kMp285Stop = '\x03';  ///< without a carriage return
inline std::string mp285RequestPosition() { return "c\r"; }
inline std::string mp285RequestStatus() { return "s\r"; }
inline std::string mp285AbsoluteMode() { return "a\r"; }
std::string mp285Move(const Mp285Position& position);  ///< the reply comes at the end of the move
/// `speed` in um/s, 1..32767; fine: 50 microsteps per step, otherwise 10.
std::string mp285SetVelocity(int speed, bool fine);

struct Mp285Status {
  int step_div = 0, step_mul = 0;  ///< as reported; known for some pairs only
  bool fine = false;               ///< resolution while moving
  int speed = 0;                   ///< um/s
  std::string bytes;               ///< all 32, hexadecimal, for messages
};

/// Size (m) of a microstep from STEP_DIV and STEP_MUL of the status. Known pairs are (25, 4), of an
/// MP-285, and (400, 400), of an MP-285A. Empty for any other pair: a formula that fits one of them
/// is wrong by a factor of 16 for the other.
std::optional<double> mp285Microstep(int step_div, int step_mul);

struct Mp285Reply {
  enum class Kind { kDone, kStopped, kPosition, kStatus, kError, kMalformed };
  Kind kind = Kind::kMalformed;
  Mp285Position position{};
  Mp285Status status;
  int error = 0;  ///< 0 overrun, or the sum of 1 frame, 2 buffer full, 4 bad command, 8 move interrupted
};

std::string mp285ErrorName(int error);  ///< names each bit

/// Assembles the reply to one command. The bytes have no delimiters, so the parser needs the kind
/// of the request. An error in place of a longer reply shows by the silence after it.
class Mp285Parser {
 public:
  enum class Expected { kDone, kStop, kPosition, kStatus };

  void expect(Expected expected);
  /// Adds received bytes. `silent`: the longest pause within a reply has passed. Empty: the reply
  /// is incomplete.
  std::optional<Mp285Reply> feed(const std::string& bytes, bool silent);
  bool begun() const { return !bytes_.empty(); }

 private:
  std::optional<Mp285Reply> shortReply() const;

  Expected expected_ = Expected::kDone;
  std::string bytes_;
};

}  // namespace microinjection
