#include "vision/microscope/edge_response.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr int kRows = 60;                  // arguments of the variance, 0 to kLargestArgument
constexpr double kLargestArgument = 1.47;  // rad; the ratio 10
constexpr double kTableStep = 0.04;        // of |u| / sqrt|variance|
constexpr double kNegligible = 7.6;        // the kernel has fallen to exp(-7.6) = 5e-4 at the end of a row
constexpr int kSubsteps = 8;               // of the quadrature in a step

/// Integrates the kernel from 0 outwards by Simpson's rule.
std::vector<std::complex<float>> rowOf(double argument) {
  const std::complex<double> variance = std::polar(1.0, argument);
  const auto kernel = [&](double v) { return std::exp(-v * v / (2.0 * variance)) / std::sqrt(2 * M_PI * variance); };
  const int steps = static_cast<int>(std::sqrt(2 * kNegligible / std::cos(argument)) / kTableStep) + 1;
  std::vector<std::complex<float>> row(1, 0);
  std::complex<double> sum = 0;
  const double h = kTableStep / kSubsteps;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < kSubsteps; ++j) {
      const double v = i * kTableStep + j * h;
      sum += h / 6 * (kernel(v) + 4.0 * kernel(v + h / 2) + kernel(v + h));
    }
    row.emplace_back(sum);
  }
  return row;
}

/// The longest row's length for all, so that two neighbours can be interpolated. Behind its own end a
/// row is 1/2, and joins that without a step.
void settle(std::vector<std::complex<float>>& row, std::size_t length) {
  const std::size_t end = row.size();
  const std::size_t fade = end / 5;
  for (std::size_t i = end - fade; i < end; ++i) {
    const float share = static_cast<float>(i - (end - fade) + 1) / static_cast<float>(fade);
    row[i] += share * (std::complex<float>(0.5F, 0) - row[i]);
  }
  row.resize(length, {0.5F, 0});
}

std::vector<std::vector<std::complex<float>>> makeTable() {
  std::vector<std::vector<std::complex<float>>> rows;
  for (int i = 0; i < kRows; ++i) rows.push_back(rowOf(kLargestArgument * i / (kRows - 1)));
  const std::size_t length = rows.back().size() + 1;
  for (auto& row : rows) settle(row, length);
  return rows;
}

const std::vector<std::vector<std::complex<float>>>& table() {
  static const std::vector<std::vector<std::complex<float>>> rows = makeTable();
  return rows;
}

}  // namespace

EdgeResponse::EdgeResponse() : rows_(table()) {}

EdgeResponse::Depth EdgeResponse::depth(double blur, double diffraction) const {
  blur = std::max(blur, std::abs(diffraction) / std::tan(kLargestArgument));
  const double place = std::atan2(std::abs(diffraction), blur) / kLargestArgument * (kRows - 1);
  const int row = std::min(static_cast<int>(place), kRows - 2);
  Depth depth;
  depth.near_ = rows_[row].data();
  depth.far_ = rows_[row + 1].data();
  depth.share_ = static_cast<float>(place - row);
  depth.sign_ = diffraction < 0 ? -1.0F : 1.0F;
  depth.to_table_ = static_cast<float>(1 / (kTableStep * std::sqrt(std::hypot(blur, diffraction))));
  const double argument = kLargestArgument * (row + 1) / (kRows - 1);
  const auto end = std::sqrt(2 * kNegligible / std::cos(argument)) / kTableStep;
  depth.last_ = static_cast<float>(std::min<double>(end, static_cast<double>(rows_[row].size()) - 2));
  return depth;
}

}  // namespace microinjection
