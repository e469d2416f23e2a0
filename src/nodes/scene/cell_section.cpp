#include "nodes/scene/cell_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "nodes/display/display_markers.h"

namespace microinjection {
namespace {

constexpr int kMostLayers = 4;
/// From outside; a cell of one layer has the second colour, as the inside of the others.
constexpr std::array<Colour, kMostLayers> kLayers = {
    {{0.86f, 0.78f, 0.62f, 1}, {0.52f, 0.62f, 0.74f, 1}, {0.62f, 0.48f, 0.72f, 1}, {0.46f, 0.34f, 0.56f, 1}}};
constexpr Colour kBorder{0.10f, 0.12f, 0.16f, 1};
constexpr double kWidth = 0.006;  // display units
constexpr double kLift = 0.002;   // display units, of a layer above the one outside of it

using Curve = std::vector<Eigen::Vector3d>;

Curve displayed(const Curve& curve, const Eigen::Vector3d& lift, double enlargement) {
  Curve result;
  for (const Eigen::Vector3d& point : curve) result.emplace_back(toDisplay(point, enlargement) + lift);
  return result;
}

LineList dashed(const LineList& lines) {
  constexpr std::size_t kDash = 3;  // segments
  LineList result;
  for (std::size_t i = 0; i + 1 < lines.size(); i += 2) {
    if (i / 2 / kDash % 2 == 0) result.insert(result.end(), {lines[i], lines[i + 1]});
  }
  return result;
}

}  // namespace

std::vector<LayerBorder> bordersOf(const CellSurface& surface, const std::vector<LayerBorder>& solved,
                                   const std::optional<DisplayedSolid>& solid,
                                   const std::optional<DisplayedStress>& stress) {
  if (!solved.empty() || !solid || surface.at_rest.empty()) return solved;
  std::vector<LayerBorder> borders;
  const std::vector<double>& radii = solid->layer_radii;
  const auto drawn = std::min<std::size_t>(radii.size(), kMostLayers);
  const auto positive = [](double radius) { return std::isfinite(radius) && radius > 0; };
  if (!std::all_of(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(drawn), positive)) return borders;
  for (std::size_t layer = 1; layer < drawn; ++layer) {
    const bool first = layer == 1 && stress;
    borders.push_back(first ? borderBelow(surface, stress->field.normal_column, radii[0] - radii[1])
                            : borderAtRest(surface, static_cast<int>(layer), radii[layer] / radii[0], solid->centre));
  }
  return borders;
}

void drawSection(const std::string& frame, const CellSurface& surface, const std::vector<LayerBorder>& borders,
                 const CutPlane& plane, double enlargement, visualization_msgs::MarkerArray& markers) {
  struct Face {
    Curve curve;
    bool estimated = false;
  };
  std::array<Face, kMostLayers> faces;
  faces[0].curve = outline(surface.vertices, surface.triangles, plane);
  for (const LayerBorder& border : borders) {
    if (border.layer < kMostLayers)
      faces[border.layer] = {outline(border.vertices, border.triangles, plane), border.estimated};
  }
  for (int layer = 0; layer < kMostLayers; ++layer) {
    const Face& face = faces[layer];
    const Colour& colour = kLayers[borders.empty() ? 1 : static_cast<std::size_t>(layer)];
    const auto lifted = [&](double by) { return displayed(face.curve, kLift * by * plane.normal, enlargement); };
    const LineList edge = segments(lifted(layer + 0.5));
    // Without a curve, both markers remove what was there.
    markers.markers.push_back(
        triangleMarker({frame, "section", layer}, inside(lifted(layer), plane, colour), {1, 1, 1, 1}));
    markers.markers.push_back(
        lineMarker({frame, "section_borders", layer}, face.estimated ? dashed(edge) : edge, kWidth, kBorder));
  }
}

void removeSection(const std::string& frame, visualization_msgs::MarkerArray& markers) {
  for (int layer = 0; layer < kMostLayers; ++layer) {
    markers.markers.push_back(noMarker({frame, "section", layer}));
    markers.markers.push_back(noMarker({frame, "section_borders", layer}));
  }
}

}  // namespace microinjection
