#include "cell/family/family_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <sstream>

#include "cell/family/axis_force.h"
#include "cell/family/made_up_family.h"
#include "cell/surrogate/cached_cell.h"

namespace microinjection {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class FamilyOfSprings : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  void add(const Eigen::VectorXd& x) {
    const MadeUp made(x);
    data_.add(made.member, made.surface);
  }

  FamilyData data_ = familyOfSprings();
  const std::string path_ = testing::TempDir() + "microinjection_family.data";
};

TEST_F(FamilyOfSprings, AMemberBetweenTheSolvedOnesHasTheirForm) {
  const Eigen::Vector3d x(0.4, -0.3, 0.6);
  const MadeUp truth(x);
  const SurrogateData cell = data_.cell(x);
  const Eigen::VectorXd expected = truth.member.scale * truth.member.energy;
  EXPECT_NEAR(cell.energy.coefficients()[0], expected[0], 0.005 * expected[0]);
  const Eigen::Index at = truth.member.field.size() - 40;
  EXPECT_NEAR(cell.field.coefficients()[at], truth.member.scale * truth.member.field[at], 0.005 * expected[0]);
  Eigen::VectorXd rest, moved;
  const Eigen::Vector3d u(0, 0, -0.5 * cell.range.depth);
  cell.surface.evaluate(0.3, u, rest, moved);
  const double motion = 0.5 * (1 + 0.1 * x[0]);
  EXPECT_NEAR(moved.tail(1)[0], motion, 0.01 * motion);
}

TEST_F(FamilyOfSprings, ASolvedMemberIsReturnedAsItIs) {
  const Eigen::Vector3d x(1, -1, -1);
  const MadeUp truth(x);
  const SurrogateData cell = data_.cell(x);
  EXPECT_NEAR(cell.energy.coefficients()[0], truth.member.scale * truth.member.energy[0], 2e-3 * truth.member.scale);
  EXPECT_NEAR(cell.range.depth, data_.family().range(data_.family().member(x)).depth, 1e-12);
}

TEST_F(FamilyOfSprings, TheErrorsAreThoseOfFitAndPrediction) {
  EXPECT_LT(data_.leaveOneOutError().common, 0.1);
  const ExpectedError at_member = data_.expectedError(Eigen::Vector3d(1, 1, 1));
  const ExpectedError between = data_.expectedError(Eigen::Vector3d(0.5, 0.5, 0));
  EXPECT_GE(at_member.common, 0.008);
  EXPECT_GT(between.common, at_member.common);
  EXPECT_LE(between.median, between.common);
  EXPECT_EQ(data_.cell(Eigen::Vector3d(0.5, 0.5, 0)).common_error, between.common);
}

TEST_F(FamilyOfSprings, MeasuredErrorsAreExpectedUntilThereIsAnotherMember) {
  const Eigen::Vector3d compared(0.3, 0.2, -0.4), far(0.5, -0.5, 0);
  data_.setMeasuredError({0.004, 0.015}, {compared});
  EXPECT_EQ(data_.expectedError(compared).median, 0.004);
  EXPECT_EQ(data_.expectedError(compared).common, 0.015);
  EXPECT_EQ(data_.expectedError(Eigen::Vector3d(1, 1, 1)).common, 0.015);  // a member: no less
  EXPECT_GT(data_.expectedError(far).common, 0.015);
  data_.save(path_);
  const auto read = FamilyData::load(homogeneous(), path_);
  ASSERT_TRUE(read) << read.reason;
  EXPECT_EQ(read.content->measuredError().members, 1);
  EXPECT_EQ(read.content->expectedError(far).common, data_.expectedError(far).common);
  data_.update();
  EXPECT_EQ(data_.measuredError().members, 0);
  EXPECT_NE(data_.expectedError(compared).median, 0.004);
}

TEST_F(FamilyOfSprings, KnownForcesOnTheAxisAreTheSizeOfTheForce) {
  const ChebyshevGrid grid = axisForceGrid(data_.family());
  Eigen::VectorXd forces(grid.size());
  for (int i = 0; i < grid.size(); ++i) forces[i] = std::exp(0.5 + 0.3 * grid.node(i)[0] - 0.2 * grid.node(i)[2]);
  const Eigen::Vector3d x(0.4, -0.3, 0.6);
  const double before = data_.cell(x).energy.coefficients()[0];
  data_.setAxisForces(forces);
  data_.update();
  data_.save(path_);
  const auto read = FamilyData::load(homogeneous(), path_);
  ASSERT_TRUE(read) << read.reason;
  const double predicted = std::exp(0.7 * x[0] - 0.2 * x[1]), known = std::exp(0.5 + 0.3 * x[0] - 0.2 * x[2]);
  for (const FamilyData* data : std::initializer_list<const FamilyData*>{&data_, &*read.content}) {
    EXPECT_NEAR(data->cell(x).energy.coefficients()[0] / before, known / predicted, 0.005 * known / predicted);
  }
}

