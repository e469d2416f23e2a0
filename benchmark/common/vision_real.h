#pragma once

#include <memory>
#include <vector>

#include "benchmark/common/image_transform.h"
#include "benchmark/common/marked_image.h"
#include "benchmark/common/micrographs.h"
#include "benchmark/common/vision_row.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// What real images are measured with.
enum class RealSetup {
  kDefault,  ///< config/vision.yaml as it is
  kTold,     ///< and look and directions of the image's pipettes
};

SpecimenTrackerConfig trackerConfig(const MarkedImage& image, RealSetup setup);

/// Rows of all images under the transforms: the set is real/TRANSFORM, or told/TRANSFORM. A frame is searched as the
/// node vision does with its first one. Without a transform frames are tracked, too, for the time that it takes.
void realRows(const Micrographs& micrographs, const std::vector<ImageTransform>& transforms, RealSetup setup,
              const std::shared_ptr<SecondEye>& eye, const TakeRow& take);

/// Rows of the three focus stacks of a standing stage: the plane of best focus, by both measures of sharpness and with
/// their windows where the tip was found, and the scale of the stage's steps.
void focusStackRows(const Micrographs& micrographs, const TakeRow& take);

/// Rows of a needle that moves by more than a tracker's reach, in twelve frames.
void sequenceRows(const Micrographs& micrographs, const std::shared_ptr<SecondEye>& eye, const TakeRow& take);

}  // namespace microinjection
