// The command as its users run it: a rendered stack of planes becomes a scene.

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "cell/model/scene.h"
#include "commands/command_test.h"
#include "vision/calibration/calibration_file.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

const std::string kSource = MICROINJECTION_SOURCE_DIR;

class MeasureCellCommand : public CommandTest {
 protected:
  MeasureCellCommand() : CommandTest(MICROINJECTION_MEASURE_CELL, "measure_cell") {}

  void SetUp() override {
    CommandTest::SetUp();
    fs::create_directories(directory_ + "stack");
  }

  /// Planes 4 um apart of a cell of `radius` (m) with a zona of 6 um.
  void render(double radius) const {
    Microscope microscope{MicroscopeConfig()};
    MicroscopeScene scene;
    scene.cells.push_back(CellScene::round({0, 0}, radius, 6e-6, 0));
    for (int plane = -2; plane <= 2; ++plane) {
      const std::string name = directory_ + "stack/plane" + std::to_string(plane + 8) + ".png";
      ASSERT_TRUE(cv::imwrite(name, microscope.render(scene, 4e-6 * plane, 20 + plane)));
    }
  }

  /// The first number of the line that begins with a name.
  static double number(const std::string& out, const std::string& name) {
    const std::size_t place = out.find(name + ": ");
    return place == std::string::npos ? -1 : std::stod(out.substr(place + name.size() + 2));
  }
};

TEST_F(MeasureCellCommand, MakesASceneOfAStack) {
  render(38.4e-6);
  std::ofstream(directory_ + "stack/broken.png") << "no image";
  const Outcome result =
      run("stack --pixel-size 0.25e-6 --scene " + kSource +
          "/config/cells/mouse_oocyte_zona.yaml --out measured.yaml --overlay overlay.png --families " + kSource +
          "/config/families");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("image: plane8.png, 3 of 5"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("verdict: found\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("offset: not known"), std::string::npos) << result.out;  // there is no holding pipette
  EXPECT_NE(result.out.find("polar body: not known: "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("family: family zona"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("broken.png"), std::string::npos) << result.err;
  EXPECT_NEAR(number(result.out, "diameter"), 76.8, 0.3);
  EXPECT_NEAR(number(result.out, "zona"), 6, 0.4);
  const Scene scene = loadScene(directory_ + "measured.yaml");
  EXPECT_NEAR(1e6 * scene.cell.diameter(), number(result.out, "diameter"), 0.01);
  EXPECT_EQ(scene.cell.layers.size(), 2U);
  const cv::Mat overlay = cv::imread(directory_ + "overlay.png");
  EXPECT_EQ(overlay.cols, 1392);
}

TEST_F(MeasureCellCommand, SearchesAllPagesOfAStack) {
  Microscope microscope{MicroscopeConfig()};
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({0, 0}, 38e-6, 6e-6, 0));
  std::vector<cv::Mat> planes;
  for (const double focus : {-12e-6, -6e-6, 0.0, 6e-6}) planes.push_back(microscope.render(scene, focus, 7));
  ASSERT_TRUE(cv::imwritemulti(directory_ + "stack.tif", planes));
  const Outcome result = run("stack.tif --pixel-size 0.25e-6");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("image: stack.tif, page 3 of 4, 3 of 4"), std::string::npos) << result.out;
  EXPECT_NEAR(number(result.out, "diameter"), 76, 0.3);
}

TEST_F(MeasureCellCommand, RefusesTheCalibrationOfOtherImages) {
  render(38e-6);
  CameraCalibration calibration;
  calibration.date = "2025-03-04T05:06:07Z";
  calibration.value[kPixelSize] = 0.25e-6;
  calibration.value[kAxisRatio] = 1;
  calibration.points = 1;
  writeCalibration(directory_ + "old.yaml", calibration);
  Outcome result = run("stack/plane8.png --calibration old.yaml");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("old.yaml: the calibration does not say of which size"), std::string::npos) << result.err;
  calibration.image_size = {1392, 1040};
  writeCalibration(directory_ + "whole.yaml", calibration);
  result = run("stack/plane8.png --calibration whole.yaml");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  calibration.image_size = {2784, 2080};  // the images are binned
  writeCalibration(directory_ + "unbinned.yaml", calibration);
  result = run("stack/plane8.png --calibration unbinned.yaml");
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("unbinned.yaml: the calibration is of images of 2784 x 2080 px, this one has 1392 x 1040"),
            std::string::npos)
      << result.err;
}

TEST_F(MeasureCellCommand, WritesNoSceneOfWhatItDoesNotFind) {
  cv::imwrite(directory_ + "empty.png", cv::Mat(300, 400, CV_8U, cv::Scalar(90)));
  const Outcome result = run("empty.png --pixel-size 0.25e-6 --overlay o.png --out measured.yaml --scene " + kSource +
                             "/config/cells/mouse_oocyte_zona.yaml");
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.out.find("verdict: not found: "), std::string::npos) << result.out;
  EXPECT_FALSE(fs::exists(directory_ + "measured.yaml"));
  EXPECT_TRUE(fs::exists(directory_ + "o.png"));
}

TEST_F(MeasureCellCommand, RefusesBadUsage) {
  std::ofstream(directory_ + "text.png") << "no image";
  std::ofstream(directory_ + "config.yaml") << "cells: {}\n";
  for (const auto& [arguments, reason] : std::initializer_list<std::pair<std::string, std::string>>{
           {"--pixel-size 1e-6", "INPUT"},
           {"stack", "--pixel-size is missing"},
           {"stack --pixel-size 0", "--pixel-size = 0"},
           {"stack --pixel-size nan", "--pixel-size"},
           {"stack --pixel-size 1", "--pixel-size = 1"},
           {"stack --pixel-size 0.25", "--pixel-size = 0.25 m: must be 1e-9 .. 1e-4 m; 0.25 um would be 2.5e-7"},
           {"stack --pixel-size 1e-6 --far", "far"},
           {"stack --pixel-size 1e-6 --out a.yaml", "--scene"},
           {"stack --pixel-size 1e-6 --overlay a.txt", "--overlay"},
           {"stack --pixel-size 1e-6 --config config.yaml", "cells"},
           {"stack --calibration none.yaml", "none.yaml"},
           {"nowhere --pixel-size 1e-6", "nowhere"},
           {"stack --pixel-size 1e-6", "no image"},
           {"text.png --pixel-size 1e-6", "text.png"}}) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_NE(result.err.find(reason), std::string::npos) << arguments << ": " << result.err;
  }
}

TEST_F(MeasureCellCommand, Helps) {
  const Outcome result = run("--help");
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.out.find("--overlay"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
