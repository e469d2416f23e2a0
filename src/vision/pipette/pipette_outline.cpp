#include "vision/pipette/pipette_outline.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kBlock = 3;             // rows whose edges are averaged
constexpr double kMostGrowth = 0.03;  // columns per row
constexpr double kGrowthStep = 0.005;
constexpr double kSeenWall = 0.25;  // of a block's strongest edge, that a wall has at least
constexpr std::size_t kReferenceBlocks = 8;
constexpr int kGap = 2;                 // blocks without a wall that end it
constexpr double kNearlyAsLong = 0.8;   // of the longest pair of lines, a wider pair is the outline
constexpr double kMirroredWidth = 1.5;  // of the half width, what is compared with its mirror image

/// Mean derivative across, of the rows of a block; both sides by distance from the axis.
struct EdgeBlock {
  double row = 0;
  std::vector<double> left, right, shared;
  double strongest = 0;
  int most = 0;  ///< columns to both sides that are in the image
};

/// The largest of a value and its neighbours, with its sign.
double largest(const std::vector<double>& values, int i) {
  double most = 0;
  for (int k = std::max(0, i - 1); k <= std::min(static_cast<int>(values.size()) - 1, i + 1); ++k) {
    if (std::abs(values[k]) > std::abs(most)) most = values[k];
  }
  return most;
}

double wider(const std::vector<double>& values, int i) { return std::abs(largest(values, i)); }

/// From the frame's border inwards.
std::vector<EdgeBlock> blocksOf(const PipetteStrip& strip) {
  std::vector<EdgeBlock> blocks;
  int last = strip.rows() - 1;
  while (last > 0 && !strip.inside(last)) --last;
  for (int row = last - kBlock + 1; row >= 0 && strip.inside(row); row -= kBlock) {
    EdgeBlock block;
    block.row = row + 0.5 * (kBlock - 1);
    while (block.most < strip.half() && strip.contains(row, block.most + 1) && strip.contains(row, -block.most - 1) &&
           strip.contains(row + kBlock - 1, block.most + 1) && strip.contains(row + kBlock - 1, -block.most - 1)) {
      ++block.most;
    }
    block.left.assign(strip.half() + 1, 0.0);
    block.right = block.shared = block.left;
    for (int k = 0; k < kBlock; ++k) {
      const float* d = strip.across().ptr<float>(row + k) + strip.half();
      for (int t = 0; t < block.most; ++t) {
        block.left[t] += d[-t] / kBlock;
        block.right[t] += d[t] / kBlock;
      }
    }
    for (int t = 2; t <= strip.half(); ++t) {
      block.shared[t] = std::min(wider(block.left, t), wider(block.right, t));
      block.strongest = std::max(block.strongest, block.shared[t]);
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// Number of blocks from the border on that have both walls on the line. A wall keeps the sign of its
/// edge; what comes after it may not.
int lengthOf(const std::vector<EdgeBlock>& blocks, double reference, double half_width, double growth) {
  int length = 0, gap = 0;
  double left = 0, right = 0;
  for (std::size_t i = 0; i < blocks.size() && gap < kGap; ++i) {
    const int column = static_cast<int>(std::lround(half_width + growth * blocks[i].row));
    if (column < 2 || column >= static_cast<int>(blocks[i].shared.size())) break;
    // The border of the image may cut a wall off before the axis.
    if (column >= blocks[i].most) continue;
    const double here_left = largest(blocks[i].left, column), here_right = largest(blocks[i].right, column);
    if (blocks[i].shared[column] < kSeenWall * reference || here_left * left < 0 || here_right * right < 0) {
      ++gap;
      continue;
    }
    if (length == 0) {
      left = here_left;
      right = here_right;
    }
    gap = 0;
    length = static_cast<int>(i) + 1;
  }
  return length;
}

/// Edges that have a mirror image, over all.
double symmetryOf(const std::vector<EdgeBlock>& blocks, const PipetteOutline& outline, int length) {
  double shared = 0, all = 0;
  for (int i = 0; i < length; ++i) {
    const int most = static_cast<int>(std::min(kMirroredWidth * outline.at(blocks[i].row), blocks[i].most - 1.0));
    for (int t = 1; t <= most; ++t) {
      const double left = std::abs(blocks[i].left[t]), right = std::abs(blocks[i].right[t]);
      shared += std::min(left, wider(blocks[i].right, t)) + std::min(right, wider(blocks[i].left, t));
      all += left + right;
    }
  }
  return all > 0 ? shared / all : 0;
}

}  // namespace

PipetteOutline findOutline(const PipetteStrip& strip, double narrowest) {
  PipetteOutline best;
  const std::vector<EdgeBlock> blocks = blocksOf(strip);
  if (blocks.size() < 3) return best;
  std::vector<double> strongest;
  for (const EdgeBlock& block : blocks) {
    // What is farther from the border may be a cell.
    if (block.strongest > 0 && strongest.size() < kReferenceBlocks) strongest.push_back(block.strongest);
  }
  if (strongest.size() < 3) return best;
  std::nth_element(strongest.begin(), strongest.begin() + static_cast<std::ptrdiff_t>(strongest.size() / 2),
                   strongest.end());
  const double reference = strongest[strongest.size() / 2], border = blocks.front().row;
  int longest = 0;
  for (double wide = strip.half() - 2; wide >= narrowest; wide -= 1) {
    for (double growth = -kMostGrowth; growth <= kMostGrowth; growth += kGrowthStep) {
      const double half_width = wide - growth * border;
      const int length = lengthOf(blocks, reference, half_width, growth);
      // Of pairs that are about as long the widest was found first.
      if (length < 3 || kNearlyAsLong * length <= longest) continue;
      longest = length;
      best.half_width = half_width;
      best.growth = growth;
    }
  }
  if (longest == 0) return best;
  // The middle of the lines that are as long: the first one only touches the edges.
  double sum = 0, widths = 0, growths = 0;
  for (double growth = -kMostGrowth; growth <= kMostGrowth; growth += kGrowthStep) {
    for (double beside = -2.5; beside <= 2; beside += 0.5) {
      const double half_width = best.half_width + (best.growth - growth) * border + beside;
      double edges = 0;
      for (int i = 0; i < longest; ++i) {
        const int column = static_cast<int>(std::lround(half_width + growth * blocks[i].row));
        if (column >= 2 && column < blocks[i].most) edges += std::min(blocks[i].shared[column], reference);
      }
      const double weight = std::pow(edges / (longest * reference), 24);
      sum += weight;
      widths += weight * half_width;
      growths += weight * growth;
    }
  }
  best.half_width = widths / sum;
  best.growth = growths / sum;
  const int length = std::max(1, lengthOf(blocks, reference, best.half_width, best.growth));
  best.last = static_cast<int>(blocks[length - 1].row);
  best.symmetry = symmetryOf(blocks, best, length);
  best.valid = length >= 3;
  return best;
}

}  // namespace microinjection
