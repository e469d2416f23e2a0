#include "vision/microscope/edge_response.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

using Complex = std::complex<double>;

/// The step's convolution with the kernel, by the midpoint rule.
Complex convolved(double u, const Complex& variance) {
  const double step = 1e-3, far = 60;
  Complex sum = 0;
  for (double t = -far + step / 2; t < u; t += step) {
    const double width = std::min(step, u - t + step / 2);
    sum += width * std::exp(-t * t / (2.0 * variance)) / std::sqrt(2 * M_PI * variance);
  }
  return sum;
}

TEST(EdgeResponse, IsTheErrorFunctionWithoutDiffraction) {
  const EdgeResponse response;
  const EdgeResponse::Depth depth = response.depth(4, 0);
  for (double u = -9; u <= 9; u += 0.37) {
    EXPECT_NEAR(depth.at(static_cast<float>(u)).real(), 0.5 * std::erfc(-u / (2 * std::sqrt(2))), 1e-3) << u;
    EXPECT_EQ(depth.at(static_cast<float>(u)).imag(), 0) << u;
  }
}

TEST(EdgeResponse, IsTheConvolutionWithFresnelsKernel) {
  const EdgeResponse response;
  for (const Complex variance : {Complex(1, 0.5), Complex(4, -6), Complex(0.5, 3)}) {
    const EdgeResponse::Depth depth = response.depth(variance.real(), variance.imag());
    for (const double u : {-7.3, -2.1, -0.4, 0.0, 0.7, 1.9, 5.2}) {
      const auto value = depth.at(static_cast<float>(u));
      const Complex expected = convolved(u, variance);
      EXPECT_NEAR(value.real(), expected.real(), 3e-3) << u << variance;
      EXPECT_NEAR(value.imag(), expected.imag(), 3e-3) << u << variance;
    }
  }
}

TEST(EdgeResponse, IsOddAboutTheEdge) {
  const EdgeResponse response;
  for (const double diffraction : {0.0, 5.0, -40.0}) {
    const EdgeResponse::Depth depth = response.depth(2, diffraction);
    EXPECT_EQ(depth.at(0), EdgeResponse::Value(0.5, 0));
    for (float u = 0.1F; u < 30; u *= 1.3F)
      EXPECT_LT(std::abs(depth.at(u) + depth.at(-u) - EdgeResponse::Value(1, 0)), 1e-6F) << u;
  }
}

TEST(EdgeResponse, EndsWithoutAStep) {
  const EdgeResponse response;
  for (const double diffraction : {0.0, 1.0, 15.0}) {
    const EdgeResponse::Depth depth = response.depth(2, diffraction);
    const auto reach = static_cast<float>(depth.reach());
    EXPECT_LT(std::abs(depth.at(0.999F * reach) - EdgeResponse::Value(1, 0)), 2e-3F) << diffraction;
    EXPECT_EQ(depth.at(1.001F * reach), EdgeResponse::Value(1, 0));
  }
}

}  // namespace
}  // namespace microinjection
