#include "cell/model/live_cell.h"

#include "cell/model/cell_model.h"
#include "cell/model/swept_cell.h"
#include "cell/model/tensegrity_cell.h"

namespace microinjection {

std::shared_ptr<const LiveCell> makeLiveCell(const Scene& scene) {
  if (scene.cell.tensegrity) return std::make_shared<const TensegrityCell>(scene);
  if (CellModel::refusals(scene).empty()) return std::make_shared<const CellModel>(scene);
  return std::make_shared<const SweptCell>(scene);
}

}  // namespace microinjection
