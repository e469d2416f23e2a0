#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "cell/family/family_cell.h"
#include "cell/family/family_data.h"
#include "cell/family/family_file.h"
#include "cell/family/family_reference.h"
#include "cell/model/scene.h"
#include "cell/surrogate/axis_ray.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {
namespace {

/// The families whose data are part of the repository.
class ShippedFamily : public testing::TestWithParam<const char*> {
 protected:
  ShippedFamily() {
    auto read = FamilyData::load(family_, familyDataFile(file_));
    if (read) data_ = std::move(*read.content);
    reason_ = read.reason;
  }

  const std::string file_ = MICROINJECTION_SOURCE_DIR "/config/families/" + std::string(GetParam()) + ".yaml";
  const Family family_ = Family::load(file_);
  FamilyData data_{family_};
  std::string reason_;
};

TEST_P(ShippedFamily, SaysWhereItsDataAreFrom) {
  ASSERT_EQ(reason_, "");
  for (const char* part : {"made by: prepare --family ", "version: ", "date: ", "force error of each member"}) {
    EXPECT_NE(data_.provenance().find(part), std::string::npos) << part;
  }
}

/// Largest relative difference of a member's forces from those of an equilibrium each.
double largestError(const SurrogateData& cell, const std::vector<TrainingSample>& solved) {
  double largest = 0;
  for (const TrainingSample& sample : solved) {
    ForceField::Local local;
    cell.field.makeLocal(sample.angle, local);
    Eigen::Matrix3d jacobian;
    const Eigen::Vector3d force = local.evaluate(sample.displacement, jacobian);
    largest = std::max(largest, (force - sample.force).norm() / sample.force.norm());
  }
  return largest;
}

/// Members drawn at random, solved again: the section on the axis, which is quick and exact.
TEST_P(ShippedFamily, MembersHaveTheForceOfTheirSectionOnTheAxis) {
  ASSERT_EQ(reason_, "");
  std::mt19937 random(20261124);
  for (int draw = 0; draw < 3; ++draw) {
    const FamilyMember& drawn = data_.members()[random() % data_.members().size()];
    const SurrogateData cell = data_.cell(drawn.coordinates);
    const std::vector<double> depths = {0.3 * cell.range.depth, 0.7 * cell.range.depth, cell.range.depth};
    const std::vector<TrainingSample> solved = solveAxis(family_.member(drawn.coordinates), depths);
    ASSERT_EQ(solved.size(), depths.size());
    EXPECT_LT(largestError(cell, solved), 0.02) << drawn.coordinates.transpose();
  }
}

/// A path beside the axis, on the coarse mesh, whose force is a few percent off the converged one.
TEST_P(ShippedFamily, AMemberHasTheForceOfItsPathBesideTheAxis) {
  ASSERT_EQ(reason_, "");
  std::mt19937 random(20261125);
  const FamilyMember& drawn = data_.members()[random() % data_.members().size()];
  const SurrogateData cell = data_.cell(drawn.coordinates);
  const Eigen::Vector3d target(0.5 * cell.range.lateral, 0, -0.8 * cell.range.depth);
  const TrainingResult solved = solveRay(family_.member(drawn.coordinates), {0.7, target, 2, kCoarseLevel});
  ASSERT_EQ(solved.samples.size(), 2u) << solved.reason;
  EXPECT_LT(largestError(cell, solved.samples), 0.1) << drawn.coordinates.transpose();
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Of which there are converged places.
class ReferencedFamily : public ShippedFamily {};

/// Members that were never solved for, at places whose converged force is known (test/reference/README.md). The bounds
/// are a little above what was measured: doc/reference/benchmarks.md.
TEST_P(ReferencedFamily, HasTheConvergedForcesOfMembersThatItHasNot) {
  ASSERT_EQ(reason_, "");
  const std::string reference = MICROINJECTION_SOURCE_DIR "/test/reference/family_" + family_.name() + ".csv";
  std::vector<double> forces, surfaces;
  for (const CheckedPlace& place : comparePlaces(data_, readReferences(family_, 1, reference))) {
    surfaces.push_back(place.surface_error);
    if (place.force_share > 0.02) forces.push_back(place.force_error);
  }
  ASSERT_GE(forces.size(), 200u) << reference;
  const bool zona = family_.name() == "zona";
  EXPECT_LT(quantile(forces, 0.5), 0.007);
  EXPECT_LT(quantile(forces, 0.9), 0.016);
  EXPECT_LT(quantile(forces, 1), zona ? 0.04 : 0.045);
  EXPECT_LT(quantile(surfaces, 1), 0.01);
}

/// Scenes of config/cells whose force is right without a preparation.
class ServedScene : public testing::TestWithParam<const char*> {};

TEST_P(ServedScene, IsInAFamily) {
  const Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/" + std::string(GetParam()) + ".yaml");
  std::string reason;
  const auto cell = findFamilyCell(MICROINJECTION_SOURCE_DIR "/config/families", scene, reason);
  ASSERT_TRUE(cell) << reason;
  EXPECT_LT(cell->data->common_error, 0.05) << cell->description;
}

INSTANTIATE_TEST_SUITE_P(All, ServedScene,
                         testing::Values("mouse_oocyte_pipette", "mouse_oocyte_injection", "mouse_oocyte_zona",
                                         "mouse_oocyte_gv", "mouse_oocyte_mii", "mouse_zygote", "human_oocyte",
                                         "porcine_oocyte", "zebrafish_embryo"));
INSTANTIATE_TEST_SUITE_P(All, ShippedFamily, testing::Values("homogeneous", "zona"));
INSTANTIATE_TEST_SUITE_P(All, ReferencedFamily, testing::Values("homogeneous", "zona"));

}  // namespace
}  // namespace microinjection
