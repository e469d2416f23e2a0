#include "nodes/imaging/vision_messages.h"

#include "vision/layers/cell_size.h"

namespace microinjection {
namespace {

template <typename Message>
void setFinding(const Finding& finding, Message& message) {
  message.verdict = finding.verdict == Verdict::kFound       ? Message::FOUND
                    : finding.verdict == Verdict::kUncertain ? Message::UNCERTAIN
                                                             : Message::NOT_FOUND;
  message.reason = finding.reason;
}

template <typename Message>
void setCovariance(const Eigen::Matrix2d& covariance, Message& message) {
  for (int i = 0; i < 4; ++i) message.covariance[i] = covariance(i / 2, i % 2);
}

cell_microinjection::CellInImage toMessage(const CellDetection& cell) {
  cell_microinjection::CellInImage message;
  setFinding(cell.finding, message);
  if (!cell.finding.hasValues()) return message;
  message.x = cell.centre.x;
  message.y = cell.centre.y;
  setCovariance(cell.centre_covariance, message);
  message.diameter = cell.outer().ellipse.meanDiameter();
  message.diameter_deviation = cell.size.isFound() ? diameterDeviation(cell.outer()) : kNotMeasured;
  if (cell.finding.isFound()) message.reason = cell.size.reason;
  const std::optional<ZonaThickness> zona = zonaThickness(cell);
  message.zona_thickness = zona ? zona->thickness : kNotMeasured;
  message.zona_thickness_deviation = zona ? zona->deviation : kNotMeasured;
  const PolarBody& body = cell.polar_body;
  message.polar_body_angle = body.finding.isFound() ? body.angle : kNotMeasured;
  message.polar_body_angle_deviation = body.finding.isFound() ? body.deviation : kNotMeasured;
  message.others = static_cast<std::uint32_t>(cell.otherCells());
  return message;
}

cell_microinjection::PipetteInImage toMessage(const PipetteDetection& pipette) {
  cell_microinjection::PipetteInImage message;
  setFinding(pipette.finding, message);
  if (!pipette.finding.hasValues()) return message;
  message.x = pipette.end.x;
  message.y = pipette.end.y;
  setCovariance(pipette.covariance, message);
  message.direction = pipette.direction;
  message.direction_deviation = pipette.direction_deviation;
  message.half_width = pipette.half_width;
  return message;
}

cell_microinjection::IndentationInImage toMessage(const Dimple& indentation) {
  cell_microinjection::IndentationInImage message;
  setFinding(indentation.finding, message);
  const BorderDisplacement& beside = indentation.displacement;
  message.gap = beside.finding.hasValues() ? beside.gap : kNotMeasured;
  message.displacement = beside.finding.hasValues() ? beside.depth : kNotMeasured;
  message.displacement_deviation = beside.finding.hasValues() ? beside.deviation : kNotMeasured;
  if (!indentation.finding.hasValues()) return message;
  message.x = indentation.deepest.x;
  message.y = indentation.deepest.y;
  message.depth = indentation.depth;
  message.deviation = indentation.deviation;
  return message;
}

cell_microinjection::BoreInImage toMessage(const BoreBorder& border) {
  cell_microinjection::BoreInImage message;
  setFinding(border.finding, message);
  if (!border.finding.hasValues()) return message;
  message.length = border.length;
  message.deviation = border.deviation;
  return message;
}

cell_microinjection::HoldInImage toMessage(const HoldDetection& hold) {
  cell_microinjection::HoldInImage message;
  setFinding(hold.finding, message);
  if (!hold.finding.hasValues()) return message;
  message.held = hold.held;
  message.gap = hold.gap;
  message.deviation = hold.deviation;
  return message;
}

}  // namespace

cell_microinjection::VisionState toMessage(const SpecimenView& view) {
  cell_microinjection::VisionState message;
  message.cell = toMessage(view.cell);
  message.injection_pipette = toMessage(view.injection);
  message.holding_pipette = toMessage(view.holding);
  message.indentation = toMessage(view.indentation);
  message.needle_bore = toMessage(view.column);
  message.holder_bore = toMessage(view.tongue);
  message.hold = toMessage(view.hold);
  return message;
}

}  // namespace microinjection
