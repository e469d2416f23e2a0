#include "cell/model/disc_contact_cell.h"

#include <algorithm>

namespace microinjection {

std::optional<SurfaceHit> DiscContactCell::hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                               int start) const {
  return castRayFrom(surface_, start, origin, direction);
}

TipPatch DiscContactCell::patchAt(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) const {
  return findTipPatch(surface_, point, axis, scene_.needle.tip.radius);
}

std::optional<Eigen::Vector3d> DiscContactCell::touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                                      int& hint) const {
  const double outside = 2 * scene_.cell.diameter();
  const Eigen::Vector3d origin = tip + (outside + tip.norm()) * axis;  // outside of the cell for any tip position
  const auto found = hit(origin, -axis, hint);
  if (!found) return std::nullopt;
  hint = found->triangle;
  return found->point;
}

bool DiscContactCell::isClear(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                              const Eigen::Vector3d& contact_point) const {
  if ((tip - contact_point).dot(axis) > 0) return true;
  int hint = 0;
  const auto now = touch(tip, axis, hint);  // at its present line: it may have moved sideways
  return !now || (tip - *now).dot(axis) > 0;
}

ContactPoint DiscContactCell::contactAt(const Eigen::Vector3d& contact_point, const Eigen::Vector3d& axis) const {
  return {contact_point, patchAt(contact_point, axis)};
}

LiveCell::Surface DiscContactCell::undeformedSurface() const {
  return {surface_.vertices, surface_.triangles, onSurface({held_vertices_}), {}, {}};
}

std::vector<std::uint32_t> DiscContactCell::onSurface(const TipPatch& patch) const {
  std::vector<std::uint32_t> result;
  for (const int vertex : patch.vertices) {
    const auto found = std::lower_bound(surface_.mesh_vertices.begin(), surface_.mesh_vertices.end(), vertex);
    if (found != surface_.mesh_vertices.end() && *found == vertex)
      result.push_back(static_cast<std::uint32_t>(found - surface_.mesh_vertices.begin()));
  }
  return result;
}

}  // namespace microinjection
