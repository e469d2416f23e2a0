#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/latest_value.h"
#include "cell/model/cell_model.h"
#include "cell/model/fading_force.h"
#include "cell/model/puncture_holes.h"
#include "cell/model/scene.h"
#include "cell/model/shaft_resistance.h"

namespace microinjection {

/// Any cell under a needle, with membranes that fail as scene.cell.puncture says, and what follows.
///
/// The outermost layer fails by the force, the indentation or the nominal strain of the inner cell's contact. That cell
/// then springs back to rest, with a hole where it was touched. Each further layer is a linear spring along the pipette
/// from where the tip meets it: it was dented along with the layers before and lies its gap ahead of the tip when they
/// fail; while the needle is in the cell it stays there, and when it has left, all layers are their gaps below the
/// surface. In the cell the shaft feels ShaftResistance; the cytoplasm begins at the innermost layer.
///
/// A tip in a hole is in the cell until it leaves: through the hole, or off the cell beside it. A line through a hole,
/// within the tip's radius, meets the next layer that is left there; elsewhere the cell is whole.
///
/// Where a force is lost it fades (FadingForce) from what it was in that step, so that the needle feels no step. It
/// returns at most the work that the needle has done since it touched. What is then left is passive by itself.
class PuncturableCell : public CellModel {
 public:
  PuncturableCell(const Scene& scene, std::unique_ptr<CellModel> cell);

  /// O(1), but for the inner cell; neither allocates nor locks.
  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;
  void release() override;

  /// In the cell: since the tip touched the surface or, in an old hole, passed it.
  const std::optional<Contact>& contact() const override { return hole_ ? in_contact_ : cell_->contact(); }
  Insertion insertion() const override { return insertion_; }
  std::vector<std::string> layers() const override;
  const std::string& invalidReason() const override;
  std::optional<Solution> solution(double time) const override;
  std::vector<std::array<int, 3>> triangles() const override { return cell_->triangles(); }
  std::vector<std::uint32_t> held() const override { return cell_->held(); }
  DeformedSurface deformedSurface() override;

 private:
  using Layer = PunctureConfig::Layer;
  struct Pose {
    Eigen::Vector3d tip, axis;
    double time, duration;
  };

  TipForce computeForce(const Pose& pose);
  TipForce touch(const Pose& pose);
  Eigen::Vector3d forceInside(const Pose& pose);
  void enter(int hole, const Pose& pose);
  void leave(const Pose& pose);
  void failLayer(const Pose& pose);
  void updateDepth(const Pose& pose);
  int layerCount() const { return static_cast<int>(config_.layers.size()); }
  bool isThrough() const { return holes_[*hole_].layers == layerCount(); }  ///< all layers, where the needle is
  /// Whether the tip is off the cell at rest, as far as the hole's place is on its surface.
  bool isOut(int hole, const Pose& pose) const;
  /// m along the axis, of a tip from where it touches the round cell at rest; infinite beside it.
  double clearance(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) const;
  /// J, of the needle on the cell since it touched, when it now comes to `tip` against `force`.
  double workTo(const Eigen::Vector3d& force, const Eigen::Vector3d& tip) const;

  PunctureConfig config_;
  Scene::Tip tip_;
  double radius_;  ///< m, of the cell
  std::unique_ptr<CellModel> cell_;
  ShaftResistance shaft_;
  FadingForce fading_;
  PunctureHoles holes_;
  std::optional<int> hole_;        ///< hole that the needle is in
  double next_layer_depth_ = 0;    ///< m below the surface, where the next layer lies; once all failed: lay the last
  double failed_at_ = 0;           ///< s, when the last layer here failed; negative infinity: before the needle came in
  bool inner_force_used_ = false;  ///< the last force is the inner cell's
  double work_ = 0;                ///< J, see workTo()
  Eigen::Vector3d last_force_ = Eigen::Vector3d::Zero(), last_tip_ = Eigen::Vector3d::Zero();
  std::optional<double> last_time_;  ///< s
  Insertion insertion_;
  std::optional<Contact> in_contact_;
  std::string invalid_reason_;
  LatestValue<PunctureHoles> shown_;  ///< from the thread that steps to the one that draws
};

}  // namespace microinjection
