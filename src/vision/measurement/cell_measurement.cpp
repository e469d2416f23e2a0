#include "vision/measurement/cell_measurement.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "vision/calibration/statistics.h"

namespace microinjection {
namespace {

constexpr double kNormal95 = 1.96;  // standard deviations, of the half width of a 95 % interval

MeasuredLength scaled(const MeasuredLength& length, double factor) {
  return {factor * length.value, factor * length.interval};
}

/// As CellSizeReadings: the median, with the scatter over the number of images; the stated variance
/// is not divided.
std::optional<MeasuredLength> combine(const std::deque<std::optional<CellOffset>>& offsets) {
  std::vector<double> values;
  double stated = 0;
  for (const auto& offset : offsets) {
    if (!offset) continue;
    values.push_back(offset->lateral);
    stated += offset->deviation * offset->deviation;
  }
  if (2 * values.size() <= offsets.size()) return std::nullopt;
  const double count = static_cast<double>(values.size()), scatter = robustDeviation(values);
  return MeasuredLength{medianOf(values), kNormal95 * std::sqrt(M_PI / 2 * scatter * scatter / count + stated / count)};
}

}  // namespace

std::string inMicrometres(const MeasuredLength& length) {
  std::ostringstream text;
  text.precision(4);
  text << 1e6 * length.value << " +- ";
  text.precision(2);
  text << 1e6 * length.interval << " um";
  return text.str();
}

std::string CellMeasurement::describe() const {
  std::string text = "diameter " + inMicrometres(diameter);
  text += zona_thickness ? ", zona " + inMicrometres(*zona_thickness) : ", no zona";
  text += offset ? ", " + inMicrometres(*offset) + " beside the holding pipette's axis" : ", no holding pipette";
  return text;
}

void CellReadings::add(const SpecimenView& view) {
  sizes_.add(view.cell);
  offsets_.push_back(cellOffset(view.cell, view.holding));
  std::string reason;
  const std::optional<CellSizeInImages> size = sizes_.measure(1, reason);
  while (offsets_.size() > (size ? size->images : 0)) offsets_.pop_front();
}

std::optional<CellMeasurement> CellReadings::measure(std::size_t least, double pixel_size, std::string& reason) const {
  const std::optional<CellSizeInImages> size = sizes_.measure(least, reason);
  if (!size) return std::nullopt;
  CellMeasurement measurement;
  measurement.images = size->images;
  measurement.diameter = scaled(size->diameter, pixel_size);
  if (size->zona_thickness) measurement.zona_thickness = scaled(*size->zona_thickness, pixel_size);
  if (const auto offset = combine(offsets_)) measurement.offset = scaled(*offset, pixel_size);
  return measurement;
}

}  // namespace microinjection
