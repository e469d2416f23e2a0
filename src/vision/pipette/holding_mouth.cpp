#include "vision/pipette/holding_mouth.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace microinjection {
namespace {

constexpr int kArcAngles = 13, kFineAngles = 31;
constexpr double kFirstAngle = 0.1, kLastAngle = 2.0;  // rad, of an arc, from the wall to beyond its outermost place
constexpr double kSmallestLip = 0.04, kLargestLip = 0.42;  // of the half width, radius
constexpr double kLipStep = 0.04;
constexpr int kShaftRows = 24, kShaftGap = 8;       // behind the lip, that show the walls
constexpr double kFineAngle = 0.3;                  // rad, first of the refined ones
constexpr double kRefinedStep = 0.5, kFaint = 0.3;  // px; of the wall
constexpr double kRefinedReach = 3.5;               // px along the normal, of a refined place
constexpr double kLeastArcScore = 0.35, kSureArcScore = 0.96;
constexpr double kMostUneven = 0.06;      // slant of a mouth that is certain
constexpr double kWallOff = 10;           // px, that a wall may be off the given width
constexpr double kClearWall = 0.5;        // of the clearest edge near it
constexpr double kTowardsShaft = 1.6;     // what looks like walls may go on beyond a mouth, into a cell
constexpr int kWidestEdge = 24;           // px, of an edge
constexpr double kWidestSharpEdge = 6.5;  // px, an edge of a pipette in focus
constexpr double kSoft = 1.5;             // px, prior of radius and width

struct Arc {
  double apex, radius, half_width;  ///< row; columns
};

float valueAt(const cv::Mat& image, double row, double column) {
  const int y = static_cast<int>(std::floor(row)), x = static_cast<int>(std::floor(column));
  if (y < 0 || x < 0 || y + 1 >= image.rows || x + 1 >= image.cols) return 0;
  const auto v = static_cast<float>(row - y), u = static_cast<float>(column - x);
  const float *a = image.ptr<float>(y) + x, *b = image.ptr<float>(y + 1) + x;
  return (1 - v) * ((1 - u) * a[0] + u * a[1]) + v * ((1 - u) * b[0] + u * b[1]);
}

/// Derivative along the outward normal, `off` px outside of the arc at `angle`.
double slopeAt(const PipetteStrip& strip, const Arc& arc, int side, double angle, double off) {
  const double c = std::cos(angle), s = std::sin(angle), r = arc.radius + off;
  const double row = arc.apex + arc.radius - r * s,
               column = strip.half() + side * (arc.half_width - arc.radius + r * c);
  return side * c * valueAt(strip.across(), row, column) - s * valueAt(strip.along(), row, column);
}

/// Mean derivative across of one outer wall, outwards: with its sign.
double wallAt(const PipetteStrip& strip, int side, double row, double half_width) {
  double sum = 0;
  for (int k = 0; k < kShaftRows; ++k) sum += side * valueAt(strip.across(), row + k, strip.half() + side * half_width);
  return sum / kShaftRows;
}

/// The outermost half width near a given one at which both walls have a clear edge.
double wallsNear(const PipetteStrip& strip, double row, double half_width) {
  std::vector<double> sizes;
  for (double shift = -kWallOff; shift <= kWallOff; shift += 0.5) {
    sizes.push_back(std::min(std::abs(wallAt(strip, -1, row, half_width + shift)),
                             std::abs(wallAt(strip, 1, row, half_width + shift))));
  }
  const double least = kClearWall * *std::max_element(sizes.begin(), sizes.end());
  for (std::size_t i = sizes.size() - 2; i > 0; --i) {
    if (sizes[i] > least && sizes[i] >= sizes[i - 1] && sizes[i] > sizes[i + 1])
      return half_width - kWallOff + 0.5 * static_cast<double>(i);
  }
  return half_width;
}

/// Width (px) of the clearer wall's edge: its height over its slope. A pipette out of focus has wide ones.
double edgeWidth(const PipetteStrip& strip, double row, double half_width) {
  double least = 1e9;
  for (const int side : {-1, 1}) {
    const double peak = wallAt(strip, side, row, half_width);
    double sum = 0;
    for (const double step : {-0.5, 0.5}) {
      for (int i = 0; i < 2 * kWidestEdge; ++i) {
        const double ratio = wallAt(strip, side, row, half_width + step * (i + (step > 0 ? 0 : 1))) / peak;
        if (!(ratio > 0.1)) break;
        sum += 0.5 * ratio;
      }
    }
    least = std::min(least, sum);
  }
  return least;
}

/// What the walls look like: the sign of their edges counts where both sides have the same.
struct Walls {
  double size[2];
  bool is_signed;
  double relative(double slope, int side) const {
    const double ratio = slope / size[side > 0 ? 1 : 0];
    return std::clamp(is_signed ? ratio : std::abs(ratio), -0.3, 1.0);
  }
};

double scoreOf(const PipetteStrip& strip, const Walls& walls, const Arc& arc) {
  double worst = 1;
  for (const int side : {-1, 1}) {
    double sum = 0;
    for (int i = 0; i < kArcAngles; ++i) {
      const double angle = kFirstAngle + (kLastAngle - kFirstAngle) * i / (kArcAngles - 1);
      sum += walls.relative(slopeAt(strip, arc, side, angle, 0), side) / kArcAngles;
    }
    worst = std::min(worst, sum);
  }
  return worst;
}

struct RefinedLip {
  bool valid = false;
  double apex = 0, deviation = 0;
};

/// Place off the arc with the steepest edge of the walls' sign; NaN where there is none near it.
double steepestOff(const PipetteStrip& strip, const Walls& walls, const Arc& arc, int side, double angle) {
  const auto size = [&](double off) {
    const double ratio = slopeAt(strip, arc, side, angle, off) / walls.size[side > 0 ? 1 : 0];
    return walls.is_signed ? ratio : std::abs(ratio);
  };
  double best = kFaint, place = kRefinedReach;
  for (double off = -kRefinedReach; off <= kRefinedReach; off += kRefinedStep) {
    const double value = size(off);
    if (value <= best) continue;
    best = value;
    place = off;
  }
  if (std::abs(place) > kRefinedReach - 0.1) return std::nan("");
  const double a = size(place - kRefinedStep), c = size(place + kRefinedStep), bend = a - 2 * best + c;
  return bend < 0 ? place + kRefinedStep * std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : place;
}

/// Moves an arc to the steepest places along its normals: centre and radius by least squares, the
/// radius and the width only as far as the arc determines them.
RefinedLip refinedLip(const PipetteStrip& strip, const Walls& walls, Arc arc, int side) {
  RefinedLip lip;
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right(0, 0, 0);
    double square = 0;
    int count = 0;
    matrix(1, 1) = matrix(2, 2) = 1 / (kSoft * kSoft);
    for (int i = 0; i < kFineAngles; ++i) {
      const double angle = kFineAngle + (kLastAngle - kFineAngle) * i / (kFineAngles - 1);
      const double place = steepestOff(strip, walls, arc, side, angle);
      if (std::isnan(place)) continue;
      const Eigen::Vector3d row(-std::sin(angle), std::cos(angle), 1);
      const double weight = 1 / (1 + place * place);
      matrix += weight * row * row.transpose();
      right += weight * place * row;
      square += weight * place * place;
      ++count;
    }
    if (count < kFineAngles / 2) return {};
    const Eigen::Vector3d change = matrix.ldlt().solve(right);
    arc.apex += change[0] - change[2];
    arc.half_width += change[1] + change[2];
    arc.radius = std::max(1.0, arc.radius + change[2]);
    const Eigen::Matrix3d inverse = matrix.inverse();
    const double variance = std::max(0.01, (square - right.dot(change)) / count);
    lip.deviation = std::sqrt(variance * (inverse(0, 0) + inverse(2, 2) - 2 * inverse(0, 2)));
  }
  lip.apex = arc.apex;
  lip.valid = true;
  return lip;
}

}  // namespace

