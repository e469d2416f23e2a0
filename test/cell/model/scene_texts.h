#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/errors.h"
#include "cell/model/scene.h"

namespace microinjection {

inline constexpr char kGood[] = R"(
cell: {diameter: 56e-6, material: {model: neo_hookean, young_modulus: 17.9e3, poisson_ratio: 0.49}}
holding_pipette: {contact_radius: 10e-6}
needle: {tip: {shape: disc, radius: 3e-6}}
)";

inline constexpr char kLayered[] = R"(
cell:
  layers:
    - {name: zona, outer_radius: 28e-6, material: {model: neo_hookean, young_modulus: 17.9e3, poisson_ratio: 0.49}}
    - {name: cytoplasm, outer_radius: 24e-6, material: {model: corotated, young_modulus: 1e3, poisson_ratio: 0.45},
       surface_tension: 1e-4}
holding_pipette: {contact_radius: 10e-6}
needle: {tip: {shape: hemisphere, radius: 3e-6}}
)";

/// Message of the ConfigError; empty when the scene is good.
inline std::string errorsOf(const YAML::Node& node) {
  try {
    parseScene(node, "scene.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

inline void expectIn(const std::string& text, const std::vector<const char*>& parts) {
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

}  // namespace microinjection
