#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

namespace microinjection {

/// The PC interface of Eppendorf's PatchMan NP 2, from its manual (appendix "PC interface", 2005;
/// 19200 8N1, no handshake), and of the TransferMan NK 2, from AutoInj_GUI, a public program that
/// drives one: a command `Cnnn` with numbers, ended by CR, LF or both; its reply
/// `Annn` with numbers, ended by CR. Numbers are separated by spaces or by their signs. Positions
/// are in um and speeds in um/s, of each motor: x to the right, y backwards, z downwards.
///
/// C006 and C009 are go-to and position in microsteps; the program has 25.6 a micrometre, and takes
/// motor 1 for -z and motor 3 for -x.
///
/// Not verified, since it needs the manual's other pages or a device:
/// - that an InjectMan NI 2 has the same protocol;
/// - that the position is told during a go-to in microsteps;
/// - that positions are whole micrometres; decimals are read, whole ones are sent;
/// - the form of errors: the manual mentions only that there are messages, so any other reply is an
///   error;
/// - which bit of a position's last number is which limit switch; 0 is none, as in the manual;
/// - whether a go-to replaces one in progress: none is sent then.
std::string eppendorfRemote();  ///< C004: stops, locks joystick and keys; the reply comes at rest
std::string eppendorfManual();  ///< C005: stops, and releases joystick and keys
std::string eppendorfStop();    ///< C008: the reply comes at rest; only in remote control
enum class EppendorfUnit { kMicrometre, kMicrostep };
/// C010 or C009: at any time, also while moving.
std::string eppendorfPosition(EppendorfUnit unit = EppendorfUnit::kMicrometre);
/// C012: the reply comes long before the position is reached. An axis with speed 0 rests.
std::string eppendorfGoTo(const std::array<long, 3>& position, const std::array<int, 3>& speeds);
/// C006, whose reply, "A006 n", comes when the position is reached: a request for the position
/// follows it in the same line, whose reply comes at once.
std::string eppendorfGoToMicrosteps(const std::array<long, 3>& position, const std::array<int, 3>& speeds);
/// Whether the bytes are that reply with its end, or may become it.
bool isEppendorfMoveEnd(const std::string& bytes);
bool mayBeEppendorfMoveEnd(const std::string& bytes);

/// Whether it is the reply to a command without numbers, e.g. "A004".
bool isEppendorfReply(const std::string& reply, const std::string& command);

struct EppendorfPosition {
  Eigen::Vector3d coordinates = Eigen::Vector3d::Zero();  ///< um or microsteps, of the motors
  int limits = 0;                                         ///< bits of the active limit switches
};
std::optional<EppendorfPosition> readEppendorfPosition(const std::string& reply,
                                                       EppendorfUnit unit = EppendorfUnit::kMicrometre);

}  // namespace microinjection
