#include <opencv2/core.hpp>

#include "benchmark/common/vision_cases.h"

namespace microinjection {
namespace {

SceneDrawConfig usual() {
  SceneDrawConfig draw;
  draw.dimple = 0;
  draw.holding = draw.injection = 1;
  return draw;
}

VisionCondition condition(const std::string& name, const SceneDrawConfig& draw) {
  VisionCondition result;
  result.name = "rendered_" + name;
  result.draw = draw;
  return result;
}

/// Needles that have a bore to see, in half of which is a column; before, at, on and in cells that a mouth draws in,
/// does not draw in, or has lost.
SceneDrawConfig bores() {
  SceneDrawConfig draw = usual();
  draw.cell = 0.9;
  draw.dimple = 0.3;
  draw.inside = 0.3;
  draw.in_needle = 0.5;
  draw.in_holder = 0.7;
  draw.lost = 0.2;
  draw.tip_radius = {2e-6, 5e-6};
  draw.inclination = {0, 0.12};
  return draw;
}

}  // namespace

std::vector<VisionCondition> visionConditions() {
  std::vector<VisionCondition> all = {condition("clean", usual())};
  all.push_back(condition("noise", usual()));
  all.back().microscope.sensor.gain = 8;
  all.push_back(condition("defocus", usual()));
  all.back().focus = 10e-6;
  // A needle just behind the plane in focus has fringes that look like the rim of an end in focus.
  all.push_back(condition("defocus_near", usual()));
  all.back().focus = -2e-6;
  SceneDrawConfig debris = usual();
  debris.dust = 25;
  all.push_back(condition("debris", debris));
  for (const ContrastMode mode : {ContrastMode::kDic, ContrastMode::kPhase}) {
    all.push_back(condition(toText(mode), usual()));
    all.back().microscope.contrast.mode = mode;
  }
  all.push_back(condition("compressed", usual()));
  all.back().microscope.sensor.jpeg_quality = 50;
  all.push_back(condition("turned_mirrored", usual()));
  all.back().microscope.camera.angle = 0.9;
  all.back().microscope.camera.mirrored = true;
  SceneDrawConfig dimple = usual();
  dimple.dimple = 1;
  all.push_back(condition("dimple", dimple));
  SceneDrawConfig nothing = usual();
  nothing.cell = nothing.holding = nothing.injection = 0;
  nothing.dust = 0;
  all.push_back(condition("empty", nothing));
  nothing.dust = 12;
  all.push_back(condition("dust", nothing));
  nothing.bubbles = 3;
  all.push_back(condition("bubbles", nothing));
  SceneDrawConfig pipettes = usual();
  pipettes.cell = 0;
  all.push_back(condition("pipettes_only", pipettes));
  all.push_back(condition("bore", bores()));
  all.push_back(condition("bore_noise", bores()));
  all.back().microscope.sensor.gain = 8;
  all.push_back(condition("bore_defocus", bores()));
  all.back().focus = 4e-6;
  SceneDrawConfig coarse = bores();
  coarse.diameter = {90e-6, 140e-6};
  all.push_back(condition("bore_coarse", coarse));
  all.back().microscope.camera.pixel_size = 0.4e-6;
  return all;
}

}  // namespace microinjection
