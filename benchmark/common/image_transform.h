#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmark/common/marked_image.h"

namespace microinjection {

/// Makes another image of the same things, as another camera, exposure or storage would, with the marks where they are
/// then.
struct ImageTransform {
  std::string name;
  std::function<MarkedImage(const MarkedImage&)> apply;
};

/// The first one is the identity. Noise is the same in each run.
std::vector<ImageTransform> imageTransforms();

}  // namespace microinjection
