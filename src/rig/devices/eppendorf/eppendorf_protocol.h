#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

namespace microinjection {

/// The PC interface of Eppendorf's PatchMan NP 2, from its manual (appendix "PC interface", 2005;
/// 19200 8N1, no handshake): a command `Cnnn` with numbers, ended by CR, LF or both; its reply
/// `Annn` with numbers, ended by CR. Numbers are separated by spaces or by their signs. Positions
/// are in um and speeds in um/s, of each motor: x to the right, y backwards, z downwards.
///
/// Not verified, since it needs the manual's other pages or a device:
/// - that an InjectMan NI 2 (and a TransferMan NK 2) has the same protocol;
/// - that positions are whole micrometres; decimals are read, whole ones are sent;
/// - the form of errors: the manual mentions only that there are messages, so any other reply is an
///   error;
/// - which bit of a position's last number is which limit switch; 0 is none, as in the manual;
/// - whether a go-to replaces one in progress: none is sent then.
std::string eppendorfRemote();    ///< C004: stops, locks joystick and keys; the reply comes at rest
std::string eppendorfManual();    ///< C005: stops, and releases joystick and keys
std::string eppendorfStop();      ///< C008: the reply comes at rest; only in remote control
std::string eppendorfPosition();  ///< C010: at any time, also while moving
/// C012: the reply comes long before the position is reached. An axis with speed 0 rests.
std::string eppendorfGoTo(const std::array<long, 3>& position, const std::array<int, 3>& speeds);

/// Whether it is the reply to a command without numbers, e.g. "A004".
bool isEppendorfReply(const std::string& reply, const std::string& command);

struct EppendorfPosition {
  Eigen::Vector3d coordinates = Eigen::Vector3d::Zero();  ///< um, of the motors
  int limits = 0;                                         ///< bits of the active limit switches
};
std::optional<EppendorfPosition> readEppendorfPosition(const std::string& reply);

}  // namespace microinjection
