// Families whose members are curves of the section: tongues, forces on the axis, branches of pierced cells.
#include "cell/family/section_family.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <string>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "cell/family/axis_force_ratio.h"
#include "cell/family/family_cell.h"
#include "cell/family/pierced_family.h"
#include "cell/family/tongue_family.h"
#include "cell/family/tongue_member.h"
#include "cell/model/cell_problem.h"
#include "cell/model/converged_tongue.h"
#include "cell/model/scene_mesh.h"
#include "cell/model/solved_branch.h"

namespace microinjection {
namespace {

const std::string kFamilies = MICROINJECTION_SOURCE_DIR "/config/families";

Scene mouseHeld() { return loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_held.yaml"); }

/// The reason of a ConfigError; empty without one.
template <typename Call>
std::string reasonOf(const Call& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class ShippedTongues : public testing::Test {
 protected:
  static const TongueFamily& family() {
    static const TongueFamily shipped = TongueFamily::load(kFamilies + "/tongues/homogeneous.yaml");
    return shipped;
  }
};

TEST_F(ShippedTongues, RefuseWhatIsOutsideWithTheRatioItsValueAndWhatIsAllowed) {
  Scene wide = mouseHeld();
  wide.holding_pipette.mouth->inner_radius = 0.6 * wide.radius();
  EXPECT_TRUE(says(reasonOf([&] { family().tongue(wide); }), "bore_radius = 0.6: must be from 0.02 to 0.5"));
  Scene sticky = mouseHeld(), layered = mouseHeld(), glued = mouseHeld().glued();
  sticky.holding_pipette.mouth->contact.mode = "sticking";
  layered.cell.layers.push_back(layered.cell.layers[0]);
  layered.cell.layers[1].outer_radius *= 0.8;
  EXPECT_TRUE(says(reasonOf([&] { family().tongue(sticky); }), "of another kind"));
  EXPECT_TRUE(says(reasonOf([&] { family().tongue(layered); }), "layers: 2, not 1"));
  EXPECT_TRUE(says(reasonOf([&] { family().tongue(glued); }), "has no mouth"));
}

/// Thicker than the family has: the cell does not touch the outside of the wall.
TEST_F(ShippedTongues, ServeAThickerWall) {
  Scene thick = mouseHeld(), thicker = mouseHeld();
  Scene::Mouth& mouth = *thick.holding_pipette.mouth;
  mouth.outer_radius = mouth.inner_radius + 12 * mouth.edge_radius;
  thicker.holding_pipette.mouth->outer_radius = 2 * mouth.outer_radius;
  const double length = family().tongue(thick).at(0.1).length;
  EXPECT_NEAR(family().tongue(thicker).at(0.1).length, length, 1e-9 * length);
}

/// Of the family that has the scene.
void expectTongues(const Scene& scene, const std::vector<double>& suctions) {
  std::string reason;
  const auto tongue = findFamilyTongue(kFamilies, scene, reason);
  ASSERT_TRUE(tongue) << reason;
  const std::vector<double> solved = tongueCurve(scene, suctions, 0);
  ASSERT_EQ(solved.size(), suctions.size());
  for (std::size_t i = 0; i < suctions.size(); ++i) {
    const DrawnTongue at = tongue->at(suctions[i]);
    EXPECT_LT(at.expected_error, 0.05);
    EXPECT_NEAR(at.length, solved[i], at.expected_error * solved[i]) << suctions[i];
  }
}

TEST_F(ShippedTongues, HaveTheLengthsOfASolutionWithinTheToldError) {
  expectTongues(mouseHeld(), {0, 0.02, 0.1, 0.25});
}

TEST_F(ShippedTongues, HaveThoseOfACellWithAZona) {
  expectTongues(loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/human_oocyte_held.yaml"), {0, 0.02, 0.1, 0.25});
}

TEST_F(ShippedTongues, HaveTheSurfaceAndTheVolumeOfASolution) {
  const Scene scene = mouseHeld();
  const FamilyTongue tongue = family().tongue(scene);
  CellProblem<2> problem(scene, makeSceneMesh<2>(scene, 0), ElementKind::kP2P1);
  const double modulus = scene.cell.material().young_modulus, radius = scene.radius();
  ASSERT_TRUE(problem.hold(-0.15 * modulus).converged);
  const HeldCell held = problem.held();
  const DrawnTongue at = tongue.at(0.15);
  EXPECT_NEAR(at.volume, held.tongue_volume / std::pow(radius, 3), 0.03 * at.volume);
  EXPECT_NEAR(at.seal_radius, held.seal_radius / radius, 0.06 * at.seal_radius);
  EXPECT_NEAR(at.clamping_force, held.clamping_force / (modulus * radius * radius), 0.12 * at.clamping_force);
  const Eigen::Matrix2Xd surface = radius * tongue.outline(0.15);
  EXPECT_NEAR(surface(0, 0), 0, 1e-3 * radius);
  for (Eigen::Index i = 0; i < surface.cols(); ++i) {
    double nearest = radius;
    for (Eigen::Index k = 0; k < held.outline.cols(); ++k)
      nearest = std::min(nearest, (held.outline.col(k) - surface.col(i)).norm());
    EXPECT_LT(nearest, 0.04 * radius) << surface.col(i).transpose() /
                                             radius;  // the outline's points are that far apart
  }
}

TEST_F(ShippedTongues, GrowWithTheSuctionByTheToldSlopes) {
  for (const double bore : {0.021, 0.1, 0.3, 0.49}) {
    Scene scene = mouseHeld();
    Scene::Mouth& mouth = *scene.holding_pipette.mouth;
    mouth.inner_radius = bore * scene.radius();
    mouth.edge_radius = 0.2 * mouth.inner_radius;
    mouth.outer_radius = mouth.inner_radius + 6 * mouth.edge_radius;
    const FamilyTongue tongue = family().tongue(scene);
    EXPECT_GT(tongue.strongest(), 0.2);
    EXPECT_GT(tongue.end(), tongue.strongest());
    DrawnTongue before;
    for (const double share : {0.0, 0.001, 0.01, 0.1, 0.4, 0.8, 0.99}) {
      const double suction = share * tongue.strongest(), step = 1e-4 * suction;
      const DrawnTongue at = tongue.at(suction), next = tongue.at(suction + step), last = tongue.at(suction - step);
      EXPECT_FALSE(at.length <= before.length) << bore << ' ' << share;
      EXPECT_FALSE(at.volume <= before.volume) << bore << ' ' << share;
      const double slope = (next.length - last.length) / (2 * step), opening = (next.volume - last.volume) / (2 * step);
      if (share > 0) EXPECT_NEAR(at.length_slope, slope, 1e-4 * slope) << bore << ' ' << share;
      if (share > 0) EXPECT_NEAR(at.volume_slope, opening, 1e-4 * opening) << bore << ' ' << share;
      before = at;
    }
  }
}

TEST_F(ShippedTongues, EndWhereTheyAreNotKnown) {
  const FamilyTongue tongue = family().tongue(mouseHeld());
  EXPECT_TRUE(std::isfinite(tongue.at(tongue.strongest()).length));
  EXPECT_TRUE(std::isnan(tongue.at(1.001 * tongue.strongest()).length));
  EXPECT_TRUE(std::isnan(tongue.at(-0.001).length));
  EXPECT_TRUE(std::isnan(tongue.at(std::nan("")).length_slope));
}

/// A sphere of radius 1 above the plane of the crest, within the touch.
TEST(TongueTouch, IsThatOfASphereInTheMouth) {
  const TongueTouch touch(0.3, 0.06);
  const double plane = 1 - touch.length;
  EXPECT_NEAR(std::pow(plane + 0.06, 2) + std::pow(0.36, 2), std::pow(1.06, 2), 1e-12);
  double volume = 0;
  constexpr int kRings = 100000;
  for (int i = 0; i < kRings; ++i) {
    const double r = touch.radius * (i + 0.5) / kRings;
    volume += 2 * M_PI * r * (std::sqrt(1 - r * r) - plane) * touch.radius / kRings;
  }
  EXPECT_NEAR(touch.volume, volume, 1e-8);
}

/// Members whose logarithms are linear in the coordinates, which kriging's drift has exactly.
class MadeUpTongues : public testing::Test {
 protected:
  MadeUpTongues() {
    for (int i = 0; i < 16; ++i) {
      const Eigen::Vector4d x(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1, i & 8 ? 1 : -1);
      data_.add(member(x));
    }
    data_.update();
    data_.setProvenance("made up");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  static SectionMember member(const Eigen::Vector4d& x) {
    SectionMember made{x, Eigen::MatrixXd::Zero(TongueCurves::kNodes, TongueCurves::kColumns)};
    made.curves.col(TongueCurves::kLogLength).setConstant(0.2 * x[0] - 0.1 * x[1]);
    made.curves.col(TongueCurves::kLogEnd).setConstant(-1 + 0.1 * x[2]);
    made.curves.col(TongueCurves::kSeal).setConstant(1 + 0.05 * x[3]);
    made.curves.col(TongueCurves::kEnds).setConstant(1);
    return made;
  }

  SectionFamilyData data_{SectionFamily::load(kFamilies + "/tongues/homogeneous.yaml")};
  const std::string path_ = testing::TempDir() + "microinjection_tongues.data";
};

TEST_F(MadeUpTongues, HaveTheFormOfTheSolvedOnes) {
  const Eigen::Vector4d x(0.3, -0.6, 0.5, 0.2);
  const FamilyTongue tongue = TongueFamily(data_).tongue(x);
  const TongueTouch touch = touchOf(data_.family().member(x));
  const double suction = 0.1, growth = tongueGrowth(data_.family().member(x)),
               rise = touch.bore_radius * suction * std::exp(0.2 * x[0] - 0.1 * x[1] + growth);
  EXPECT_NEAR(tongue.at(suction).length, touch.length + rise, 1e-4 * rise);
  EXPECT_NEAR(tongue.end(), std::exp(-1 + 0.1 * x[2]), 1e-4);
  EXPECT_NEAR(tongue.at(suction).seal_radius, touch.radius * (1 + 0.05 * x[3]), 1e-4);
  EXPECT_TRUE(tongue.equilibriumEnds());
}

TEST_F(MadeUpTongues, AreKeptInAFile) {
  data_.save(path_);
  const auto read = SectionFamilyData::load(data_.family(), path_);
  ASSERT_TRUE(read) << read.reason;
  EXPECT_EQ(read.content->provenance(), "made up");
  const Eigen::Vector4d x(0.1, 0.2, 0.3, 0.4);
  EXPECT_NEAR(TongueFamily(*read.content).tongue(x).at(0.2).length, TongueFamily(data_).tongue(x).at(0.2).length, 1e-6);
}

TEST_F(MadeUpTongues, AFileThatIsMissingCutOrOfAnotherFamilyIsNotUsed) {
  EXPECT_EQ(SectionFamilyData::load(data_.family(), path_).state, CacheState::kMissing);
  data_.save(path_);
  const SectionFamily other = SectionFamily::load(kFamilies + "/tongues/zona.yaml");
  EXPECT_EQ(SectionFamilyData::load(other, path_).state, CacheState::kOther);
  std::ifstream file(path_, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  writeFileAtomically(path_, bytes.substr(0, bytes.size() - 100));
  EXPECT_EQ(SectionFamilyData::load(data_.family(), path_).state, CacheState::kDamaged);
  const std::string version = " data 1 checksum";
  ASSERT_NE(bytes.find(version), std::string::npos);
  writeFileAtomically(path_, bytes.replace(bytes.find(version), version.size(), " data 0 checksum"));
  EXPECT_EQ(SectionFamilyData::load(data_.family(), path_).state, CacheState::kOther);
}

TEST_F(MadeUpTongues, TooFewMembersServeNothing) {
  SectionFamilyData few(data_.family());
  for (int i = 0; i < 8; ++i) few.add(data_.members()[i]);
  few.update();
  const std::string reason = reasonOf([&] { TongueFamily(few).tongue(Eigen::VectorXd::Zero(4)); });
  EXPECT_TRUE(says(reason, "has only 8 members")) << reason;
}

TEST_F(MadeUpTongues, ServeNothingNearAMemberWithoutSolution) {
  data_.addFailed(Eigen::Vector4d(1, 1, 1, 0));
  const TongueFamily family(data_);
  EXPECT_TRUE(says(reasonOf([&] { family.tongue(Eigen::Vector4d(1, 1, 1, 0.2)); }), "has no solution"));
  EXPECT_EQ(reasonOf([&] { family.tongue(Eigen::Vector4d(1, 1, 1, 0.9)); }), "");
}

TEST(AxisForceRatio, IsTheRatioOfTwoSolutions) {
  Scene scene = mouseHeld();
  scene.needle.tip.radius = 0.12 * scene.radius();
  std::string reason;
  const auto held = findHeldForce(kFamilies, scene, reason);
  ASSERT_TRUE(held) << reason;
  const Scene glued = scene.glued();
  CellProblem<2> own(scene, makeSceneMesh<2>(scene, 0), ElementKind::kP2P0);
  CellProblem<2> other(glued, makeSceneMesh<2>(glued, 0), ElementKind::kP2P0);
  for (const double depth : {0.1, 0.4}) {
    const Eigen::Vector3d tip(0, 0, -depth * scene.radius());
    const double ratio = own.solve(tip).force.z() / other.solve(tip).force.z();
    EXPECT_NEAR(held->ratio(depth), ratio, held->error() + 0.002) << depth;
  }
  EXPECT_LT(held->error(), 0.03);
}

Scene rubbed(double friction) {
  Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml");
  scene.needle.contact = {"sliding", friction};
  return scene;
}

TEST(AxisForceRatio, IsThatOfATipThatRubs) {
  const Scene scene = rubbed(0.15);
  std::string reason;
  const auto ratio = findFrictionForce(kFamilies, scene, reason);
  ASSERT_TRUE(ratio) << reason;
  CellProblem<2> own(scene, makeSceneMesh<2>(scene, 0), ElementKind::kP2P0);
  const Scene sticking = stuck(scene);
  CellProblem<2> other(sticking, makeSceneMesh<2>(sticking, 0), ElementKind::kP2P0);
  for (const double depth : {0.1, 0.5}) {  // a quarter of the diameter
    const Eigen::Vector3d tip(0, 0, -depth * scene.radius());
    EXPECT_NEAR(ratio->ratio(depth), own.solve(tip).force.z() / other.solve(tip).force.z(), ratio->error()) << depth;
  }
  EXPECT_LT(ratio->error(), 0.02);
  EXPECT_NEAR(findFrictionForce(kFamilies, rubbed(3), reason)->ratio(0.5), 1, 0.01);
  EXPECT_FALSE(findFrictionForce(kFamilies, rubbed(0.05), reason));
  EXPECT_TRUE(says(reason, "friction = 0.05: must be from 0.1 to 0.5")) << reason;
}

/// Of a cell that no member is.
TEST(FamilyBranch, IsThatOfASolution) {
  Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml");
  scene.cell.puncture.layers.front().toughness *= 0.75;
  scene.needle.tip.radius *= 1.07;
  std::string reason;
  const auto found = findFamilyBranch(kFamilies, scene, reason);
  ASSERT_TRUE(found) << reason;
  const PiercedBranch solved = solvePiercedBranch(scene), &own = found->branch;
  ASSERT_TRUE(solved.onset() && own.onset());
  EXPECT_NEAR(own.onset()->depth, solved.onset()->depth, 0.05 * solved.onset()->depth);
  double ours = own.onset()->length, theirs = solved.onset()->length;
  for (double beyond = 1e-6; beyond < 10e-6; beyond += 1e-6) {
    const double depth = solved.onset()->depth + beyond,
                 force = solved.at(depth, theirs = solved.grown(depth, theirs)).force;
    EXPECT_NEAR(own.at(depth, ours = own.grown(depth, ours)).force, force, 0.05 * force) << beyond;
  }
  for (const double depth : {2e-6, 4e-6})
    EXPECT_NEAR(own.whole(depth).force, solved.whole(depth).force, 0.05 * solved.whole(depth).force);
  EXPECT_LT(found->pierced_error, 0.05);
}

/// Holes longer than the family's are continued: no step there, and the force stays that of a long hole.
TEST(FamilyBranch, GoesOnBeyondItsBorderInTheMiddleOfAPenetration) {
  const Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml");
  std::string reason;
  const PiercedBranch branch = findFamilyBranch(kFamilies, scene, reason).value().branch;
  const double tip = scene.needle.tip.radius, steady = steadyPenetration(scene).force_in * tip * tip;
  double length = branch.onset()->length, last = branch.onset()->pierced_force, jump = 0, furthest = 0;
  for (double depth = branch.onset()->depth; length < 9 * tip; depth += tip / 40) {
    length = branch.grown(depth, length);
    const double force = branch.at(depth, length).force;
    if (length > 5 * tip) {
      jump = std::max(jump, std::abs(force - last));
      furthest = std::max(furthest, std::abs(force / steady - 1));
    }
    last = force;
  }
  EXPECT_LT(jump, 0.01 * steady);
  EXPECT_LT(furthest, 0.05);
}

/// The reason for which a shipped family file is refused once a line of it is another one.
std::string refusalOf(const std::string& file, const std::string& line, const std::string& other) {
  std::ifstream shipped(kFamilies + file);
  std::string text(std::istreambuf_iterator<char>(shipped), {});
  const std::size_t at = text.find(line);
  EXPECT_NE(at, std::string::npos) << line;
  text.replace(at, line.size(), other);
  const std::string path = testing::TempDir() + "microinjection_section.yaml";
  writeFileAtomically(path, text);
  const std::string reason = reasonOf([&] { SectionFamily::load(path); });
  std::filesystem::remove(path);
  return reason;
}

TEST(SectionFamily, RefusesAFileThatDoesNotNameWhatItsKindNeeds) {
  const std::string pierced = "/pierced/homogeneous.yaml", friction = "/friction/homogeneous.yaml";
  EXPECT_TRUE(says(refusalOf(pierced, "  toughness: [0.3, 2] ", "  #"), "must name toughness"));
  EXPECT_TRUE(says(refusalOf(pierced, "  toughness: [0.3, 2] ", "  friction: [0.1, 1] "), "belongs to another kind"));
  EXPECT_TRUE(says(refusalOf(pierced, "puncture: {toughness: 0.036}", "puncture: {force: 1}"), "has no toughness"));
  EXPECT_TRUE(says(refusalOf(friction, "  friction: [0.1, 0.5] ", "  #"), "must name friction"));
  EXPECT_TRUE(says(refusalOf(friction, "friction: 0.2", "friction: 0"), "needle/contact/friction is 0"));
}

TEST(FamilyBranch, IsSolvedWhereTheFamilyHasNoOnset) {
  Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml");
  scene.cell.puncture.layers.front().barrier = 1e-9;
  std::string reason;
  EXPECT_FALSE(findFamilyBranch(kFamilies, scene, reason));
  EXPECT_TRUE(says(reason, "nothing pierces the cell to the depth that it has")) << reason;
}

TEST(FamilyBranch, RefusesWhatIsOutside) {
  Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml");
  std::string reason;
  scene.cell.puncture.layers.front().toughness *= 3;
  EXPECT_FALSE(findFamilyBranch(kFamilies, scene, reason));
  EXPECT_TRUE(says(reason, "toughness = ") && says(reason, "must be from 0.3 to 2")) << reason;
  scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml");
  scene.cell.puncture.layers.front().strength = 5e3;
  EXPECT_FALSE(findFamilyBranch(kFamilies, scene, reason));
  EXPECT_TRUE(says(reason, "cell/puncture has a strength")) << reason;
  scene.cell.puncture = PunctureConfig::atForce(1e-6);
  EXPECT_FALSE(findFamilyBranch(kFamilies, scene, reason));
  EXPECT_TRUE(says(reason, "cell/puncture has no toughness")) << reason;
}

TEST(AxisForceRatio, RefusesWhatIsOutside) {
  Scene scene = mouseHeld();
  scene.holding_pipette.mouth->pressure = -0.5 * scene.cell.material().young_modulus;
  std::string reason;
  EXPECT_FALSE(findHeldForce(kFamilies, scene, reason));
  EXPECT_TRUE(says(reason, "suction_root = 0.707")) << reason;
  EXPECT_FALSE(findHeldForce("/nowhere", scene, reason));
  EXPECT_TRUE(says(reason, "/nowhere/held has no family")) << reason;
}

TEST(AxisForceRatio, ScalesTheForceOnTheAxis) {
  const Eigen::VectorXd depths = axisRatioDepths();
  const AxisForceRatio held(0.1 * depths.cwiseSqrt(), 0.004);
  EXPECT_NEAR(held.ratio(0.3), std::exp(0.1 * std::sqrt(0.3)), 1e-6);
  EXPECT_EQ(held.ratio(2), held.ratio(0.6));
  std::string reason;
  const Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml");
  const auto cell = findFamilyCell(kFamilies, scene, reason);
  ASSERT_TRUE(cell) << reason;
  SurrogateData scaled = *cell->data;
  held.applyTo(scaled, scene.radius());
  ForceField::Local before, after;
  cell->data->field.makeLocal(0, before);
  scaled.field.makeLocal(0, after);
  Eigen::Matrix3d jacobian;
  for (const double depth : {0.05, 0.2, 0.5}) {
    const Eigen::Vector3d tip(0, 0, -depth * scene.radius());
    EXPECT_NEAR(after.evaluate(tip, jacobian).z() / before.evaluate(tip, jacobian).z(), held.ratio(depth), 0.002);
  }
}

}  // namespace
}  // namespace microinjection
