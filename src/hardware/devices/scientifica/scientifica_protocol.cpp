#include "hardware/devices/scientifica/scientifica_protocol.h"

#include <algorithm>
#include <regex>

namespace microinjection {
namespace {

constexpr double kScale2 = 6.4;  // UUX of a PatchStar

}  // namespace

double scientificaCount(int version) { return version == 2 ? 0.1e-6 : 0.01e-6; }

double scientificaScale(int version) { return version == 2 ? kScale2 : 10240 / kScale2; }

std::optional<double> readScientificaNumber(const std::string& reply) {
  static const std::regex form(R"([ \t]*([+-]?\d{1,9}(\.\d{1,9})?)[ \t]*)");
  std::smatch found;
  if (!std::regex_match(reply, found, form)) return std::nullopt;
  return std::stod(found[1]);
}

std::optional<Eigen::Vector3d> readScientificaPosition(const std::string& reply) {
  static const std::regex form(R"(([+-]?\d{1,9})\t([+-]?\d{1,9})\t([+-]?\d{1,9})\t?)");
  std::smatch found;
  if (!std::regex_match(reply, found, form)) return std::nullopt;
  return Eigen::Vector3d(std::stod(found[1]), std::stod(found[2]), std::stod(found[3]));
}

std::optional<bool> readScientificaMotion(const std::string& reply) {
  if (reply.size() != 1 || reply[0] < '0' || reply[0] > '7') return std::nullopt;
  return reply[0] != '0';
}

std::string scientificaGoTo(const std::array<long, 3>& position) {
  std::string line = "ABS";
  for (const long each : position) line += " " + std::to_string(each);
  return line;
}

std::string scientificaRequestScale(int version, int axis) {
  const std::string letter(1, "XYZ"[axis]);
  return version == 2 ? "UU" + letter : "USTEP " + letter;
}

int scientificaTop(int version, double speed) {
  const double um_per_s = speed * 1e6 + 1e-6;
  if (version == 2) return static_cast<int>(std::clamp(um_per_s * 2 * kScale2, 1000.0, 50000.0));
  return static_cast<int>(std::clamp(um_per_s, 1.0, 50000.0));
}

double scientificaSpeed(int version, int top) { return top * 1e-6 / (version == 2 ? 2 * kScale2 : 1); }

double scientificaSlowest(int version) { return scientificaSpeed(version, version == 2 ? 1000 : 1); }

int scientificaAcceleration(int version, double acceleration) {
  const double um_per_s2 = acceleration * 1e6;
  return static_cast<int>(version == 2 ? std::clamp(um_per_s2 * kScale2 / 250, 10.0, 1000.0) : um_per_s2);
}

}  // namespace microinjection
