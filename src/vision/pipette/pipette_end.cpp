#include "vision/pipette/pipette_end.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr double kShareOfNext = 0.45;  // of the edges in the rows that follow, at a point
constexpr int kRise = 9;               // of these rows
constexpr double kOverBackground = 3;  // of the background's edges, at a point
constexpr int kReference = 50;         // rows, whose median is before the end
constexpr int kLeastShaft = 8;         // rows in the frame, of a pipette that is seen
constexpr int kBehind = 16;            // rows behind the end that have none
constexpr int kLag = 4, kLagRows = 8;  // rows before a row that show what its profile should be
constexpr double kUnlike = 0.3;        // mean likeness of the rows behind a tip, at most
constexpr int kRampRows = 10;          // rows before a tip that show how its contrast fades
constexpr double kLeastRamp = 0.12;    // of the contrast in these rows, a fading end at least
constexpr double kFirst = 0.6;         // of the strongest edge along a column, the first that counts
constexpr int kWideningRows = 16;
constexpr double kMouthWall = 0.35;  // of the half width, the outer part of a mouth that is wall

double meanOfRows(const std::vector<double>& values, int first, int last) {
  double sum = 0;
  first = std::max(first, 0);
  last = std::min(last, static_cast<int>(values.size()));
  for (int i = first; i < last; ++i) sum += values[i];
  return last > first ? sum / (last - first) : 0;
}

}  // namespace

PipetteEnd coarseEnd(const PipetteStrip& strip, const std::vector<double>& edges, double ended) {
  PipetteEnd end;
  int last = strip.rows() - 1;
  while (last > 0 && !strip.inside(last)) --last;
  for (int row = last - kLeastShaft; row > kBehind; --row) {
    if (!strip.inside(row - kBehind)) break;
    const int until = std::min(last + 1, row + kReference);
    const double before = upperMedian({edges.begin() + row, edges.begin() + until});
    const double behind = meanOfRows(edges, row - kBehind, row);
    if (behind > ended * before || edges[row] > 0.5 * before) continue;
    end.valid = true;
    end.row = row;
    end.deviation = 4;
    end.clearness = before / std::max(behind, 1e-9);
    return end;
  }
  return end;
}

PipetteEnd pointNear(const PipetteStrip& strip, double coarse, double reach, int half_width) {
  PipetteEnd end;
  const std::vector<double> edges = allEdges(strip, std::vector<double>(strip.rows(), half_width));
  const int low = std::max(0, static_cast<int>(coarse - reach)),
            high = std::min(strip.rows() - kRise - 1, static_cast<int>(coarse + reach));
  const int behind = std::min(static_cast<int>(0.4 * reach), 20);
  if (high - low < 2 * behind || !strip.inside(low)) return end;
  const double background = upperMedian({edges.begin() + low, edges.begin() + low + behind});
  for (int row = low + behind; row <= high; ++row) {
    const double next = *std::max_element(edges.begin() + row, edges.begin() + row + kRise);
    if (edges[row] < kOverBackground * background || edges[row] < kShareOfNext * next) continue;
    const double step = std::max(edges[row] - edges[row - 1], 1e-9);
    end.row =
        row - std::clamp((edges[row] - std::max(kShareOfNext * next, kOverBackground * background)) / step, 0.0, 1.0);
    end.deviation = std::hypot(0.5, next / (4 * step));
    end.clearness = *std::max_element(edges.begin() + row, edges.end()) / std::max(background, 1e-9);
    end.valid = true;
    return end;
  }
  return end;
}

namespace {

/// Size of a row's profile relative to that of the rows just before it, which are nearer to the shaft.
double likeness(const PipetteStrip& strip, int row, int half) {
  double product = 0, energy = 0;
  for (int t = -half; t <= half; ++t) {
    double mean = 0;
    for (int k = kLag; k < kLag + kLagRows; ++k) mean += strip.across().at<float>(row + k, t + strip.half());
    mean /= kLagRows;
    product += mean * strip.across().at<float>(row, t + strip.half());
    energy += mean * mean;
  }
  return energy > 0 ? product / energy : 0;
}

}  // namespace

