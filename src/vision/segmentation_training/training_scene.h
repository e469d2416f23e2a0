#pragma once

#include "vision/microscope/microscope_config.h"
#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/random_draw.h"

namespace microinjection {

/// A scene to learn from, and the microscope that looks at it.
struct TrainingScene {
  MicroscopeConfig microscope;  ///< camera, objective and contrast; light and sensor are added to the picture later
  MicroscopeScene scene;
  double focus = 0;  ///< m
};

/// Draws a scene far wider than drawScene does: oocytes with zona, bare cells and vesicles, several or none, partly
/// outside the image; pipettes from every side; bubbles, dust and fragments; every contrast mode, through focus. The
/// camera is somewhat finer than a WorkingImage.
TrainingScene drawTrainingScene(RandomDraw& random);

}  // namespace microinjection
