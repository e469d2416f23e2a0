#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "vision/camera/camera_view.h"
#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/random_draw.h"

namespace microinjection {

/// What a drawn scene contains; probabilities are in [0, 1].
struct SceneDrawConfig {
  double cell = 1;                         ///< probability
  double polar_body = 0.7;                 ///< of a cell with zona, probability
  double nucleus = 0.4;                    ///< probability
  double holding = 0.7;                    ///< probability; holds the cell if there is one
  double lost = 0;                         ///< that the cell has left it, probability
  double injection = 0.7;                  ///< probability
  double dimple = 0.4;                     ///< that the injection pipette indents the cell, probability
  double inside = 0;                       ///< that its tip is in the cell, of one that does not indent it, probability
  double in_needle = 0;                    ///< that it has drawn in a column, probability
  double in_holder = 0;                    ///< that the holding pipette has drawn in more of a held cell, probability
  int dust = 4;                            ///< at most
  int bubbles = 0;                         ///< at most
  bool centred = false;                    ///< the cell is at the world's origin and round
  DrawInterval diameter{60e-6, 140e-6};    ///< m
  DrawInterval zona{0.05, 0.2};            ///< thickness over the radius
  DrawInterval gap{0, 0.08};               ///< perivitelline gap over the radius
  double ellipticity = 0.03;               ///< largest (a - b) / (a + b)
  double place = 0.2;                      ///< largest offset of the cell from the middle of the image, over its sides
  DrawInterval dimple_depth{2e-6, 12e-6};  ///< m
  DrawInterval tip_radius{0.4e-6, 3e-6};   ///< m, outer, of the injection pipette
  DrawInterval column{4e-6, 30e-6};        ///< m, length
  DrawInterval tongue{0.1, 0.6};           ///< length beyond what the mouth has of the cell at rest, over its radius
  DrawInterval away{5e-6, 40e-6};          ///< m, from the mouth to a lost cell
  DrawInterval cell_y{0, 0};               ///< m
  DrawInterval tip_y{0, 0};                ///< m
  DrawInterval inclination{0, 0.5};        ///< rad, of the shaft out of the image plane; positive away from the camera
  double tilt = 0.25;                      ///< rad, largest angle of a pipette to the world's z

  /// Throws ConfigError with all errors of the members.
  void validate() const;
};

/// What is to be measured in the picture of a drawn scene: in px, and directions as unit vectors in
/// the image.
struct CellTruth {
  Eigen::Vector2d centre{0, 0};  ///< of the outer border, without the dimple
  double diameter = 0;           ///< of the circle with the area of the outer border, without the dimple
  /// Semi-axes (long, short) of the borders without the dimple. The ooplasm also gives way to the
  /// polar body, which its semi-axes leave out.
  Eigen::Vector2d outer{0, 0}, zona_inner{0, 0}, ooplasm{0, 0};
  Eigen::Vector2d ooplasm_centre{0, 0};
  double angle = 0;  ///< rad in [0, pi), of the long axis, from the image's x towards its y (down)
  std::optional<double> polar_body_angle;  ///< rad in (-pi, pi], seen from the centre, from x towards y (down)
  /// Depth of the indentation along the needle's axis, and its deepest place.
  std::optional<double> dimple_depth;
  Eigen::Vector2d dimple{0, 0};
};

struct PipetteTruth {
  Eigen::Vector2d end{0, 0};   ///< mouth or tip
  Eigen::Vector2d axis{0, 0};  ///< from the end towards the shaft
  double radius = 0;           ///< px, outer, at the end
  double y = 0;                ///< m, of the end
};

struct SceneTruth {
  std::optional<CellTruth> cell;
  std::optional<PipetteTruth> holding, injection;
  /// px in the image along the pipette's axis, from its end to the end of what is in it; none: nothing. A mouth that
  /// holds a cell has a part of it without any suction.
  std::optional<double> in_needle, in_holder;
  bool held = false;  ///< the cell is at the holding pipette's mouth
};

struct DrawnScene {
  MicroscopeScene scene;
  SceneTruth truth;
};

/// Draws a random scene. The same configuration, view and seed give the same scene.
DrawnScene drawScene(const SceneDrawConfig& config, const CameraView& view, std::uint64_t seed);

}  // namespace microinjection
