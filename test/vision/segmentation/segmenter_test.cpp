#include "vision/segmentation/segmenter.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/errors.h"
#include "vision/segmentation_training/training_image.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

const std::string kWeights = std::string(MICROINJECTION_SOURCE_DIR) + "/config/vision/segmentation.onnx";
const std::string kDescription = std::string(MICROINJECTION_SOURCE_DIR) + "/config/vision/segmentation.yaml";
constexpr std::uint64_t kHeldOut = 10000000;  // seeds from here on were never learnt
// Dice that the weights in use exceed on 60 held-out images, less 0.03.
constexpr double kLeastBackground = 0.945, kLeastOoplasm = 0.86, kLeastZona = 0.495, kLeastInjection = 0.26,
                 kLeastHolding = 0.36;

/// Weights in a folder of their own, to be damaged.
class SegmentersFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("segmenter_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    fs::copy_file(kWeights, weights(), fs::copy_options::overwrite_existing);
    fs::copy_file(kDescription, description(), fs::copy_options::overwrite_existing);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string weights() const { return (folder_ / "some.onnx").string(); }
  std::string description() const { return (folder_ / "some.yaml").string(); }
  void expectRefused(const std::string& part) const {
    try {
      Segmenter segmenter(weights());
      FAIL() << "was taken";
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("./dev train"), std::string::npos) << error.what();
    }
  }
  void replaceInDescription(const std::string& what, const std::string& by) const {
    std::ifstream in(description());
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    ASSERT_NE(text.find(what), std::string::npos);
    text.replace(text.find(what), what.size(), by);
    std::ofstream(description()) << text;
  }

 private:
  fs::path folder_;
};

TEST_F(SegmentersFiles, AreTaken) { EXPECT_NO_THROW(Segmenter{weights()}); }

TEST_F(SegmentersFiles, MustBeThere) {
  fs::remove(description());
  expectRefused("some.yaml: the description");
  fs::remove(weights());
  expectRefused("some.onnx: the weights of the segmentation cannot be read");
}

TEST_F(SegmentersFiles, MustBeWhole) {
  fs::resize_file(weights(), fs::file_size(weights()) / 2);
  expectRefused("checksum");
}

TEST_F(SegmentersFiles, MustNotBeChanged) {
  std::fstream file(weights(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(weights()) / 2));
  file.put('x').put('y').put('z');
  file.close();
  expectRefused("checksum");
}

TEST_F(SegmentersFiles, MustTellTheClassesOfThisProgram) {
  replaceInDescription("- ooplasm", "- yolk");
  expectRefused("yolk");
}

TEST_F(SegmentersFiles, MustHaveADescriptionThatCanBeRead) {
  replaceInDescription("crc32:", "crc16:");
  expectRefused("some.yaml");
}

/// Pixels of a class: in truth, by the network, and both.
struct Agreement {
  double truth = 0, guess = 0, both = 0;
  double dice() const { return 2 * both / (truth + guess); }
};

std::array<Agreement, kPixelClasses> agreementOn(std::uint64_t first, int count) {
  Segmenter segmenter(kWeights);
  TrainingImages images;
  std::array<Agreement, kPixelClasses> result;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) {
    const TrainingImage image = images.make(seed);
    const Frame frame(image.picture);
    if (!frame.refusal().empty()) continue;
    const cv::Mat label = workingLabel(image.label, WorkingImage(frame.grey()));
    const cv::Mat guess = segmenter.segment(frame).classes();
    for (std::size_t i = 0; i < kPixelClasses; ++i) {
      const cv::Mat is = label == static_cast<int>(i), said = (guess == static_cast<int>(i)) & (label != kNoLabel);
      result[i].truth += cv::countNonZero(is);
      result[i].guess += cv::countNonZero(said);
      result[i].both += cv::countNonZero(is & said);
    }
  }
  return result;
}

TEST(Segmenter, SeesWhatRenderedImagesShow) {
  const auto agreement = agreementOn(kHeldOut, 60);
  const auto dice = [&](PixelClass value) { return agreement[static_cast<std::size_t>(value)].dice(); };
  for (std::size_t i = 0; i < kPixelClasses; ++i)
    RecordProperty(kPixelClassNames[i], std::to_string(agreement[i].dice()));
  EXPECT_GT(dice(PixelClass::kBackground), kLeastBackground);
  EXPECT_GT(dice(PixelClass::kOoplasm), kLeastOoplasm);
  EXPECT_GT(dice(PixelClass::kZona), kLeastZona);
  EXPECT_GT(dice(PixelClass::kInjectionPipette), kLeastInjection);
  EXPECT_GT(dice(PixelClass::kHoldingPipette), kLeastHolding);
}

TEST(Segmenter, SaysTheSameOfAFrameEachTime) {
  TrainingImages images;
  const Frame frame(images.make(kHeldOut + 3).picture), other(images.make(kHeldOut + 4).picture);
  Segmenter segmenter(kWeights);
  const Segmentation first = segmenter.segment(frame);
  segmenter.segment(other);
  const Segmentation again = segmenter.segment(frame);
  EXPECT_EQ(
      cv::norm(first.probability(PixelClass::kBackground), again.probability(PixelClass::kBackground), cv::NORM_INF),
      0);
}

}  // namespace
}  // namespace microinjection
