#include "vision/segmentation/segmenter.h"

#include <yaml-cpp/yaml.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <vector>

#include "base/errors.h"
#include "vision/segmentation/built_in_weights.h"

namespace microinjection {
namespace {

constexpr char kRemedy[] = "; take both files from the repository, or train them anew: ./dev train";

std::string descriptionOf(const std::string& weights) {
  const std::size_t dot = weights.rfind('.'), folder = weights.find_last_of('/');
  const bool has_ending = dot != std::string::npos && (folder == std::string::npos || dot > folder);
  return (has_ending ? weights.substr(0, dot) : weights) + ".yaml";
}

std::string bytesOf(const std::string& path, const char* what) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ConfigError(path + ": " + what + " cannot be read" + kRemedy);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

struct WeightsDescription {
  std::vector<std::string> classes;
  std::uint32_t checksum = 0;
};

WeightsDescription describedIn(const std::string& path, std::string_view text) {
  try {
    const YAML::Node file = YAML::Load(std::string(text));
    return {file["classes"].as<std::vector<std::string>>(), file["crc32"].as<std::uint32_t>()};
  } catch (const YAML::Exception& error) {
    throw ConfigError(path + ": " + error.what() + kRemedy);
  }
}

void checkClasses(const std::string& path, const std::vector<std::string>& classes) {
  const std::vector<std::string> ours(kPixelClassNames.begin(), kPixelClassNames.end());
  if (classes == ours) return;
  throw ConfigError(path + ": the weights tell the classes " + join(classes, ", ") + ", and this program knows " +
                    join(ours, ", ") + kRemedy);
}

/// The network's input: planes of the working image, in the units of its training.
cv::Mat inputOf(const WorkingImage& working) {
  const int sizes[] = {1, WorkingImage::kPlanes, WorkingImage::kHeight, WorkingImage::kWidth};
  cv::Mat input(4, sizes, CV_32F);
  for (int i = 0; i < WorkingImage::kPlanes; ++i) {
    cv::Mat plane(WorkingImage::kHeight, WorkingImage::kWidth, CV_32F, input.ptr<float>(0, i));
    working.planes[i].convertTo(plane, CV_32F, 1 / WorkingImage::kLevelsPerUnit,
                                -WorkingImage::kLevelOfZero / WorkingImage::kLevelsPerUnit);
  }
  return input;
}

bool hasOutputSize(const cv::Mat& output) {
  return output.dims == 4 && output.type() == CV_32F && output.size[0] == 1 &&
         output.size[1] == static_cast<int>(kPixelClasses) && output.size[2] == Segmentation::kHeight &&
         output.size[3] == Segmentation::kWidth;
}

}  // namespace

Segmenter::Segmenter() {
  load("config/vision/segmentation.onnx", builtInWeights(), "config/vision/segmentation.yaml", builtInDescription());
}

Segmenter::Segmenter(const std::string& weights) {
  const std::string description = descriptionOf(weights);
  const std::string bytes = bytesOf(weights, "the weights of the segmentation");
  load(weights, bytes, description, bytesOf(description, "the description of the segmentation's weights"));
}

void Segmenter::load(const std::string& weights, std::string_view bytes, const std::string& description,
                     std::string_view text) {
  const WeightsDescription described = describedIn(description, text);
  checkClasses(description, described.classes);
  const auto checksum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
  if (checksum != described.checksum)
    throw ConfigError(weights + ": the weights have the checksum " + std::to_string(checksum) + " and not " +
                      std::to_string(described.checksum) + " as in " + description + kRemedy);
  try {
    network_ = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    network_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network_.setInput(inputOf(WorkingImage(cv::Mat(WorkingImage::kHeight, WorkingImage::kWidth, CV_32F, 0.5F))));
    if (!hasOutputSize(network_.forward())) throw ConfigError(weights + ": the network has another output" + kRemedy);
  } catch (const cv::Exception& error) {
    throw ConfigError(weights + ": OpenCV cannot use the weights (" + error.err + ")" + kRemedy);
  }
}

Segmentation Segmenter::segment(const cv::Mat& grey) {
  const WorkingImage working(grey);
  network_.setInput(inputOf(working));
  const cv::Mat output = network_.forward();
  std::array<cv::Mat, kPixelClasses> probabilities;
  for (std::size_t i = 0; i < kPixelClasses; ++i)
    probabilities[i] = cv::Mat(Segmentation::kHeight, Segmentation::kWidth, CV_32F,
                               const_cast<float*>(output.ptr<float>(0, static_cast<int>(i))))
                           .clone();
  return {std::move(probabilities), working, grey.size()};
}

}  // namespace microinjection