TEST_F(FamilyOfSprings, KnownCurvesOnTheAxisAreTheForceThere) {
  const ChebyshevGrid grid = axisForceGrid(data_.family());
  // A spring that becomes stiffer with the depth, the more so the thicker the tip.
  const auto curve = [](const Eigen::VectorXd& x, double s) {
    return std::exp(0.5 + 0.3 * x[0]) * s * s * (1 + (0.2 + 0.1 * x[0]) * s * s);
  };
  Eigen::MatrixXd forces(grid.size(), kAxisDepths);
  for (int i = 0; i < grid.size(); ++i) {
    for (int k = 0; k < kAxisDepths; ++k) forces(i, k) = curve(grid.node(i), (k + 1.0) / kAxisDepths);
  }
  FamilyData data(homogeneous());
  for (FamilyMember member : data_.members()) {
    // The springs of the others resist sideways only; on the axis these have a force in proportion to the depth.
    member.field.setZero();
    member.field[member.field.size() - EnergyExpansion(EnergyScales(), {4, 4, 7, 1}).size()] = 1;
    data.add(member, MadeUp(member.coordinates).surface);
  }
  data.setAxisForces(forces);
  data.update();
  data.save(path_);
  const auto read = FamilyData::load(homogeneous(), path_);
  ASSERT_TRUE(read) << read.reason;
  EXPECT_TRUE(read.content->hasAxisCurves());
  const Eigen::Vector3d x(0.4, -0.3, 0.6);
  for (const FamilyData* known : std::initializer_list<const FamilyData*>{&data, &*read.content}) {
    const SurrogateData cell = known->cell(x);
    ForceField::Local local;
    cell.field.makeLocal(0, local);
    const double length = cell.range.axis_depth, unit = cell.energy.scales().energy / cell.energy.scales().length;
    Eigen::Matrix3d jacobian;
    for (const double s : {0.2, 0.5, 0.9}) {
      const Eigen::Vector3d force = local.evaluate({0, 0, -s * s * length}, jacobian);
      EXPECT_NEAR(force.norm() / unit, curve(x, s), 0.01 * curve(x, s)) << s;
    }
  }
}

TEST_F(FamilyOfSprings, TheRangeIsWhatTheMembersAroundReached) {
  const Eigen::Vector3d at(0.9, 0.9, 0.1);
  MadeUp shallow(at);
  shallow.member.reached.share = 0.6;
  data_.add(shallow.member, shallow.surface);
  data_.update();
  const auto depthOver = [&](const Eigen::Vector3d& x) {
    return data_.cell(x).range.depth / data_.family().range(data_.family().member(x)).depth;
  };
  EXPECT_NEAR(depthOver(at), 0.6, 1e-6);
  EXPECT_NEAR(depthOver(Eigen::Vector3d(0.85, 0.95, 0.05)), 0.6, 1e-3);
  EXPECT_LT(depthOver(Eigen::Vector3d(0.6, 0.6, 0.1)), 0.95);
  EXPECT_NEAR(depthOver(Eigen::Vector3d(-1, -1, -1)), 1, 1e-6);
}

TEST_F(FamilyOfSprings, AroundAMemberWithoutSolutionNothingIsServed) {
  const Eigen::Vector3d bad(0.5, 0.5, 0.25);
  EXPECT_TRUE(data_.serves(bad));
  data_.addFailed(bad);
  EXPECT_FALSE(data_.serves(bad));
  EXPECT_FALSE(data_.serves(bad + Eigen::Vector3d::Constant(0.05)));
  EXPECT_TRUE(data_.serves(Eigen::Vector3d(-1, -1, -1)));
  EXPECT_FALSE(data_.serves(Eigen::Vector3d(1.01, 0, 0))) << "past the border";
}

TEST_F(FamilyOfSprings, WhereTheErrorIsExpectedToBeLargeNothingIsServed) {
  FamilyData coarse(homogeneous());
  for (const FamilyMember& member : data_.members()) {
    MadeUp made(member.coordinates);
    made.member.common_error = 0.11;
    coarse.add(made.member, made.surface);
  }
  coarse.update();
  const Eigen::Vector3d x(0.3, 0.5, 0);
  EXPECT_TRUE(data_.serves(x));
  EXPECT_GT(coarse.expectedError(x).common, 0.1);
  EXPECT_FALSE(coarse.serves(x));
}

TEST_F(FamilyOfSprings, IsReadAsItWasWritten) {
  data_.addFailed(Eigen::Vector3d(0.5, 0.5, 0.25));
  data_.save(path_);
  const auto read = FamilyData::load(homogeneous(), path_);
  ASSERT_TRUE(read) << read.reason;
  EXPECT_EQ(read.content->members().size(), data_.members().size());
  EXPECT_EQ(read.content->failed().size(), 1u);
  EXPECT_EQ(read.content->provenance(), "made up");
  const Eigen::Vector3d x(0.2, 0.1, -0.7);
  const SurrogateData before = data_.cell(x), after = read.content->cell(x);
  EXPECT_EQ(before.energy.coefficients(), after.energy.coefficients());
  EXPECT_EQ(before.field.coefficients(), after.field.coefficients());
  EXPECT_EQ(before.common_error, after.common_error);
}

