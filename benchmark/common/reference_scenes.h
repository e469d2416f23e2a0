#pragma once

#include <string>
#include <vector>

#include "cell/model/scene.h"

namespace microinjection {

/// A scene with forces that others found on converged meshes: test/reference/README.md.
struct ReferenceScene {
  struct Point {
    double depth;  ///< m
    double force;  ///< N
  };
  std::string name;
  Scene scene;
  std::vector<Point> points;  ///< ascending
};

/// Read from test/reference; std::runtime_error when a file cannot be.
std::vector<ReferenceScene> referenceScenes();

/// The paper's material under a disc, to 0.5 um: as good as any mesh gives it (0.3 um at the disc's
/// edge), since the continuum probably has no solution.
ReferenceScene stVenantKirchhoffScene();

}  // namespace microinjection
