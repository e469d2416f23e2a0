#include "vision/pipette/axis_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace microinjection {
namespace {

/// Rows that are compared together, of a shaft of at least so many rows.
struct BlockSize {
  int shaft, rows;
};
constexpr BlockSize kBlocks[] = {{40, 10}, {16, 5}, {0, 3}};
constexpr int kLeastBlocks = 3;
constexpr double kMostSlant = 0.16;  // columns per row
constexpr double kSlantStep = 0.005;
constexpr double kLeastRowSymmetry = 0.45;
constexpr int kMostOffAxis = 5;  // half columns beside the common axis, that a block's own may be

struct MirroredBlock {
  double row = 0;  ///< rows behind the first one
  std::vector<double> mirrored;
};

struct SymmetricPlace {
  double row, column;
};

double interpolated(const std::vector<double>& values, double place) {
  const int i = static_cast<int>(std::floor(place));
  if (i < 0 || i + 1 >= static_cast<int>(values.size())) return 0;
  return values[i] + (place - i) * (values[i + 1] - values[i]);
}

/// The straight line with the largest sum of symmetry over all blocks.
AxisFit common(const std::vector<MirroredBlock>& blocks, int most) {
  AxisFit best;
  double highest = 0;
  for (double slant = -kMostSlant; slant <= kMostSlant; slant += kSlantStep) {
    for (double offset = -0.5 * most; offset <= 0.5 * most; offset += 0.5) {
      double sum = 0;
      for (const MirroredBlock& block : blocks)
        sum += interpolated(block.mirrored, 2 * (offset + slant * block.row) + most);
      if (sum <= highest) continue;
      highest = sum;
      best.offset = offset;
      best.slant = slant;
    }
  }
  best.symmetry = highest / static_cast<double>(blocks.size());
  best.valid = best.symmetry > kLeastRowSymmetry;
  return best;
}

std::vector<SymmetricPlace> placesBeside(const std::vector<MirroredBlock>& blocks, const AxisFit& axis, int most) {
  std::vector<SymmetricPlace> places;
  for (const MirroredBlock& block : blocks) {
    const auto& values = block.mirrored;
    const int middle = static_cast<int>(std::lround(2 * (axis.offset + axis.slant * block.row))) + most;
    const int low = std::max(1, middle - kMostOffAxis),
              high = std::min(static_cast<int>(values.size()) - 2, middle + kMostOffAxis);
    if (low >= high) continue;
    const auto peak = std::max_element(values.begin() + low, values.begin() + high + 1);
    const int i = static_cast<int>(peak - values.begin());
    const double bend = values[i - 1] - 2 * values[i] + values[i + 1];
    if (i == low || i == high || bend >= 0 || values[i] < kLeastRowSymmetry) continue;
    places.push_back({block.row, 0.5 * (i + 0.5 * (values[i - 1] - values[i + 1]) / bend - most)});
  }
  return places;
}

}  // namespace

AxisFit fitAxis(const PipetteStrip& strip, int first, int rows, double half_width, int most) {
  std::vector<MirroredBlock> blocks;
  const int last = std::min(strip.rows(), first + rows);
  const auto sees = [&](const BlockSize& size) {
    return size.shaft == 0 || (first + size.shaft <= last && strip.inside(first + size.shaft - 1));
  };
  const int together = std::find_if(std::begin(kBlocks), std::end(kBlocks), sees)->rows;
  for (int row = first; row + together <= last && strip.inside(row + together - 1); row += together) {
    MirroredBlock block{row + 0.5 * (together - 1) - first, mirrored(strip, row, row + together, half_width, most)};
    if (!block.mirrored.empty()) blocks.push_back(std::move(block));
  }
  if (blocks.size() < kLeastBlocks) return {};
  AxisFit fit = common(blocks, most);
  if (!fit.valid) return fit;
  const std::vector<SymmetricPlace> places = placesBeside(blocks, fit, most);
  if (places.size() < kLeastBlocks) {
    fit.offset_deviation = 1;
    fit.slant_deviation = kSlantStep;
    return fit;
  }
  double scale = 0.5 * kMostOffAxis;
  for (int round = 0; round < 6; ++round) {
    double w = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const SymmetricPlace& place : places) {
      const double d = (place.column - fit.offset - fit.slant * place.row) / (3 * scale);
      const double weight = std::abs(d) < 1 ? (1 - d * d) * (1 - d * d) : 0;
      w += weight;
      x += weight * place.row;
      y += weight * place.column;
      xx += weight * place.row * place.row;
      xy += weight * place.row * place.column;
    }
    const double det = w * xx - x * x;
    if (w < 1.5 || det <= 1e-9) break;
    fit.slant = (w * xy - x * y) / det;
    fit.offset = (y - fit.slant * x) / w;
    std::vector<double> sizes;
    for (const SymmetricPlace& place : places)
      sizes.push_back(std::abs(place.column - fit.offset - fit.slant * place.row));
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
    scale = std::max(0.1, 1.48 * sizes[sizes.size() / 2]);
    fit.offset_deviation = scale * std::sqrt(xx / det);
    fit.slant_deviation = scale * std::sqrt(w / det);
  }
  return fit;
}

}  // namespace microinjection
