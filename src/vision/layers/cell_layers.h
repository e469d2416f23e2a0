#pragma once

#include "vision/border/cell_border.h"
#include "vision/frame/contrast_mode.h"

namespace microinjection {

/// The borders of one cell. A border that is absent has the verdict kNotFound.
///
///         .-----------.      zona_outer: middle of its dark line
///       /  .---------.  \    zona_inner: middle of a thin dark line
///      |  /  .-----.  \  |   (the perivitelline gap, which may be thinner than a line is wide)
///      | |  ( oopl. )  | |   ooplasm: where the dark rim outside meets the bright line inside
///      |  \  '-----'  /  |
///       \  '---------'  /    main: the clearest one of the three, whichever that is
///         '-----------'
///
/// Which of these lines is the clearest depends on contrast mode, focus and the cell, and none of them says by itself
/// which one it is: a vesicle, an oocyte without its zona and one of four rings look alike near their line. So the
/// clearest is found first, without a name. Then others are searched outside and inside of it, a faint ring by all
/// directions together, and their order gives the names. One fit of all grey values (layer_fit.h) at last measures
/// what the lines alone do not separate. A search for a zona and an ooplasm by name would have to know the ratio of
/// their radii, which differs from cell to cell.
///
/// What the image leaves open becomes a reason of the border's verdict instead of a choice: a ring outside of the
/// outermost border, lines that are other ones on each side in DIC, a cell that is out of focus
/// (doc/design/detection.md has all reasons with their limits).
struct CellLayers {
  CellBorder main;  ///< the clearest of them, at the resolution of the search
  CellBorder ooplasm, zona_inner, zona_outer;
};

/// Finds the same borders in another frame, moved by at most `reach` (px). A border that is lost has the verdict
/// kNotFound. A doubt of the ooplasm's border stays, and so does that of a ring outside: only a search sees what lies
/// beside the lines.
CellLayers followLayers(const Frame& frame, const CellLayers& previous, ContrastMode mode, double reach);

/// The clearest closed border about a place: its centre within `radius` / 4, its radius within 0.5 to
/// 1.5 times `radius` (px).
CellBorder findMainBorder(const Frame& frame, const cv::Point2d& centre, double radius, ContrastMode mode);

/// Finds the other borders outside and inside of the main one, says which is which, and refines all at the frame's
/// resolution.
/// @param largest  px, diameter that the outermost border has at the most
CellLayers findLayers(const Frame& frame, const CellBorder& main, ContrastMode mode, double largest);

}  // namespace microinjection