PipetteEnd tubeNear(const PipetteStrip& strip, double coarse, double reach, int half_width) {
  PipetteEnd end;
  const int half = std::min(half_width, strip.half());
  const int high = std::min(strip.rows() - kLag - kLagRows - 1, static_cast<int>(coarse + reach));
  const int low = std::max(kBehind, static_cast<int>(coarse - reach));
  std::vector<double> like(strip.rows(), 0.0);
  for (int row = std::max(0, low - kBehind); row <= high; ++row) like[row] = likeness(strip, row, half);
  for (int row = high; row > low; --row) {
    if (like[row] >= 0.5 || meanOfRows(like, row - kBehind, row + 1) > kUnlike) continue;
    const double step = std::max(like[row + 1] - like[row], 1e-3);
    end.row = row + std::clamp((0.5 - like[row]) / step, 0.0, 1.0);
    double noise = 0;
    for (int i = row - kBehind; i < row - 2; ++i) noise += like[i] * like[i] / (kBehind - 2);
    const double slope = std::max((like[std::min(row + 2, high)] - like[row - 1]) / 3, 1e-2);
    end.deviation = std::hypot(0.05, 0.5 * std::sqrt(noise) / slope);
    end.clearness = 1 / std::max(std::sqrt(noise), 1e-3);
    end.valid = true;
    return end;
  }
  return end;
}

namespace {

/// Size of each row's profile relative to the mean one of the rows [first, last).
std::vector<double> projected(const PipetteStrip& strip, int first, int last, int half) {
  std::vector<double> profile(2 * half + 1, 0.0), size(strip.rows(), 0.0);
  double energy = 0;
  for (int t = -half; t <= half; ++t) {
    for (int row = first; row < last; ++row) profile[t + half] += strip.across().at<float>(row, t + strip.half());
    profile[t + half] /= last - first;
    energy += profile[t + half] * profile[t + half];
  }
  if (!(energy > 0)) return size;
  for (int row = 0; row < strip.rows(); ++row) {
    const float* d = strip.across().ptr<float>(row) + strip.half();
    for (int t = -half; t <= half; ++t) size[row] += profile[t + half] * d[t];
    size[row] /= energy;
  }
  return size;
}

struct Ramp {
  double offset = 0, slope = 0;  ///< value at row `from`, per row
  int from = 0;
  double at(double row) const { return offset + slope * (row - from); }
};

Ramp rampOf(const std::vector<double>& values, int first, int last) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const int count = last - first;
  for (int i = first; i < last; ++i) {
    x += i - first;
    y += values[i];
    xx += (i - first) * (i - first);
    xy += (i - first) * values[i];
  }
  const double slope = (count * xy - x * y) / (count * xx - x * x);
  return {(y - slope * x) / count, slope, first};
}

}  // namespace

PipetteEnd tipNear(const PipetteStrip& strip, double coarse, int half_width) {
  PipetteEnd end;
  const int half = std::min(half_width, strip.half());
  double place = coarse;
  for (int round = 0; round < 5; ++round) {
    const int row = static_cast<int>(std::lround(place));
    if (row < kBehind || row + kRampRows + 3 >= strip.rows()) return {};
    const std::vector<double> size = projected(strip, row + 2, row + 10, half);
    const Ramp ramp = rampOf(size, row + 3, row + 3 + kRampRows);
    int i = row + 3;
    // The wall is thin at the end: half of what the ramp of its contrast says is there.
    while (i > row - kBehind + 2 && i > 1 && size[i] >= 0.5 * std::max(ramp.at(i), kLeastRamp)) --i;
    const double below = size[i] - 0.5 * std::max(ramp.at(i), kLeastRamp);
    const double above = size[i + 1] - 0.5 * std::max(ramp.at(i + 1), kLeastRamp);
    if (i <= row - kBehind + 2 || !(above > below)) return {};
    const double next = i - below / (above - below);
    double noise = 0;
    const int from = std::max(0, i - kBehind);
    for (int k = from; k < i - 2; ++k) noise += size[k] * size[k] / std::max(1, i - 2 - from);
    end.deviation = std::hypot(0.05, 0.7 * std::sqrt(noise) / std::max(above - below, 1e-3));
    end.clearness = ramp.at(i + 2) / std::max(std::sqrt(noise), 1e-3);
    const bool settled = std::abs(next - place) < 0.05;
    place = end.row = next;
    end.valid = true;
    if (settled) break;
  }
  return end;
}

