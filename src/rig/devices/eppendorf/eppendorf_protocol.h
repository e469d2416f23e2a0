#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

namespace microinjection {

/// The PC interface of Eppendorf's PatchMan NP 2, as its manual prints it (appendix "PC interface", 2005; 19200 8N1, no
/// handshake): a command `Cnnn` with numbers behind it, ended by CR, LF or both; its answer `Annn` with numbers, ended
/// by CR. Numbers are separated by spaces or by their signs. Positions are in micrometres and speeds in micrometres a
/// second, of each motor: x to the right, y backwards, z downwards.
///
/// Not verified, since the manual's public pages or a device would have to tell it:
/// - that an InjectMan NI 2 (and a TransferMan NK 2) speaks alike;
/// - that positions are whole micrometres; decimals are read, whole ones are said;
/// - how errors look: the manual says only that there are messages, so anything but the answer is taken for one;
/// - which bit of a position's last number is which limit switch; 0 is none, as the manual says;
/// - whether a go-to while another is under way replaces it: none is ever said there.
std::string eppendorfRemote();    ///< C004: stops, locks joystick and keys; answered when all motors stand
std::string eppendorfManual();    ///< C005: stops, and gives them back
std::string eppendorfStop();      ///< C008: answered when all motors stand; only in remote control
std::string eppendorfPosition();  ///< C010: at any time, also while it moves
/// C012: answered when it has been understood, long before the place is reached. A speed of 0 is an axis that rests.
std::string eppendorfGoTo(const std::array<long, 3>& place, const std::array<int, 3>& speeds);

/// The answer to a command without numbers, e.g. "A004".
bool isEppendorfAnswer(const std::string& answer, const std::string& command);

struct EppendorfPosition {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< um, of the motors
  int limits = 0;                                   ///< switches that are reached
};
std::optional<EppendorfPosition> readEppendorfPosition(const std::string& answer);

}  // namespace microinjection
