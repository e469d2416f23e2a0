#include "cell/model/live_cell.h"

#include "cell/model/live_fem_cell.h"
#include "cell/model/p1_cell.h"
#include "cell/model/tensegrity_cell.h"

namespace microinjection {

double tremorAllowance(const Scene::Needle& needle) { return 0.1 * needle.tip.radius; }

Eigen::Vector3d snapToNeedleLine(const Scene::Needle& needle, const Eigen::Vector3d& touch) {
  Eigen::Vector3d point = touch;
  if ((point.head<2>() - needle.offset).norm() < tremorAllowance(needle)) point.head<2>() = needle.offset;
  return point;
}

std::shared_ptr<const LiveCell> makeLiveCell(const Scene& scene) {
  if (scene.cell.tensegrity) return std::make_shared<const TensegrityCell>(scene);
  if (P1Cell::refusals(scene).empty()) return std::make_shared<const P1Cell>(scene);
  return std::make_shared<const LiveFemCell>(scene);
}

}  // namespace microinjection
