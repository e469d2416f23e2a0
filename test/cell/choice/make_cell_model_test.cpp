#include "cell/choice/make_cell_model.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "base/errors.h"
#include "cell/choice/model_choice.h"
#include "cell/family/axis_force_ratio.h"
#include "cell/family/made_up_family.h"
#include "cell/surrogate/cached_cell.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

/// With a cache of its own, in which nothing was prepared.
class ServeNeedle : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(cache_);
    setenv("XDG_CACHE_HOME", cache_.c_str(), 1);
  }
  void TearDown() override { fs::remove_all(cache_); }

  static std::string file(const Scene& scene) {
    return surrogateFile(scene, SurrogatePlan::plan(scene, SurrogateRange::standard(scene)));
  }

  static std::string refusal(const Scene& scene, const std::string& model) {
    try {
      makeCellModel(scene, model, {}, "a.yaml");
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const std::string cache_ = testing::TempDir() + "serve_needle_cache";
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(ServeNeedle, ACellPiercedByMechanicsIsSolvedOnceAndSaysSo) {
  Scene tough = pipette();
  tough.cell.layers[0].outer_radius = 12e-6;
  tough.holding_pipette.contact_radius = 6e-6;
  tough.cell.puncture = {};
  tough.cell.puncture.layers.emplace_back().toughness = 0.02;
  int told = 0;
  CellModelConfig config;
  config.tell = [&](const std::string& text) { told += has(text, "holes under the needle"); };
  const ChosenCellModel served = makeCellModel(tough, "live", config, "a.yaml");
  EXPECT_GE(told, 5);
  EXPECT_FALSE(served.change);
  EXPECT_EQ(served.cell->layers().size(), 1u);
  told = 0;
  makeCellModel(tough, "live", config, "a.yaml");
  EXPECT_EQ(told, 0) << "the paths are in the cache";
  tough.needle.tip = {"disc", 3e-6, 0};
  EXPECT_TRUE(has(refusal(tough, "live"), "cell/puncture/layers/0/toughness: needle/tip/shape must be hemisphere"));
}

/// A cell that suction holds is served as one that is glued where the lip touches it, and that is said.
TEST_F(ServeNeedle, AHeldCellIsServedAsGluedAndSaysHowFarThatIsOff) {
  Scene held = pipette();
  Scene::Mouth mouth;
  mouth.inner_radius = 10e-6;
  mouth.outer_radius = 40e-6;
  mouth.edge_radius = 2.5e-6;
  mouth.pressure = -2000;
  held.holding_pipette.mouth = mouth;
  const ChosenCellModel served = makeCellModel(held, "auto", {}, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.description, "suction holds the cell, which is served as glued to a ring of 11.4"))
      << served.description;
  EXPECT_TRUE(has(served.description, "up to 6 %")) << served.description;
  const ServingPlan plan = planServing(held, "live", "", "");
  EXPECT_FALSE(plan.scene->holding_pipette.mouth);
  EXPECT_NEAR(plan.scene->holding_pipette.contact_radius, 12.5e-6 * 28 / 30.5, 1e-12);
  EXPECT_EQ(planServing(pipette(), "live", "", "").glued_error, 0);
}

constexpr char kShipped[] = MICROINJECTION_SOURCE_DIR "/config/families";

Scene heldMouse() { return loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_held.yaml"); }

/// N, on the axis 8 um below the touch.
double forceOf(CellModel& cell, const Scene& scene) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double time = 0;
  for (double depth = -0.5e-6; depth < 8e-6; depth += 0.05e-6)
    cell.step({0, 0, scene.radius() - depth}, up, time += 1e-3);
  return cell.step({0, 0, scene.radius() - 8e-6}, up, time + 1e-3).force.z();
}

TEST_F(ServeNeedle, AHeldCellOfAFamilyHasTheForceOfTheHeldCellOnTheAxis) {
  Scene held = heldMouse();
  held.holding_pipette.mouth->pressure = -200;
  CellModelConfig config;
  config.families = kShipped;
  const ChosenCellModel served = makeCellModel(held, "surrogate", config, "a.yaml");
  const ChosenCellModel glued = makeCellModel(held.glued(), "surrogate", config, "a.yaml");
  EXPECT_TRUE(has(served.description, "on the axis its force is corrected by up to ")) << served.description;
  std::string reason;
  const auto ratio = findHeldForce(kShipped, held, reason);
  ASSERT_TRUE(ratio) << reason;
  const double expected = ratio->ratio(8e-6 / held.radius());
  EXPECT_LT(expected, 0.99);
  EXPECT_NEAR(forceOf(*served.cell, held) / forceOf(*glued.cell, held), expected, 0.002);
  Scene aside = held;
  aside.needle.offset.x() = 3e-6;
  const ServingPlan plan = planServing(aside, "surrogate", kShipped, "");
  EXPECT_TRUE(plan.held_family.empty());
  EXPECT_EQ(plan.glued_error, ratio->largestChange());
  EXPECT_LT(planServing(held, "surrogate", kShipped, "").glued_error, 0.03);
}

/// The suction over the modulus changes with the modulus, and so does what it changes of the force.
TEST_F(ServeNeedle, AHeldCellThatChangesStaysHeld) {
  Scene held = heldMouse();
  CellModelConfig config;
  config.families = kShipped;
  ChosenCellModel served = makeCellModel(held, "surrogate", config, "a.yaml");
  ASSERT_TRUE(served.change);
  served.change->change({{"young_modulus", 9e3}});
  held.cell.material().young_modulus = 9e3;
  const ChosenCellModel other = makeCellModel(held, "surrogate", config, "a.yaml");
  const double force = forceOf(*other.cell, held);
  EXPECT_NEAR(forceOf(*served.cell, held), force, 1e-3 * force);
  EXPECT_THROW(served.change->change({{"young_modulus", 3e3}}), ConfigError);  // too soft for its suction
}

TEST_F(ServeNeedle, AnUnpreparedRoundedTipIsLiveWithAWarning) {
  CellModelConfig config;
  config.live.fixed_period = true;
  const ChosenCellModel served = makeCellModel(pipette(), "auto", config, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.description, "not prepared; run: rosrun cell_microinjection prepare --scene a.yaml"))
      << served.description;
  EXPECT_TRUE(has(served.description, "live: P2-P0")) << served.description;
  EXPECT_TRUE(has(served.description, "too large")) << served.description;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (int i = 0; i < 200; ++i) served.cell->step({0, 0, 27.5e-6}, up, 1e-3 * i);
  const TipForce force = served.cell->step({0, 0, 27.5e-6}, up, 0.2);
  EXPECT_TRUE(force.valid) << served.cell->invalidReason();
  EXPECT_GT(force.force.z(), 0);
}

