#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "vision/layers/cell_detector.h"

namespace microinjection {

/// A length with the half width of its 95 % interval, px.
struct MeasuredLength {
  double value = 0, interval = 0;
};

/// Sizes of a cell by its newest images.
struct CellSizeInImages {
  std::size_t images = 0;
  MeasuredLength diameter;
  std::optional<MeasuredLength> zona_thickness;  ///< none: fewer than half of the images show one
};

/// Collects the readings of a cell from image to image.
///
/// A length is the median of its readings. Its variance has two parts: pi / 2 of the scatter over
/// the number of images, and the mean of the variances that the detector states. The latter is not
/// divided: what misleads a detector in one image misleads it in the next.
class CellSizeReadings {
 public:
  explicit CellSizeReadings(std::size_t images) : largest_(images) {}

  /// A cell whose diameter is not sure clears the readings, and so does one of another size (by more than 5
  /// %) than the last: it is another cell.
  void add(const CellDetection& cell);
  void clear() { readings_.clear(); }

  /// None, with a reason: there are fewer than `least` readings.
  std::optional<CellSizeInImages> measure(std::size_t least, std::string& reason) const;

 private:
  struct Reading {
    MeasuredLength diameter;  ///< interval: standard deviation
    std::optional<MeasuredLength> zona;
  };

  std::size_t largest_;
  std::deque<Reading> readings_;
  std::string lost_ = "no image was received";  ///< why the readings were cleared last
};

struct ZonaThickness {
  double thickness = 0;  ///< px, half of the difference of the borders' mean diameters
  double deviation = 0;  ///< px, standard deviation
};

/// Thickness of the zona: to its inner border where that was found. Without a perivitelline gap the
/// dark rim of the ooplasm covers the inner border, which is then the ooplasm's: an uncertain inner
/// border within that rim, or none, counts as such, and the interval of 95 % reaches over the rim: a gap
/// that it hides cannot be told from none. None: no zona, or a border of it is uncertain.
std::optional<ZonaThickness> zonaThickness(const CellDetection& cell);

}  // namespace microinjection
