#include "nodes/scene/cell_stress.h"

#include <limits>
#include <memory>

#include "base/errors.h"
#include "cell/material/material_parameter.h"
#include "cell/model/placed_cell.h"
#include "nodes/display/cell_state_reader.h"

namespace microinjection {
namespace {

LoadedSurface loadedSurface(const CellSurface& surface, bool force_known) {
  const std::size_t size = surface.vertices.size();
  LoadedSurface loaded{surface.at_rest, surface.vertices, surface.triangles, std::vector<bool>(size, false),
                       std::vector<bool>(size, false)};
  for (const int vertex : surface.held_vertices) loaded.held[vertex] = true;
  for (const int vertex : surface.contact_vertices) (force_known ? loaded.touched : loaded.held)[vertex] = true;
  return loaded;
}

}  // namespace

std::optional<DisplayedSolid> toSolid(const cell_microinjection::CellState& message) {
  if (message.material.empty()) return std::nullopt;
  DisplayedSolid solid;
  solid.material.model = message.material;
  for (const MaterialParameter& each : materialParameters()) {
    if (!each.ofAllModels() && each.model != message.material) continue;
    const auto value = cellParameter(message, each.name);
    if (!value) return std::nullopt;
    solid.material.*each.value = *value;
  }
  solid.surface_tension = cellParameter(message, "surface_tension").value_or(0);
  solid.layer_radii.assign(message.layer_radii.begin(), message.layer_radii.end());
  solid.centre.z() = cellParameter(message, PlacedCell::kName).value_or(0);
  try {
    solid.material.validate();
  } catch (const ConfigError&) {
    return std::nullopt;
  }
  return solid;
}

std::optional<DisplayedStress> stressOf(const CellSurface& surface, const std::optional<DisplayedSolid>& solid,
                                        const std::optional<Eigen::Vector3d>& force, std::string& reason) {
  reason = surface.at_rest.empty()       ? "the surface at rest is not known"
           : !solid                      ? "the cell is no solid"
           : solid->surface_tension != 0 ? "the surface has a tension"
                                         : "";
  if (!reason.empty()) return std::nullopt;
  const LoadedSurface loaded = loadedSurface(surface, force.has_value());
  const double pressure = force ? meanContactPressure(loaded, *force) : std::numeric_limits<double>::quiet_NaN();
  const std::unique_ptr<Material> material = makeMaterial(solid->material);
  DisplayedStress stress{surfaceStress(loaded, *material, force ? pressure : 0), {}};
  stress.contact_pressure.assign(surface.vertices.size(), 0);
  for (const int vertex : surface.contact_vertices) stress.contact_pressure[vertex] = pressure;
  return stress;
}

std::vector<double> valuesForScale(const CellSurface& surface, SurfaceQuantity quantity, std::vector<double> values) {
  if (quantity == SurfaceQuantity::kVonMisesStress || quantity == SurfaceQuantity::kPressure) {
    for (const int vertex : surface.contact_vertices) values[vertex] = 0;
  }
  return values;
}

std::vector<double> valuesOf(const CellSurface& surface, const std::optional<DisplayedStress>& stress,
                             SurfaceQuantity& quantity) {
  if (!stress) quantity = SurfaceQuantity::kDisplacement;
  switch (quantity) {
    case SurfaceQuantity::kVonMisesStress:
      return stress->field.von_mises;
    case SurfaceQuantity::kPressure:
      return stress->field.pressure;
    case SurfaceQuantity::kContactPressure:
      return stress->contact_pressure;
    default:
      return surface.displacement;
  }
}

}  // namespace microinjection