TEST_F(ServeNeedle, AnUnpreparedDiscIsLiveOnLinearTetrahedra) {
  Scene disc;
  disc.mesh.size = 20e-6;
  const ChosenCellModel served = makeCellModel(disc, "auto", {}, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.description, "live: P1 tetrahedra, whose force is too large")) << served.description;
}

TEST_F(ServeNeedle, PreparedRefusesWhatIsNot) {
  EXPECT_TRUE(has(refusal(pipette(), "surrogate"), "not prepared; run: rosrun")) << refusal(pipette(), "surrogate");
  Scene sticky = pipette();
  sticky.needle.contact.adhesion_energy = 1e-3;
  sticky.needle.contact.adhesion_range = 0.1e-6;
  EXPECT_TRUE(has(refusal(sticky, "surrogate"), "needle/contact/adhesion: must be left out"))
      << refusal(sticky, "surrogate");
}

/// An operator who reads "not prepared" would not look for a disk that fails.
TEST_F(ServeNeedle, DamagedDataAreNamedAndHowToMakeThemAnew) {
  Scene disc;
  disc.cell.material().model = "linear";
  disc.mesh.size = 20e-6;
  const std::string path = file(disc);
  smallCell(disc).save(disc, SurrogateRange::standard(disc), path);
  EXPECT_EQ(refusal(disc, "surrogate"), "");
  fs::resize_file(path, fs::file_size(path) - 1);
  const std::string damaged = "the surrogate data are damaged (" + path + ": is damaged: ";
  const std::string call = "run: rosrun cell_microinjection prepare --scene a.yaml";
  const std::string refused = refusal(disc, "surrogate");
  EXPECT_TRUE(has(refused, damaged) && has(refused, call)) << refused;
  const ChosenCellModel served = makeCellModel(disc, "auto", {}, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.description, damaged) && has(served.description, call)) << served.description;
  EXPECT_TRUE(has(served.description, "live: P1 tetrahedra")) << served.description;
}

