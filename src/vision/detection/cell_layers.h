#pragma once

#include <string>

#include "vision/detection/cell_border.h"

namespace microinjection {

/// The borders of one cell. A border that is absent has the verdict kNotFound.
struct CellLayers {
  CellBorder main;  ///< the clearest of them, at the resolution of the search
  CellBorder ooplasm, zona_inner, zona_outer;
};

/// Finds the same borders in another frame, moved by at most `reach` (px). A border that is lost has
/// the verdict kNotFound.
CellLayers followLayers(const Frame& frame, const CellLayers& previous, const std::string& look, double reach);

/// Whether the round thing is a bubble: its rim is wide and nearly black, its middle bright.
bool isBubble(const Frame& frame, const CellLayers& layers);
/// Whether the thing within a border is as black all round as no cell is: air turns away nearly all light.
/// Holds for bubbles before others too, whose middles are not bright.
bool isBlack(const Frame& frame, const Ellipse& border);

/// The clearest closed border about a place: its centre within `radius` / 4, its radius within 0.5 to
/// 1.5 times `radius` (px).
CellBorder findMainBorder(const Frame& frame, const cv::Point2d& centre, double radius, const std::string& look);

/// Finds the other borders outside and inside of the main one, says which is which, and refines all
/// at the frame's resolution.
/// @param largest  px, diameter of the outermost border
CellLayers findLayers(const Frame& frame, const CellBorder& main, const std::string& look, double largest);

}  // namespace microinjection
