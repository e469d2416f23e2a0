#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "vision/layers/cell_size.h"
#include "vision/measurement/cell_offset.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// Sizes and place of a cell in metres of the specimen. Half widths of 95 % intervals, without the
/// error of the pixel size.
struct CellMeasurement {
  std::size_t images = 0;
  MeasuredLength diameter;
  std::optional<MeasuredLength> zona_thickness;  ///< none: no zona was found
  std::optional<MeasuredLength> offset;          ///< see CellOffset; none: no holding pipette was found

  /// "diameter 75.93 +- 0.15 um, zona 6.02 +- 0.08 um, ..."
  std::string describe() const;
};

/// "75.93 +- 0.15 um" of a length in m.
std::string inMicrometres(const MeasuredLength& length);

/// Collects what images show of a cell: its sizes (CellSizeReadings) and its place beside the
/// holding pipette's axis, which is the median over the same images.
class CellReadings {
 public:
  explicit CellReadings(std::size_t images) : sizes_(images) {}

  void add(const SpecimenView& view);
  /// `pixel_size`: m. None, with a reason: there are fewer than `least` readings.
  std::optional<CellMeasurement> measure(std::size_t least, double pixel_size, std::string& reason) const;

 private:
  CellSizeReadings sizes_;
  std::deque<std::optional<CellOffset>> offsets_;  ///< of the images that sizes_ has
};

}  // namespace microinjection