TEST_F(ServeNeedle, WhatIsNoFileOrOfAnotherVersionIsNotCalledUnprepared) {
  const Scene scene = pipette();
  const std::string path = file(scene);
  writeCacheFile(path, "another version", "body");
  EXPECT_TRUE(has(refusal(scene, "surrogate"), path + ": was written by another version"))
      << refusal(scene, "surrogate");
  fs::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);  // nobody writes to it
  const std::string pipe = refusal(scene, "surrogate");
  EXPECT_TRUE(has(pipe, path + ": is not a regular file") && has(pipe, "remove it and run: rosrun")) << pipe;
  fs::remove(path);
  fs::create_symlink(path, path);
  const std::string loop = refusal(scene, "surrogate");
  EXPECT_TRUE(has(loop, path + ": cannot be read: ") && has(loop, "run: rosrun")) << loop;
}

TEST_F(ServeNeedle, DamagedFiguresOfTheLiveModelAreNamed) {
  const Scene scene = pipette();
  smallCell(scene).save(scene, SurrogateRange::standard(scene), file(scene));
  saveFigures(scene, {"live", std::numeric_limits<double>::quiet_NaN(), 1e-3});
  const ChosenCellModel served = makeCellModel(scene, "auto", {}, "a.yaml");
  EXPECT_TRUE(has(served.description, "figures of the live model: ") && has(served.description, "is damaged: "))
      << served.description;
}

TEST_F(ServeNeedle, LiveIsServedAsAskedFor) {
  const ChosenCellModel served = makeCellModel(pipette(), "live", {}, "a.yaml");
  EXPECT_TRUE(served.as_required);
  EXPECT_TRUE(has(served.description, "as asked for: P2-P0")) << served.description;
}

TEST_F(ServeNeedle, ATensegrityIsServedLiveWithoutAWarning) {
  const Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tensegrity.yaml");
  const ChosenCellModel served = makeCellModel(scene, "auto", {}, "a.yaml");
  EXPECT_TRUE(served.as_required);
  EXPECT_TRUE(has(served.description, "solved live: tensegrity of ")) << served.description;
  EXPECT_FALSE(served.cell->deformedSurface().members.empty());
  EXPECT_TRUE(has(refusal(scene, "surrogate"), "cell/model = tensegrity")) << refusal(scene, "surrogate");
}

/// What has a memory of its own, or rubs, is no surrogate cell.
TEST_F(ServeNeedle, WhatCannotBePreparedIsLive) {
  Scene viscous = pipette();
  viscous.cell.material().viscoelasticity.viscosity = 20;
  const ChosenCellModel served = makeCellModel(viscous, "auto", {}, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.description, "cannot be prepared (")) << served.description;
  EXPECT_TRUE(has(served.description, "so it is live: P2-P0")) << served.description;
}

/// Against the force of CellProblem on two meshes.
TEST_F(ServeNeedle, FrictionOnTheAxisIsServedByTheShippedFamilies) {
  Scene rubbing = pipette();
  rubbing.needle.contact = {"sliding", 0.1};
  CellModelConfig config;
  config.families = MICROINJECTION_SOURCE_DIR "/config/families";
  const ChosenCellModel served = makeCellModel(rubbing, "auto", config, "a.yaml");
  EXPECT_TRUE(served.as_required) << served.description;
  EXPECT_TRUE(has(served.description, "for a tip that rubs, with an error of")) << served.description;
  EXPECT_EQ(served.change, nullptr);
  served.cell->step({0, 0, rubbing.radius() + 1e-6}, Eigen::Vector3d::UnitZ(), 0);
  const double force = served.cell->step({0, 0, rubbing.radius() - 14e-6}, Eigen::Vector3d::UnitZ(), 1).force.z();
  EXPECT_NEAR(force, 1.183e-6, 0.02 * 1.183e-6);  // ./dev bench friction
  rubbing.needle.offset = {5e-6, 0};
  const ChosenCellModel beside = makeCellModel(rubbing, "auto", config, "a.yaml");
  EXPECT_TRUE(has(beside.description, "friction on the axis only")) << beside.description;
}

