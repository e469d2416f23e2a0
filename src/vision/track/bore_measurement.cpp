#include "vision/track/bore_measurement.h"

namespace microinjection {

void measureBores(const Frame& frame, ContrastMode mode, SpecimenView& view) {
  view.hold = cellHold(view.cell, view.holding);
  view.column = findColumn(frame, view.injection);
  view.tongue = BoreBorder();
  view.tongue.finding = Finding::notFound("no cell is at the mouth");
  if (view.hold.held) view.tongue = findTongue(frame, view.holding, view.cell.zona_outer.finding.hasValues());
  if (view.hold.held && !view.hold.finding.isFound() && view.tongue.finding.isFound())
    view.tongue.finding = view.hold.finding;
  if (mode == ContrastMode::kBrightField || mode == ContrastMode::kUnknown) return;
  for (BoreBorder* border : {&view.column, &view.tongue}) {
    if (border->finding.isFound())
      border->finding = Finding::uncertain("the bore's border is known in bright field only");
  }
}

}  // namespace microinjection
