#include "cell/surrogate/surrogate_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/errors.h"
#include "cell/surrogate/spring_cells.h"

namespace microinjection {
namespace {

TEST(SurrogateData, IsKnownByItsScene) {
  const Scene scene = pipette();
  const SurrogateRange range = SurrogateRange::standard(scene);
  Scene other = scene, same = scene;
  other.cell.material().poisson_ratio = 0.48;
  same.needle.offset = {5e-6, 0};
  same.mesh.size = 5e-6;
  const auto line = [&](const Scene& s) { return SurrogatePlan::plan(s, range).description(s); };
  EXPECT_EQ(line(scene), line(same));
  EXPECT_NE(line(scene), line(other));
  SurrogateRange less = range;
  less.depth /= 2;
  EXPECT_NE(line(scene), SurrogatePlan::plan(scene, less).description(scene));
}

TEST(SurrogatePlan, RefusesWhatHasNoEnergy) {
  Scene scene = pipette();
  EXPECT_NO_THROW(SurrogatePlan::check(scene));
  Scene relaxing = scene;
  relaxing.cell.material().viscoelasticity.prony = {{0.5, 0.2}};
  EXPECT_NO_THROW(SurrogatePlan::check(relaxing));
  const SurrogateRange range = SurrogateRange::standard(scene);
  EXPECT_EQ(SurrogatePlan::plan(scene, range).description(scene),  // one equilibrium
            SurrogatePlan::plan(relaxing, range).description(relaxing));
  Scene rubbing = scene;
  rubbing.needle.contact = {"sliding", 0.2};
  EXPECT_NO_THROW(SurrogatePlan::check(rubbing)) << "its way in is prepared";
  Scene viscous = scene, sticky = scene, different = relaxing;
  viscous.cell.material().viscoelasticity.viscosity = 1;
  sticky.needle.contact.adhesion_energy = 1e-3;
  sticky.needle.contact.adhesion_range = 1e-7;
  different.cell.layers.push_back(different.cell.layers.front());
  different.cell.layers.back().outer_radius /= 2;
  different.cell.layers.back().material.viscoelasticity.prony[0].relaxation_time = 1;
  for (const Scene& bad : {viscous, sticky, different}) EXPECT_THROW(SurrogatePlan::check(bad), ConfigError);
}

TEST(SurrogatePlan, RefusesASharpDiscButOnALinearCell) {
  Scene disc;
  EXPECT_THROW(SurrogatePlan::check(disc), ConfigError);
  disc.cell.material().model = "linear";
  EXPECT_NO_THROW(SurrogatePlan::check(disc));
  disc.cell.layers.front().surface_tension = 1e-3;
  EXPECT_THROW(SurrogatePlan::check(disc), ConfigError);
}

TEST(SurrogatePlan, RaysFillTheRange) {
  const Scene scene = pipette();
  const SurrogateRange range = SurrogateRange::standard(scene);
  const SurrogatePlan plan = SurrogatePlan::plan(scene, range);
  for (const TrainingRay& ray : plan.rays) {
    const double lateral = ray.target.head<2>().norm() / range.lateral, depth = -ray.target.z() / range.depth;
    EXPECT_NEAR(std::max(lateral, depth), 1, 1e-12);
    EXPECT_GE(ray.target.y(), -1e-18);  // the other half is its mirror image
    EXPECT_LE(ray.angle, range.angle);
  }
}

}  // namespace
}  // namespace microinjection