TEST_F(ServeNeedle, AdhesionIsServedByTheShippedFamilies) {
  Scene adhering = pipette();
  adhering.needle.contact = {"sliding", 0.2, 1e-3, 0.1e-6};
  CellModelConfig config;
  config.families = MICROINJECTION_SOURCE_DIR "/config/families";
  const ChosenCellModel served = makeCellModel(adhering, "auto", config, "a.yaml");
  EXPECT_TRUE(has(served.description, "on the way out it has less, with an error of")) << served.description;
  auto force = [&, time = 0.0](double depth) mutable {
    return served.cell->step({0, 0, adhering.radius() - depth}, Eigen::Vector3d::UnitZ(), time += 0.01).force.z();
  };
  for (const double depth : {-1e-6, 4e-6, 9e-6}) force(depth);
  EXPECT_NEAR(force(14e-6), 1.290e-6, 0.02 * 1.290e-6);  // ./dev bench friction
  double pull = 0;
  for (double depth = 14e-6; depth > -2e-6; depth -= 0.05e-6) pull = std::max(pull, -force(depth));
  EXPECT_NEAR(pull, 15.0e-9, 1e-9);  // ./dev bench friction
  EXPECT_TRUE(has(refusal(adhering, "live"), "needle/contact/adhesion: must be left out"));
  EXPECT_TRUE(has(refusal(adhering, "auto"), "needle/contact/adhesion: must be left out, or be of a cell"));
}

TEST_F(ServeNeedle, APiercedCellIsServedByTheShippedFamily) {
  const Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml");
  CellModelConfig config;
  config.families = MICROINJECTION_SOURCE_DIR "/config/families";
  config.tell = [](const std::string& text) { ADD_FAILURE() << text; };  // nothing is solved
  const ChosenCellModel served = makeCellModel(scene, "auto", config, "a.yaml");
  EXPECT_TRUE(has(served.description, "its branches are those of a family, with errors below")) << served.description;
  EXPECT_TRUE(has(served.description, "pierced at 0.41")) << served.description;
}

TEST_F(ServeNeedle, FrictionIsLiveUntilItIsPrepared) {
  Scene rubbing = pipette();
  rubbing.needle.contact = {"sliding", 0.2};
  const ChosenCellModel served = makeCellModel(rubbing, "auto", {}, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.description, "not prepared; run: rosrun")) << served.description;
  EXPECT_TRUE(has(served.description, "so it is live: P2-P0")) << served.description;
}

TEST_F(ServeNeedle, ExplicitDynamicsIsServedWithAWarningWhereItIsAskedForByName) {
  const Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_st_venant_kirchhoff.yaml");
  const ChosenCellModel served = makeCellModel(scene, "explicit", {}, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.description, "too large") && has(served.description, "mass times")) << served.description;
  EXPECT_TRUE(has(refusal(pipette(), "explicit"), "needle/tip/shape = ")) << refusal(pipette(), "explicit");
}

/// With a folder of families, in which a made-up one is.
class ServeMember : public ServeNeedle {
 protected:
  void SetUp() override {
    ServeNeedle::SetUp();
    fs::create_directories(families_);
    fs::copy_file(MICROINJECTION_SOURCE_DIR "/config/families/homogeneous.yaml", families_ + "/homogeneous.yaml");
    familyOfSprings().save(families_ + "/homogeneous.data");
    config_.families = families_;
  }

  /// A cell without requirements.
  static Scene inside() {
    Scene scene = pipette();
    scene.requirements = {};
    return scene;
  }

  const std::string families_ = cache_ + "/families";
  CellModelConfig config_;
};

TEST_F(ServeMember, ACellOfAFamilyIsServedWithoutPreparation) {
  Scene scene = inside();
  scene.cell.material().young_modulus = 15e3;
  const ChosenCellModel served = makeCellModel(scene, "surrogate", config_, "a.yaml");
  EXPECT_TRUE(has(served.description, "family homogeneous: tip_radius 0.107 of [0.04, 0.2], ")) << served.description;
  EXPECT_TRUE(has(served.description, "expected force error: median ")) << served.description;
  EXPECT_NE(served.change, nullptr);
}

