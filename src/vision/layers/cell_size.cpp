#include "vision/layers/cell_size.h"

#include <cmath>
#include <vector>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr double kOtherCell = 0.05;  // relative change of the diameter: another cell
constexpr double kNormal95 = 1.96;   // standard deviations, of the half width of a 95 % interval

MeasuredLength combine(const std::vector<MeasuredLength>& readings) {
  std::vector<double> values, differences;
  double stated = 0;
  for (const MeasuredLength& reading : readings) {
    values.push_back(reading.value);
    stated += reading.interval * reading.interval / static_cast<double>(readings.size());
  }
  const double median = upperMedian(values);
  for (const double value : values) differences.push_back(std::abs(value - median));
  const double scatter = 1.4826 * upperMedian(differences);  // standard deviation of normal readings
  const double count = static_cast<double>(readings.size());
  return {median, kNormal95 * std::sqrt(M_PI / 2 * scatter * scatter / count + stated)};
}

constexpr double kRim = 1.25;  // over the mean width of the ooplasm's dark rim: one border and its blur

/// Whether a border was not seen at all, or within the ooplasm's rim.
bool isWithinRim(const CellBorder& border, const CellBorder& ooplasm) {
  if (!border.finding.hasValues()) return true;
  return (border.ellipse.meanDiameter() - ooplasm.ellipse.meanDiameter()) / 2 < kRim * ooplasm.rim;
}

}  // namespace

void CellSizeReadings::add(const CellDetection& cell) {
  if (!cell.size.isFound()) {
    lost_ = cell.size.reason;
    readings_.clear();
    return;
  }
  Reading reading;
  reading.diameter = {cell.outer().ellipse.meanDiameter(), diameterDeviation(cell.outer())};
  if (const auto zona = zonaThickness(cell)) reading.zona = MeasuredLength{zona->thickness, zona->deviation};
  if (!readings_.empty() &&
      std::abs(reading.diameter.value - readings_.back().diameter.value) > kOtherCell * reading.diameter.value) {
    lost_ = "the cell has changed its size";
    readings_.clear();
  }
  readings_.push_back(reading);
  if (readings_.size() > largest_) readings_.pop_front();
}

std::optional<CellSizeInImages> CellSizeReadings::measure(std::size_t least, std::string& reason) const {
  if (readings_.size() < least) {
    reason = "only " + std::to_string(readings_.size()) + " of " + std::to_string(least) +
             " images in succession show the cell" + (lost_.empty() ? "" : "; before: " + lost_);
    return std::nullopt;
  }
  CellSizeInImages size;
  size.images = readings_.size();
  std::vector<MeasuredLength> diameters, zonas;
  for (const Reading& reading : readings_) {
    diameters.push_back(reading.diameter);
    if (reading.zona) zonas.push_back(*reading.zona);
  }
  size.diameter = combine(diameters);
  if (2 * zonas.size() > readings_.size()) size.zona_thickness = combine(zonas);
  return size;
}

std::optional<ZonaThickness> zonaThickness(const CellDetection& cell) {
  if (!cell.zona_outer.finding.isFound()) return std::nullopt;
  const CellBorder* inner = &cell.zona_inner;
  double hidden = 0;  // px, standard deviation of the place in the rim
  if (!inner->finding.isFound()) {
    if (!cell.ooplasm.finding.isFound() || !isWithinRim(*inner, cell.ooplasm)) return std::nullopt;
    inner = &cell.ooplasm;
    hidden = kRim * cell.ooplasm.rim / kNormal95;
  }
  const double difference = cell.zona_outer.ellipse.meanDiameter() - inner->ellipse.meanDiameter();
  const double borders = std::hypot(diameterDeviation(cell.zona_outer), diameterDeviation(*inner)) / 2;
  return ZonaThickness{difference / 2, std::hypot(borders, hidden)};
}

}  // namespace microinjection
