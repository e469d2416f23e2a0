#include "vision/measurement/measured_scene.h"

#include <cmath>
#include <limits>

#include "base/errors.h"

namespace microinjection {

YAML::Node withMeasuredSize(const YAML::Node& scene, double diameter, double zona_thickness) {
  YAML::Node result = YAML::Clone(scene);
  YAML::Node cell = result["cell"];
  if (!cell || !cell.IsMap()) throw ConfigError("scene: cell is missing");
  YAML::Node layers = cell["layers"];
  if (!layers) {
    if (!cell["diameter"]) throw ConfigError("scene: cell/diameter is missing");
    cell["diameter"] = diameter;
    return result;
  }
  if (!layers.IsSequence() || layers.size() == 0) throw ConfigError("scene: cell/layers must be a list");
  const double factor = diameter / 2 / layers[0]["outer_radius"].as<double>();
  for (YAML::Node layer : layers) layer["outer_radius"] = factor * layer["outer_radius"].as<double>();
  if (layers.size() == 2 && std::isfinite(zona_thickness)) {
    if (zona_thickness <= 0 || zona_thickness >= diameter / 2)
      throw ConfigError("zona thickness = " + std::to_string(zona_thickness) + " m: must be within the cell's radius");
    layers[1]["outer_radius"] = diameter / 2 - zona_thickness;
  }
  return result;
}

bool hasUnseenZona(const YAML::Node& scene, const CellMeasurement& cell) {
  return layersOf(scene) == 2 && !cell.zona_thickness;
}

void requireSeenZona(const YAML::Node& scene, const CellMeasurement& cell) {
  if (hasUnseenZona(scene, cell)) throw ConfigError(kUnseenZona);
}

YAML::Node withMeasuredSize(const YAML::Node& scene, const CellMeasurement& cell) {
  requireSeenZona(scene, cell);
  const double none = std::numeric_limits<double>::quiet_NaN();
  return withMeasuredSize(scene, cell.diameter.value, cell.zona_thickness ? cell.zona_thickness->value : none);
}

std::string measuredSceneText(const YAML::Node& scene, const std::string& measured, const std::string& from) {
  YAML::Emitter text;
  text << scene;
  return "# Measured: " + measured + ". From " + from + "\n" + text.c_str() + "\n";
}

std::size_t layersOf(const YAML::Node& scene) {
  const YAML::Node layers = scene["cell"] ? scene["cell"]["layers"] : YAML::Node();
  return layers && layers.IsSequence() ? layers.size() : 1;
}

}  // namespace microinjection