namespace {

/// Row of the first clear edge along a column, from behind; negative when there is none.
double firstEdge(const PipetteStrip& strip, int column, int low, int high) {
  const auto at = [&](int row) { return std::abs(strip.along().at<float>(row, column)); };
  float most = 0;
  for (int row = low; row <= high; ++row) most = std::max(most, at(row));
  for (int row = low; row <= high; ++row) {
    if (at(row) < kFirst * most || at(row) < at(row - 1) || at(row) < at(row + 1)) continue;
    const double a = at(row - 1), b = at(row), c = at(row + 1), bend = a - 2 * b + c;
    return row + (bend < 0 ? 0.5 * (a - c) / bend : 0);
  }
  return -1;
}

struct MouthLip {
  bool valid = false;
  double row = 0, column = 0, spread = 0;
};

/// Where the lip of one side ends: the outermost of the edges, without the outliers.
MouthLip lipOf(const PipetteStrip& strip, int side, int inner, int outer, int low, int high) {
  std::vector<double> rows;
  for (int t = inner; t <= std::min(outer, strip.half() - 1); ++t) {
    const double row = firstEdge(strip, side * t + strip.half(), low, high);
    if (row > 0) rows.push_back(row);
  }
  MouthLip lip;
  if (rows.size() < 4) return lip;
  std::sort(rows.begin(), rows.end());
  const std::size_t from = rows.size() / 10, to = std::max(from + 3, rows.size() * 4 / 10);
  for (std::size_t i = from; i < to; ++i) lip.row += rows[i] / static_cast<double>(to - from);
  lip.spread = rows[to] - rows[from];
  lip.column = side * 0.5 * (inner + outer);
  lip.valid = true;
  return lip;
}

}  // namespace

PipetteEnd mouthNear(const PipetteStrip& strip, double coarse, double half_width, double reach, double& slant) {
  PipetteEnd end;
  const int outer = static_cast<int>(half_width - 3), inner = static_cast<int>((1 - kMouthWall) * half_width);
  const int low = std::max(1, static_cast<int>(coarse - reach));
  const int high = std::min(strip.rows() - 2, static_cast<int>(coarse + reach));
  const MouthLip left = lipOf(strip, -1, inner, outer, low, high), right = lipOf(strip, 1, inner, outer, low, high);
  if (!left.valid || !right.valid) return end;
  end.row = 0.5 * (left.row + right.row);
  slant = (right.row - left.row) / (right.column - left.column);
  end.deviation = std::hypot(0.1, 0.25 * (left.spread + right.spread));
  end.clearness = 1;
  end.valid = true;
  return end;
}

double widening(const PipetteStrip& strip, double end, int half_width) {
  double width[2] = {0, 0};
  for (int part = 0; part < 2; ++part) {
    double sum = 0, moment = 0;
    const int first = static_cast<int>(end) + 3 + part * kWideningRows;
    for (int row = std::max(0, first); row < std::min(strip.rows(), first + 8); ++row) {
      for (int t = -std::min(half_width, strip.half()); t <= std::min(half_width, strip.half()); ++t) {
        const double d = strip.across().at<float>(row, t + strip.half());
        sum += d * d;
        moment += d * d * t * t;
      }
    }
    width[part] = sum > 0 ? std::sqrt(moment / sum) : 0;
  }
  return (width[1] - width[0]) / kWideningRows;
}

}  // namespace microinjection
