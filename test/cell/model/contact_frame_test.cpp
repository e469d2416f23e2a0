#include "cell/model/contact_frame.h"

#include <gtest/gtest.h>

#include "cell/model/test_scenes.h"

namespace microinjection {
namespace {

TEST(ContactFrame, IsWhereTheTipMeetsTheCell) {
  const Scene scene = pipetteScene();
  for (double angle : {0.0, 0.3, 1.0}) {
    const Eigen::Vector2d offset = ContactFrame::offsetFor(scene, angle);
    const auto place = ContactFrame::at(scene, offset);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->angle, angle, 1e-9);
    const Eigen::Vector3d centre = place->origin + Eigen::Vector3d(0, 0, scene.needle.tip.radius);
    EXPECT_NEAR(centre.norm(), scene.radius() + scene.needle.tip.radius, 1e-12);
  }
  const auto beside = ContactFrame::at(scene, {0, 10e-6});
  EXPECT_NEAR(beside->rotation(1, 0), 1, 1e-12);  // x of the place is y of the world
  EXPECT_FALSE(ContactFrame::at(scene, {32e-6, 0}));
  Scene disc;
  EXPECT_NEAR(ContactFrame::at(disc, ContactFrame::offsetFor(disc, 0.4))->angle, 0.4, 1e-12);
}

}  // namespace
}  // namespace microinjection
