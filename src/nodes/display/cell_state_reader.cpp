#include "nodes/display/cell_state_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

constexpr int kMostBorders = 8;

}  // namespace

CellSurface toSurface(const cell_microinjection::CellState& message) {
  CellSurface surface;
  for (const auto& p : message.vertices) surface.vertices.push_back(toVector(p));
  for (std::size_t i = 0; i + 2 < message.triangles.size(); i += 3) {
    const auto* t = &message.triangles[i];
    surface.triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
  }
  for (const auto& p : message.rest_vertices) surface.at_rest.push_back(toVector(p));
  surface.displacement.assign(message.displacement.begin(), message.displacement.end());
  surface.contact_vertices.assign(message.contact_vertices.begin(), message.contact_vertices.end());
  surface.held_vertices.assign(message.held_vertices.begin(), message.held_vertices.end());
  return surface;
}

std::vector<LayerBorder> toBorders(const cell_microinjection::CellState& message) {
  std::map<int, LayerBorder> borders;
  for (std::size_t i = 0; i < message.border_layers.size() && 3 * i + 2 < message.border_triangles.size(); ++i) {
    const auto* t = &message.border_triangles[3 * i];
    const int layer = static_cast<int>(message.border_layers[i]);
    // A cell has few layers; a message with many would be copied as often.
    if (layer < 0 || layer >= kMostBorders) continue;
    borders[layer].triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
  }
  std::vector<LayerBorder> result;
  for (auto& [layer, border] : borders) {
    border.layer = layer;
    for (const auto& p : message.border_vertices) border.vertices.push_back(toVector(p));
    if (border.drawable()) result.push_back(std::move(border));
  }
  return result;
}

std::optional<double> cellParameter(const cell_microinjection::CellState& message, const std::string& name) {
  const std::size_t count = std::min(message.parameter_names.size(), message.parameter_values.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (message.parameter_names[i] == name && std::isfinite(message.parameter_values[i]))
      return message.parameter_values[i];
  }
  return std::nullopt;
}

}  // namespace microinjection