/// A member is solved (a spring on every path), stored, read, and fitted anew: nothing must change.
TEST_F(FamilyOfSprings, FittingAnewNeedsNoNewSolutions) {
  const Family family = homogeneous();
  const Eigen::Vector3d x(1, -1, 1);
  const SurrogatePlan plan = planMember(family, family.member(x));
  std::vector<TrainingResult> results;
  for (const TrainingRay& ray : plan.rays) {
    TrainingResult result;
    for (int k = 0; k < ray.points; ++k) {
      const Eigen::Vector3d u = ray.at(k);
      result.samples.push_back({ray.angle, u, -2 * u, {}});
    }
    results.push_back(std::move(result));
  }
  results.back().samples.pop_back();
  results.back().reason = "ended";
  MadeUp made(x);
  made.member.paths = pathForces(results);
  FamilyData data(family);
  data.add(made.member, made.surface);
  data.update();
  EXPECT_EQ(data.refit(), 1);
  const FamilyMember once = data.members().front();
  EXPECT_LT(once.reached.share, 1);
  EXPECT_GT((once.field - made.member.field).norm(), 0.1 * made.member.field.norm());
  data.save(path_);
  auto read = FamilyData::load(family, path_);
  ASSERT_TRUE(read) << read.reason;
  EXPECT_EQ(read.content->refit(), 1);
  const FamilyMember& again = read.content->members().front();
  EXPECT_EQ(again.field, once.field);
  EXPECT_EQ(again.energy, once.energy);
  data_.setMeasuredError({0.004, 0.015}, {x});
  EXPECT_EQ(data_.refit(), 0) << "the paths of made-up members are not known";
  EXPECT_EQ(data_.measuredError().members, 1) << "nothing changed";
}

TEST_F(FamilyOfSprings, DataOfAnotherFamilyAreNotRead) {
  data_.save(path_);
  const Family zona = Family::load(MICROINJECTION_SOURCE_DIR "/config/families/zona.yaml");
  EXPECT_EQ(FamilyData::load(zona, path_).state, CacheState::kOther);
}

TEST_F(FamilyOfSprings, ATornFileOrAChangedByteIsDamaged) {
  data_.save(path_);
  std::ostringstream text;
  text << std::ifstream(path_, std::ios::binary).rdbuf();
  const std::string whole = text.str();
  const auto stateOf = [&](const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return FamilyData::load(homogeneous(), path_).state;
  };
  for (const double share : {0.3, 0.9, 0.9999}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    EXPECT_EQ(stateOf(whole.substr(0, length)), CacheState::kDamaged) << share;
  }
  std::string changed = whole;
  changed[whole.size() / 2] ^= 1;
  EXPECT_EQ(stateOf(changed), CacheState::kDamaged);
}

/// What no checksum can tell.
TEST_F(FamilyOfSprings, ValuesThatCannotBeAreDamagedWhateverTheChecksum) {
  const std::size_t lengths = sizeof(std::uint64_t) + std::string("made up").size();
  const std::size_t numbers = lengths + sizeof(std::uint64_t) + 3 * sizeof(double);
  const std::size_t axis = numbers + 5 * sizeof(double), failed = axis + sizeof(std::uint64_t);
  const std::size_t members = failed + sizeof(std::uint64_t);
  constexpr std::size_t measured = sizeof(std::int32_t) + 3 * sizeof(double);
  const std::vector<std::pair<const char*, std::function<void(std::string&)>>> changes = {
      {"short", [](std::string& body) { body.pop_back(); }},
      {"long", [](std::string& body) { body += 'x'; }},
      {"length", [=](std::string& body) { overwrite(body, lengths + sizeof(std::uint64_t), -1.0); }},
      {"error", [=](std::string& body) { overwrite(body, numbers + sizeof(double), kNan); }},
      {"axis", [=](std::string& body) { overwrite<std::uint64_t>(body, axis, 1); }},
      {"failed", [=](std::string& body) { overwrite<std::uint64_t>(body, failed, ~std::uint64_t{0}); }},
      {"no member", [=](std::string& body) { overwrite<std::uint64_t>(body, members, 0); }},
      {"paths",
       [](std::string& body) { overwrite(body, body.size() - measured - sizeof(std::uint64_t), ~std::uint64_t{0}); }},
      {"measured error", [](std::string& body) { overwrite(body, body.size() - sizeof(double), kNan); }}};
  for (const auto& [what, change] : changes) {
    data_.save(path_);
    changeBody(path_, change);
    const auto read = FamilyData::load(homogeneous(), path_);
    EXPECT_EQ(read.state, CacheState::kDamaged) << what << ": " << read.reason;
  }
}

}  // namespace
}  // namespace microinjection
