#include "cell/model/touching_vertices.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

using Vertices = std::vector<std::uint32_t>;
const Eigen::Vector3d kPosition(1e-6, 0, 20e-6);

TEST(TouchingVertices, LieOnTheEndOrOnTheShaft) {
  Scene::Tip tip;
  tip.shape = "hemisphere";
  tip.radius = 3e-6;
  const std::vector<Eigen::Vector3d> vertices = {
      kPosition,                                     // the lowest point
      kPosition + Eigen::Vector3d(3e-6, 0, 3e-6),    // the end of the hemisphere
      kPosition + Eigen::Vector3d(0, 3.1e-6, 9e-6),  // the shaft, 0.1 um beside it
      kPosition + Eigen::Vector3d(0, 3.3e-6, 9e-6),  // too far
      kPosition - Eigen::Vector3d(0, 0, 0.3e-6),     // too far
      kPosition + Eigen::Vector3d(0, 0, 0.5e-6)};    // inside
  EXPECT_EQ(touchingVertices(tip, kPosition, vertices), (Vertices{0, 1, 2, 5}));
}

TEST(TouchingVertices, LieUnderADisc) {
  Scene::Tip tip;
  tip.radius = 3e-6;
  const std::vector<Eigen::Vector3d> vertices = {kPosition + Eigen::Vector3d(2.9e-6, 0, 0),
                                                 kPosition + Eigen::Vector3d(3.3e-6, 0, 0),
                                                 kPosition - Eigen::Vector3d(0, 0, 0.3e-6)};
  EXPECT_EQ(touchingVertices(tip, kPosition, vertices), Vertices{0});
}

}  // namespace
}  // namespace microinjection
