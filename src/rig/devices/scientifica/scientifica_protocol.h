#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

namespace microinjection {

/// The motion cards of Scientifica's PatchStar and its like: words and numbers ended by CR; answers, ended by CR, are
/// "A" (done), "E" or "E,n" (refused), or values. Sources: the clients of acq4 (driver and its notes on the card's
/// command list), ScanImage (both of its Scientifica classes), Micro-Manager, and a PatchStar class of a patch clamp
/// program. Cards of version 2 (9600 bit/s) count a tenth of a micrometre, those of version 3 (38400) a hundredth.
///
/// Not verified on a device:
/// - in which line two or three axes move together: a straight one is assumed, with TOP as the speed along it;
/// - the smallest TOP of a version 3 card (1 um/s is assumed), and the units of its ACC (um/s^2, after acq4);
/// - what the numbers of errors mean, and what an empty line is answered: nothing is assumed;
/// - what an ABS does while it moves: acq4 notes that it is not answered, so none is ever said there.

/// A count of a version's positions (m).
double scientificaCount(int version);
/// What a card scales motor steps with when a count is that: UUX of a version 2 card, USTEP of a version 3 one; of a
/// device whose steps are a PatchStar's (1/64 um). Its sign is a direction and does not matter here.
double scientificaScale(int version);

/// The number after the words of a reply, such as "3.12"; empty where there is none.
std::optional<double> readScientificaNumber(const std::string& answer);
/// Counts, separated by tabs.
std::optional<Eigen::Vector3d> readScientificaPosition(const std::string& answer);
/// "S": 0 is at rest, 1 to 7 are kinds of motion. Whether it moves.
std::optional<bool> readScientificaMotion(const std::string& answer);

std::string scientificaGoTo(const std::array<long, 3>& place);
/// The line that tells an axis' scale (0: X).
std::string scientificaAskScale(int version, int axis);

/// TOP for a speed (m/s), and back; version 2: um/s * 2 * 6.4, from 1000 to 50000; version 3: um/s.
int scientificaTop(int version, double speed);
double scientificaSpeed(int version, int top);
double scientificaSlowest(int version);  ///< m/s
/// ACC for an acceleration (m/s^2); version 2: um/s^2 * 6.4 / 250, from 10 to 1000; version 3: um/s^2.
int scientificaAcceleration(int version, double acceleration);

}  // namespace microinjection