HoldingMouth findMouth(const PipetteStrip& strip, double coarse, double reach, double half_width) {
  HoldingMouth mouth;
  const double shaft = std::min(coarse + kShaftGap + kLargestLip * half_width, strip.rows() - kShaftRows - 2.0);
  half_width = wallsNear(strip, shaft, half_width);
  Walls walls{{wallAt(strip, -1, shaft, half_width), wallAt(strip, 1, shaft, half_width)}, true};
  walls.is_signed = walls.size[0] * walls.size[1] > 0;
  if (std::min(std::abs(walls.size[0]), std::abs(walls.size[1])) < 1e-5) return mouth;
  Arc best{coarse, kSmallestLip * half_width, half_width};
  for (double radius = kSmallestLip; radius <= kLargestLip; radius += kLipStep) {
    for (double apex = coarse - reach; apex <= coarse + kTowardsShaft * reach; apex += 1) {
      for (double shift = -1; shift <= 1; shift += 1) {
        const Arc arc{apex, radius * half_width, half_width + shift};
        const double score = scoreOf(strip, walls, arc);
        if (score <= mouth.score) continue;
        mouth.score = score;
        best = arc;
      }
    }
  }
  if (mouth.score < kLeastArcScore) return mouth;
  const RefinedLip left = refinedLip(strip, walls, best, -1), right = refinedLip(strip, walls, best, 1);
  if (!left.valid || !right.valid) return mouth;
  mouth.row = 0.5 * (left.apex + right.apex);
  mouth.slant = (right.apex - left.apex) / (2 * (best.half_width - best.radius));
  mouth.deviation = 0.5 * std::hypot(left.deviation, right.deviation);
  mouth.valid = true;
  mouth.half_width = half_width;
  if (edgeWidth(strip, shaft, half_width) > kWidestSharpEdge)
    mouth.doubt = "the pipette is out of focus: its mouth is displaced";
  // In DIC an edge is a line, whose steepest slope lies beside it.
  if (!walls.is_signed) mouth.doubt = "the walls are shaded from one side: the mouth is displaced";
  mouth.faint = mouth.doubt.empty() && mouth.score < kSureArcScore && std::abs(mouth.slant) <= kMostUneven;
  if (mouth.score < kSureArcScore) mouth.doubt = "the lips of the mouth are not clear";
  if (std::abs(mouth.slant) > kMostUneven) mouth.doubt = "the lips are not at the same place of the axis";
  return mouth;
}

}  // namespace microinjection
