#include "operation/display/cell_members.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr Colour kStrutColour{0.80f, 0.35f, 0.30f, 1}, kSlackColour{0.45f, 0.45f, 0.45f, 1};

void add(const CellMembers& members, std::size_t member, const Colour& colour, double enlargement,
         ColouredLines& result) {
  for (std::size_t end = 0; end < 2; ++end) {
    result.lines.push_back(toDisplay(members.points[2 * member + end], enlargement));
    result.colours.push_back(colour);
  }
}

}  // namespace

std::string CellMembers::defect() const {
  if (points.size() != 2 * forces.size() || kinds.size() != forces.size()) return "members' lengths do not fit";
  const bool finite = std::all_of(points.begin(), points.end(), [](const auto& point) { return point.allFinite(); }) &&
                      std::all_of(forces.begin(), forces.end(), [](double force) { return std::isfinite(force); });
  return finite ? "" : "members are not finite";
}

double CellMembers::largestTension() const {
  return forces.empty() ? 0 : std::max(0.0, *std::max_element(forces.begin(), forces.end()));
}

ColouredLines strutLines(const CellMembers& members, double enlargement) {
  ColouredLines result;
  for (std::size_t i = 0; i < members.kinds.size(); ++i) {
    if (members.kinds[i] == CellMembers::kStrut) add(members, i, kStrutColour, enlargement, result);
  }
  return result;
}

ColouredLines cableLines(const CellMembers& members, double range, double enlargement) {
  ColouredLines result;
  for (std::size_t i = 0; i < members.kinds.size(); ++i) {
    if (members.kinds[i] == CellMembers::kStrut) continue;
    const double force = members.forces[i];
    add(members, i, force > 0 ? colourOfFraction(force / range) : kSlackColour, enlargement, result);
  }
  return result;
}

}  // namespace microinjection