TEST_F(ServeMember, TheBorderIsInsideAndTheCellPastItIsNot) {
  Scene scene = inside();
  for (const double factor : {1.0, 1 + 1e-9, 1.001}) {
    scene.needle.tip.radius = 0.2 * factor * scene.radius();
    const ChosenCellModel served = makeCellModel(scene, "auto", config_, "a.yaml");
    if (factor < 1.001) {
      EXPECT_TRUE(has(served.description, "family homogeneous: tip_radius 0.2 of")) << served.description;
    } else {
      EXPECT_TRUE(has(served.description, "outside of family homogeneous: tip_radius 0.2 of")) << served.description;
      EXPECT_TRUE(has(served.description, "live: P2-P0")) << served.description;
      EXPECT_EQ(served.change, nullptr);
      EXPECT_TRUE(has(served.unchangeable, "live")) << served.unchangeable;
    }
  }
}

TEST_F(ServeMember, ItsOwnPreparationIsServedWhereItIsMoreExact) {
  const Scene scene = inside();
  SurrogateData own = smallCell(scene);
  own.median_error = own.common_error = 1e-6;
  own.save(scene, SurrogateRange::standard(scene), file(scene));
  const ChosenCellModel served = makeCellModel(scene, "surrogate", config_, "a.yaml");
  EXPECT_TRUE(has(served.description, "from its own preparation")) << served.description;
  EXPECT_NE(served.change, nullptr);
  own.median_error = own.common_error = 0.5;
  own.save(scene, SurrogateRange::standard(scene), file(scene));
  const ChosenCellModel member = makeCellModel(scene, "surrogate", config_, "a.yaml");
  EXPECT_TRUE(has(member.description, "family homogeneous: ")) << member.description;
}

TEST_F(ServeMember, AFamilyOfAFewMembersServesNothing) {
  FamilyData few(homogeneous());
  for (int i = -3; i < 3; ++i) {
    const MadeUp made(Eigen::Vector3d(0.3 * i, 0, 0));
    few.add(made.member, made.surface);
  }
  few.update();
  few.save(families_ + "/homogeneous.data");
  const ChosenCellModel served = makeCellModel(inside(), "auto", config_, "a.yaml");
  EXPECT_TRUE(has(served.description, "family homogeneous has only 6 members")) << served.description;
}

TEST_F(ServeMember, DamagedDataOfAFamilyAreNamed) {
  fs::resize_file(families_ + "/homogeneous.data", fs::file_size(families_ + "/homogeneous.data") - 1);
  const ChosenCellModel served = makeCellModel(inside(), "auto", config_, "a.yaml");
  EXPECT_TRUE(has(served.description, "family homogeneous has no data (")) << served.description;
  EXPECT_TRUE(has(served.description, "is damaged")) << served.description;
}

TEST_F(ServeMember, ChangesWhileItIsServed) {
  const ChosenCellModel served = makeCellModel(inside(), "surrogate", config_, "a.yaml");
  ASSERT_NE(served.change, nullptr);
  const std::string text = served.change->change({{"young_modulus", 15e3}, {"diameter", 60e-6}});
  EXPECT_TRUE(has(text, "family homogeneous: tip_radius 0.1 of")) << text;
  served.cell->step({0, 0, 40e-6}, Eigen::Vector3d::UnitZ(), 1);
  const auto felt = served.cell->deformedSurface().scene;
  ASSERT_NE(felt, nullptr);
  EXPECT_DOUBLE_EQ(felt->radius(), 30e-6);
  EXPECT_DOUBLE_EQ(felt->cell.material().young_modulus, 15e3);
  // Each change begins with the cell that the one before made.
  served.change->change({{"young_modulus", 20e3}});
  served.cell->step({0, 0, 40e-6}, Eigen::Vector3d::UnitZ(), 1.1);
  EXPECT_DOUBLE_EQ(served.cell->deformedSurface().scene->radius(), 30e-6);
}

TEST_F(ServeMember, ARefusedChangeChangesNothing) {
  const ChosenCellModel served = makeCellModel(inside(), "surrogate", config_, "a.yaml");
  const auto refused = [&](const CellParameter& parameter) -> std::string {
    try {
      served.change->change({{"young_modulus", 1e3}, parameter});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(has(refused({"diameter", 150e-6}), "outside of family homogeneous: ")) << refused({"diameter", 150e-6});
  EXPECT_TRUE(has(refused({"diameter", -1}), "diameter = -1: must be ")) << refused({"diameter", -1});
  served.cell->step({0, 0, 40e-6}, Eigen::Vector3d::UnitZ(), 1);
  EXPECT_DOUBLE_EQ(served.cell->deformedSurface().scene->cell.material().young_modulus,
                   inside().cell.material().young_modulus);
}

}  // namespace
}  // namespace microinjection
