#include "nodes/cell/cell_state_reader.h"

#include <algorithm>
#include <cmath>

#include "nodes/runtime/conversions.h"

namespace microinjection {

CellSurface toSurface(const cell_microinjection::CellState& message) {
  CellSurface surface;
  for (const auto& p : message.vertices) surface.vertices.push_back(toVector(p));
  for (std::size_t i = 0; i + 2 < message.triangles.size(); i += 3) {
    const auto* t = &message.triangles[i];
    surface.triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
  }
  surface.displacement.assign(message.displacement.begin(), message.displacement.end());
  surface.contact_vertices.assign(message.contact_vertices.begin(), message.contact_vertices.end());
  surface.held_vertices.assign(message.held_vertices.begin(), message.held_vertices.end());
  return surface;
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
