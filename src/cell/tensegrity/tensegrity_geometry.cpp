#include "cell/tensegrity/tensegrity_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace microinjection {
namespace {

using Kind = TensegrityGeometry::Kind;

/// Lengths in units of L at s/L = `ratio`.
double actinLength(double ratio) { return std::sqrt(0.25 + 0.25 * (1 - ratio) * (1 - ratio) + 0.25 * ratio * ratio); }
double diagonalLength(double ratio) { return std::sqrt(1 + ratio * ratio); }

/// s/L in equilibrium, by bisection of L/s - 2 - (q_side + q_diagonal) / q_actin, which decreases
/// with s/L.
double equilibriumRatio(const TensegrityConfig& config) {
  const double actin = config.actin.tension(), intermediate = config.intermediate.tension();
  if (intermediate == 0) return 0.5;
  double low = 0, high = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double ratio = 0.5 * (low + high);
    const double pull = intermediate / actin * actinLength(ratio) * (1 / ratio + 1 / diagonalLength(ratio));
    (1 / ratio - 2 - pull > 0 ? low : high) = ratio;
  }
  return 0.5 * (low + high);
}

struct EndIndex {
  int axis, side, end;
  explicit EndIndex(int number) : axis(number / 4), side(number / 2 % 2), end(number % 2) {}
};

/// Whether a cable connects two ends, and its kind. @pre a != b.
bool connection(int a, int b, Kind& kind) {
  EndIndex p(a), q(b);
  if (p.axis == q.axis) {
    if (p.side == q.side) return false;  // a strut
    kind = p.end == q.end ? Kind::kSide : Kind::kDiagonal;
    return true;
  }
  if ((p.axis + 1) % 3 != q.axis) std::swap(p, q);
  kind = Kind::kActin;
  return p.side == q.end;
}

Eigen::Vector3d top(const std::string& orientation, const Eigen::Vector3d& end) {
  if (orientation == "face") return Eigen::Vector3d::Ones().normalized();
  if (orientation == "edge") return Eigen::Vector3d::UnitY();
  return end.normalized();
}

std::vector<std::array<int, 3>> neighbourTriangles(const std::array<Eigen::Vector3d, 12>& ends) {
  const auto neighbours = [](int a, int b) {
    Kind kind;
    return connection(a, b, kind) && kind != Kind::kDiagonal;
  };
  std::vector<std::array<int, 3>> triangles;
  for (int a = 0; a < 12; ++a) {
    for (int b = a + 1; b < 12; ++b) {
      for (int c = b + 1; c < 12; ++c) {
        if (!neighbours(a, b) || !neighbours(b, c) || !neighbours(a, c)) continue;
        const bool outward = ends[a].cross(ends[b]).dot(ends[c]) > 0;
        triangles.push_back(outward ? std::array<int, 3>{a, b, c} : std::array<int, 3>{a, c, b});
      }
    }
  }
  return triangles;
}

std::array<int, 3> lowest(const std::array<Eigen::Vector3d, 12>& ends, double radius) {
  std::array<int, 12> order;
  std::iota(order.begin(), order.end(), 0);
  const auto height = [&](int end) { return std::llround(1e9 * ends[end].z() / radius); };  // ignores rounding
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return height(a) < height(b); });
  return {order[0], order[1], order[2]};
}

}  // namespace

TensegrityGeometry::TensegrityGeometry(const TensegrityConfig& config) {
  const double ratio = equilibriumRatio(config);
  strut_length = 2 * config.radius / diagonalLength(ratio);
  strut_distance = ratio * strut_length;
  for (int i = 0; i < 12; ++i) {
    const EndIndex index(i);
    ends[i].setZero();
    ends[i][index.axis] = (index.end - 0.5) * strut_length;
    ends[i][(index.axis + 1) % 3] = (index.side - 0.5) * strut_distance;
  }
  const auto turn = Eigen::Quaterniond::FromTwoVectors(top(config.orientation, ends[11]), Eigen::Vector3d::UnitZ());
  for (Eigen::Vector3d& end : ends) end = turn * end;
  for (int i = 0; i < 6; ++i) struts[i] = {2 * i, 2 * i + 1};
  for (const bool actin : {true, false}) {
    const CableConfig& cable = actin ? config.actin : config.intermediate;
    for (int a = 0; a < 12; ++a) {
      for (int b = a + 1; b < 12; ++b) {
        Kind kind;
        if (!connection(a, b, kind) || (kind == Kind::kActin) != actin) continue;
        const double length = (ends[a] - ends[b]).norm();
        cables.push_back({a, b, kind, length, length / (1 + cable.prestrain), cable.tension()});
      }
    }
  }
  triangles = neighbourTriangles(ends);
  held = lowest(ends, config.radius);
  const double q_actin = config.actin.tension() / (actinLength(ratio) * strut_length);
  const double q_diagonal = config.intermediate.tension() / (2 * config.radius);
  strut_force = ((2 - ratio) * q_actin + q_diagonal) * strut_length;
}

}  // namespace microinjection
