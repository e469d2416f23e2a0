#pragma once

#include "vision/layers/cell_layers.h"

namespace microinjection {

/// Whether the round thing is a bubble: its rim is wide and nearly black, its middle bright.
bool isBubble(const Frame& frame, const CellLayers& layers);
/// Whether the thing within a border is as black all round as no cell is: air turns away nearly all light.
/// Holds for bubbles before others too, whose middles are not bright.
bool isBlack(const Frame& frame, const Ellipse& border);

}  // namespace microinjection
