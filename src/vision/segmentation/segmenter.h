#pragma once

#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <string_view>

#include "vision/detection/frame.h"
#include "vision/segmentation/segmentation.h"

namespace microinjection {

/// The learned eye: a small network that tells for each part of a frame what it shows.
///
/// It has learnt from the virtual microscope's images (doc/design/segmentation.md) and proposes where things are; it
/// does not measure. It takes frames of any size and brightness, since a WorkingImage of them is what it sees.
///
/// Not for several threads at once.
class Segmenter {
 public:
  /// With the weights that are built into the program.
  Segmenter();
  /// Reads the weights, an ONNX file, and their description, the file of the same name that ends in .yaml. Throws
  /// ConfigError where one is missing, damaged, or does not belong to the other or to this program.
  explicit Segmenter(const std::string& weights);

  /// Some 14 ms of one core. The frame must not have a refusal.
  Segmentation segment(const Frame& frame) { return segment(frame.grey()); }
  /// Of an image, or a part of one, as Frame::grey() has it; places are in px of that.
  Segmentation segment(const cv::Mat& grey);

 private:
  /// `weights`, `description`: their names, for what is wrong with them.
  void load(const std::string& weights, std::string_view bytes, const std::string& description, std::string_view text);

  cv::dnn::Net network_;
};

}  // namespace microinjection
