#pragma once

#include <cell_microinjection/VisionState.h>

#include <QPainter>
#include <array>

#include "operation/console/image_view.h"
#include "operation/console/light.h"

namespace microinjection {

/// Draws what vision found over an image, in the widget's resolution, so that lines and letters are
/// readable at every magnification. Dashed: uncertain.
void paintFindings(QPainter& painter, const ImageView& view, const cell_microinjection::VisionState& state);

/// The verdicts with lengths or reasons: cell, needle, holding pipette, dimple.
std::array<Lamp, 4> findingLines(const cell_microinjection::VisionState& state);

/// A place that is proposed for the tip, px.
void paintGoal(QPainter& painter, const ImageView& view, const Eigen::Vector2d& pixel);

/// A scale bar in the lower right corner. `pixel_size`: m, 0: not known.
void paintScaleBar(QPainter& painter, const ImageView& view, double pixel_size);

}  // namespace microinjection
