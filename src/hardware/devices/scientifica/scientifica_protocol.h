#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

namespace microinjection {

/// Protocol of the motion cards of Scientifica's PatchStar and similar devices: words and numbers
/// ended by CR; replies, ended by CR, are "A" (done), "E" or "E,n" (refused), or values. Sources:
/// the clients of acq4 (driver and its notes on the card's command list), ScanImage (both of its
/// Scientifica classes), Micro-Manager, and a PatchStar class of a patch clamp program. Cards of
/// version 2 (9600 bit/s) count in 0.1 um, those of version 3 (38400) in 0.01 um.
///
/// Not verified on a device:
/// - the path of a move of two or three axes: a straight line is assumed, with TOP as the speed
///   along it;
/// - the smallest TOP of a version 3 card (1 um/s is assumed), and the units of its ACC (um/s^2,
///   after acq4);
/// - whether TOP, FIRST and ACC are told as they were set, within 2 %;
/// - the meaning of error numbers, and the reply to an empty line: nothing is assumed;
/// - the effect of an ABS while moving: acq4 notes that it has no reply, so none is sent then.

/// Size (m) of a count of a version's positions.
double scientificaCount(int version);
/// Scale of motor steps at that count size: UUX of a version 2 card, USTEP of a version 3 one, for
/// a device with a PatchStar's steps (1/64 um). The sign is a direction and is ignored.
double scientificaScale(int version);

/// Reads a number such as "3.12"; empty for other replies.
std::optional<double> readScientificaNumber(const std::string& reply);
/// Reads counts separated by tabs.
std::optional<Eigen::Vector3d> readScientificaPosition(const std::string& reply);
/// Reads the reply to "S": 0 is at rest, 1 to 7 are kinds of motion. Returns whether it moves.
std::optional<bool> readScientificaMotion(const std::string& reply);

std::string scientificaGoTo(const std::array<long, 3>& position);
/// The request for an axis' scale (0: X).
std::string scientificaRequestScale(int version, int axis);

/// TOP for a speed (m/s), and the inverse; version 2: um/s * 2 * 6.4, from 1000 to 50000; version
/// 3: um/s.
int scientificaTop(int version, double speed);
double scientificaSpeed(int version, int top);
double scientificaSlowest(int version);  ///< m/s
/// ACC for an acceleration (m/s^2); version 2: um/s^2 * 6.4 / 250, from 10 to 1000; version 3:
/// um/s^2.
int scientificaAcceleration(int version, double acceleration);

}  // namespace microinjection
