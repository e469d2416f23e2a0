#include "benchmark/common/stream_estimates.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace microinjection {
namespace {

/// Share of a response's first sample below which noise would distort the fit.
constexpr double kStandsOut = 1e-3;

Eigen::VectorXd hann(int size) {
  return 0.5 - 0.5 * Eigen::ArrayXd::LinSpaced(size, 0, 2 * M_PI * (size - 1) / size).cos();
}

}  // namespace

double noiseDensity(const Eigen::VectorXd& stream, double sample_rate, int segment, double from, double to) {
  const Eigen::VectorXd window = hann(segment);
  const double scale = 2 / (sample_rate * window.squaredNorm());
  const int first = std::max(1, static_cast<int>(std::ceil(from * segment / sample_rate)));
  const int last = static_cast<int>(std::floor(to * segment / sample_rate));
  Eigen::FFT<double> transform;
  double sum = 0;
  long count = 0;
  for (Eigen::Index at = 0; at + segment <= stream.size(); at += segment / 2) {
    const Eigen::VectorXd part = stream.segment(at, segment);
    const Eigen::VectorXd windowed = (part.array() - part.mean()) * window.array();
    Eigen::VectorXcd spectrum;
    transform.fwd(spectrum, windowed);
    for (int k = first; k <= last; ++k, ++count) sum += scale * std::norm(spectrum[k]);
  }
  return std::sqrt(sum / static_cast<double>(count));
}

double roundingDensity(double step, double sample_rate) { return step / std::sqrt(6 * sample_rate); }

double quantisationStep(const Eigen::VectorXd& stream) {
  std::vector<double> sorted(stream.data(), stream.data() + stream.size());
  std::sort(sorted.begin(), sorted.end());
  const double rounding = 1e-12 * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  double step = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double difference = sorted[i] - sorted[i - 1];
    if (difference > rounding && (step == 0 || difference < step)) step = difference;
  }
  return step;
}

SecondOrder secondOrderOfStep(const Eigen::VectorXd& response, double sample_rate) {
  const Eigen::Index tail = response.size() / 2;
  const Eigen::VectorXd deviation = response.array() - response.tail(tail).mean();
  Eigen::Index rows = 2;
  for (Eigen::Index i = 2; i < tail; ++i) {
    if (std::abs(deviation[i]) > kStandsOut * std::abs(deviation[0])) rows = i;
  }
  Eigen::MatrixX2d before(rows - 1, 2);
  before << deviation.segment(1, rows - 1), deviation.head(rows - 1);
  const Eigen::Vector2d ab = before.colPivHouseholderQr().solve(deviation.segment(2, rows - 1));
  const std::complex<double> root = std::sqrt(std::complex<double>(ab[0] * ab[0] / 4 + ab[1]));
  const std::complex<double> p = std::log(ab[0] / 2 + root) * sample_rate, q = std::log(ab[0] / 2 - root) * sample_rate;
  const double omega = std::sqrt(std::abs(p * q));
  return {omega / (2 * M_PI), -(p + q).real() / (2 * omega)};
}

DriftFigures driftOf(const Eigen::VectorXd& block_means, double block, double density) {
  const Eigen::Index n = block_means.size() - 1;
  const Eigen::VectorXd change = block_means.tail(n) - block_means.head(n);
  const double mean = change.mean();
  const double variance = (change.array() - mean).square().sum() / static_cast<double>(n - 1);
  const double walk = variance - density * density / block;
  return {mean / block, std::sqrt(std::max(0.0, 1.5 * walk / block))};
}

}  // namespace microinjection
