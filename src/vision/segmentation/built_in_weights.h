#pragma once

#include <string_view>

namespace microinjection {

/// The weights of config/vision/segmentation.onnx and their description, as they were when the program was built.
std::string_view builtInWeights();
std::string_view builtInDescription();

}  // namespace microinjection
