#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/MeasureCell.h"
#include "nodes/display/cell_state_reader.h"
#include "placed_specimen.h"
#include "scripted_needle.h"
#include "vision/calibration/calibration_file.h"

namespace microinjection {
namespace {

/// A session for a cell of 56 um, and one of 62 um under its needle and its microscope.
class MeasureCellTest : public testing::Test {
 protected:
  static constexpr double kDiameter = 62e-6, kOffset = 2e-6;  // m; of the cell from the holding pipette's axis
  static constexpr double kClear = 60e-6, kPressed = 0.5 * kDiameter - 8e-6;  // m, heights of the tip

  MeasureCellTest() {
    std::filesystem::create_directory(record_);
    placeHolder(session_.world(), {-kOffset, 0, -0.5 * kDiameter});
    session_.add("true_cell", "{needle: measured}");
    session_.add("cell_simulator", "{needle: measured}");
    session_.add("vision");
    YAML::Node recorder = YAML::LoadFile(MICROINJECTION_SOURCE_DIR "/config/image_recorder.yaml");
    recorder["output_dir"] = record_;
    session_.add("image_recorder", "image_recorder", recorder);
    session_.add("microscope", camera_.parameters(5, "needle: measured"));
    session_.world().hear<cell_microinjection::VisionState>("/vision/state");
    session_.world().publisher<cell_microinjection::InjectionStatus>("/controller/injection_state");
    session_.run(0.5);
  }

  cell_microinjection::MeasureCellResponse measure(const std::string& scene) {
    session_.run(2.2);  // ten images
    cell_microinjection::MeasureCellRequest request;
    request.serve = 1;
    request.scene = scene;
    return session_.call<cell_microinjection::MeasureCell>("/vision/measure_cell", request);
  }
  double force(const std::string& topic) {
    auto& forces = session_.world().hear<geometry_msgs::WrenchStamped>(topic);
    session_.run(0.01);
    EXPECT_TRUE(forces.newest() && !forces.newest()->header.stamp.isZero()) << topic;
    return forces.newest() ? forces.newest()->wrench.force.z : NAN;
  }
  double servedDiameter() {
    auto& states = session_.world().hear<cell_microinjection::CellState>("/cell/state");
    states.clear();
    session_.run(0.1);
    return states.newest() ? cellParameter(*states.newest(), "diameter").value_or(NAN) : NAN;
  }
  void expectSnapshot(const std::string& state, const std::string& file) {
    cell_microinjection::InjectionStatus status;
    status.state = state;
    session_.world().say("/controller/injection_state", status);
    session_.run(0.3);
    EXPECT_TRUE(std::filesystem::exists(record_ + "/" + file)) << file;
  }

  // x from -60 to 60 um, z from -60 to 90 um
  SmallCamera camera_{480, 600, {239.5, 359.5}};
  VirtualSession session_{{"cell:=mouse_oocyte_injection", "hidden:=" + testFile("scenes/larger_oocyte.yaml"),
                           "camera.source:=sim", "hand.device:=none", "sensor.source:=none", "injector:=none"}};
  std::string record_ = session_.folder() / "record";
  ScriptedNeedle needle_{session_, kClear};
};

TEST_F(MeasureCellTest, IsMeasuredAndServed) {
  const auto* state = session_.world().hear<cell_microinjection::VisionState>("/vision/state").newest();
  ASSERT_TRUE(cellIsFound(state));
  ASSERT_TRUE(tipIsFound(state));
  EXPECT_LT((seenTip(*state) - camera_.pixelOf(0, kClear)).norm(), 1);
  EXPECT_LT((Eigen::Vector2d(state->cell.x, state->cell.y) - camera_.origin).norm(), 0.5);
  const std::string scene = session_.folder() / "measured.yaml";
  const auto answer = measure(scene);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_GE(answer.images, 10u);
  EXPECT_NEAR(answer.diameter, kDiameter, std::max(answer.diameter_interval, 3e-3 * kDiameter));
  EXPECT_LT(answer.diameter_interval, 1e-2 * kDiameter);
  EXPECT_TRUE(std::isnan(answer.zona_thickness));
  EXPECT_NEAR(answer.offset, kOffset, std::max(answer.offset_interval, 0.3e-6));
  EXPECT_LT(answer.offset_interval, 1e-6);
  EXPECT_NE(answer.family.find("family homogeneous"), std::string::npos) << answer.family;
  EXPECT_NEAR(YAML::LoadFile(scene)["cell"]["diameter"].as<double>(), answer.diameter, 1e-9);
  EXPECT_NEAR(servedDiameter(), answer.diameter, 1e-12);
  // The felt force is that of the true cell.
  needle_.moveTo(kPressed, 40e-6);
  session_.run(0.3);
  EXPECT_GT(force("/true_cell/predicted_cf"), 0.1e-6);
  EXPECT_NEAR(force("/cell/predicted_cf") / force("/true_cell/predicted_cf"), 1, 0.03);
}

TEST_F(MeasureCellTest, AnImpossibleSceneFileChangesNothing) {
  const double before = servedDiameter();
  const auto answer = measure("/proc/nowhere/scene.yaml");
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("/proc/nowhere"), std::string::npos) << answer.message;
  EXPECT_EQ(servedDiameter(), before);
}

TEST_F(MeasureCellTest, ImagesAreRecordedWithASnapshotOfEachState) {
  expectSnapshot("approach", "snapshot_000_approach.png");
  expectSnapshot("../approach", "snapshot_001_state.png");  // that is no name of a file
  session_.run(2);
  session_.executive().end("image_recorder");
  std::ifstream table(record_ + "/overlay.avi.csv");
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "frame,stamp");
  double last = 0;
  std::size_t frames = 0;
  for (; std::getline(table, line); ++frames) {
    const double stamp = std::stod(line.substr(line.find(',') + 1));
    EXPECT_GT(stamp, last);
    last = stamp;
  }
  EXPECT_GT(frames, 10u);
  EXPECT_GT(std::filesystem::file_size(record_ + "/overlay.avi"), 10000 * frames);
}

/// A session with a camera of its own, whose images have been binned since its calibration: they have no scale.
TEST(VisionCalibration, OfOtherImagesGivesNoScale) {
  const SmallCamera camera;
  VirtualSession session({"camera.source:=sim", "hand.device:=none"});
  const std::string file = session.folder() / "calibrated.yaml";
  PlacedSpecimen specimen(session, 28e-6);
  session.add("vision", "{pixel_size: 0, calibration: " + file + "}");
  session.add("microscope", camera.parameters(5, "needle: measured"));
  const auto& states = session.world().hear<cell_microinjection::VisionState>("/vision/state");
  const std::string reason = "is of images of 960 x 992 px, this one has 480 x 496 px";
  for (const bool of_others : {true, false}) {
    SCOPED_TRACE(of_others);
    writeCalibration(file, of_others ? camera.calibrationOfOthers() : camera.calibration());
    session.run(2.2);  // ten images
    ASSERT_TRUE(states.newest());
    EXPECT_EQ(states.newest()->pixel_size, of_others ? 0 : camera.pixel);
    const auto answer = session.call<cell_microinjection::MeasureCell>("/vision/measure_cell");
    EXPECT_FALSE(of_others && answer.success);
    EXPECT_EQ(answer.message.find(reason) != std::string::npos, of_others) << answer.message;
    EXPECT_EQ(session.diagnostics().text("vision: images").find(reason) != std::string::npos, of_others);
  }
}

}  // namespace
}  // namespace microinjection
