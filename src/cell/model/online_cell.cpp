#include "cell/model/online_cell.h"

#include "cell/model/online_fem_cell.h"
#include "cell/model/p1_cell.h"
#include "cell/model/tensegrity_cell.h"

namespace microinjection {

std::shared_ptr<const OnlineCell> makeOnlineCell(const Scene& scene) {
  if (scene.cell.tensegrity) return std::make_shared<const TensegrityCell>(scene);
  if (P1Cell::refusals(scene).empty()) return std::make_shared<const P1Cell>(scene);
  return std::make_shared<const OnlineFemCell>(scene);
}

}  // namespace microinjection
