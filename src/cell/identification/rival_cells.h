#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cell/family/family_data.h"
#include "cell/identification/axis_shape.h"

namespace microinjection {

/// A cell that could be under the same tip instead of the estimated one: same size, other layers.
struct RivalCell {
  std::string description;  ///< "zona, shell_thickness 0.1, core_modulus 0.05"
  AxisShape shape;          ///< of the outermost layer's modulus
};

/// Cells of all families with the scene's size, tip and holding pipette. Their layers are those of a grid
/// over the family's range. What a family has not as a parameter (the holding pipette, say) is its own;
/// none of a family whose range does not have the scene's tip. The scene is in a family itself.
std::vector<RivalCell> rivalCells(const std::vector<std::shared_ptr<const FamilyData>>& families, const Scene& scene);

/// The families with data in a folder.
std::vector<std::shared_ptr<const FamilyData>> loadFamilies(const std::string& folder);

}  // namespace microinjection
