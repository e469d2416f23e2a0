#include "cell/family/surface_modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace microinjection {
namespace {

/// Bumps whose width depends on the member: no few modes are exact.
Eigen::MatrixXf bumps(double width) {
  Eigen::MatrixXf result(300, 40);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index k = 0; k < result.cols(); ++k) {
      const double x = static_cast<double>(i) / 300, middle = 0.2 + 0.015 * static_cast<double>(k);
      result(i, k) = static_cast<float>(std::exp(-std::pow((x - middle) / width, 2)));
    }
  }
  return result;
}

TEST(SurfaceModes, KeepTheSurfacesOfAllMembers) {
  SurfaceModes surfaces;
  const double widths[] = {0.1, 0.14, 0.2, 0.3};
  for (const double width : widths) surfaces.add(bumps(width));
  ASSERT_EQ(surfaces.amplitudes().size(), 4u);
  EXPECT_LE(surfaces.modes().cols(), 60);
  for (int i = 0; i < 4; ++i) {
    const Eigen::MatrixXf kept = surfaces.modes() * surfaces.amplitudes()[i].transpose();
    EXPECT_LT((kept - bumps(widths[i])).norm(), 1e-4 * bumps(widths[i]).norm()) << widths[i];
  }
}

TEST(SurfaceModes, RefuseAmplitudesOfOtherModes) {
  SurfaceModes surfaces;
  EXPECT_THROW(surfaces.set(Eigen::MatrixXf::Zero(6, 2), {Eigen::MatrixXf::Zero(5, 3)}), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
