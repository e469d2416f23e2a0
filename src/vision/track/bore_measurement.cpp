#include "vision/track/bore_measurement.h"

namespace microinjection {

void measureBores(const Frame& frame, ContrastMode mode, SpecimenView& view) {
  view.hold = detectHold(view.cell, view.holding);
  view.column = findColumn(frame, view.injection);
  view.tongue = BoreBorder();
  view.tongue.finding = Finding::notFound("no cell was found");
  if (view.cell.finding.hasValues())
    view.tongue = findTongue(frame, view.holding, view.cell.zona_outer.finding.hasValues());
  // An outline that misses the mouth, in which something is seen, may not be the cell's outermost one.
  const bool contradicted = view.tongue.finding.hasValues() && view.hold.finding.isFound() && !view.hold.held;
  if (contradicted) view.hold.finding = Finding::uncertain("something is seen in the mouth");
  if (view.tongue.finding.isFound() && !(view.hold.held && view.hold.finding.isFound()))
    view.tongue.finding = Finding::uncertain("that the cell is at the mouth is not sure");
  if (mode == ContrastMode::kBrightField || mode == ContrastMode::kUnknown) return;
  for (BoreBorder* border : {&view.column, &view.tongue}) {
    if (border->finding.isFound())
      border->finding = Finding::uncertain("the bore's border is known in bright field only");
  }
}

}  // namespace microinjection
