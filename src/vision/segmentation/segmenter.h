#pragma once

#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <string_view>

#include "vision/frame/frame.h"
#include "vision/segmentation/segmentation.h"

namespace microinjection {

/// The learned eye: a small network that tells for each part of a frame what it shows.
///
///     frame, any size --> WorkingImage --> U-Net --> Segmentation --> LearnedEye: proposals
///                         2 x 192 x 256   (ONNX)     classes x 96 x 128
///
/// The geometric detectors measure, but do not know what a cell is: a scale bar is as straight as a needle, a bubble
/// as round as an oocyte. The network knows that, and its borders are as coarse as its pixels. So it proposes where
/// things are and never measures; both err in different ways, and therefore their agreement means something. Its own
/// diameters are up to 18 % off in real images, none of which it has learnt from; where both eyes agree there, the
/// fits are within 2 to 3 % of what a person reads. To learn from the virtual microscope's images alone is enough for
/// a proposal, and their labels need nobody who draws them (doc/design/segmentation.md, doc/reference/benchmarks.md).
///
/// OpenCV's dnn module runs the weights, so that nothing that is installed needs Python or PyTorch. The description
/// beside them has the classes and a checksum, because weights of other classes would name everything wrongly and
/// look right.
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
