#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/latest_value.h"
#include "cell/material/force_memory.h"
#include "cell/model/aspirated_membrane.h"
#include "cell/model/bore_suction.h"
#include "cell/model/cell_model.h"
#include "cell/model/crack_speed.h"
#include "cell/model/fading_force.h"
#include "cell/model/pierced_branch.h"
#include "cell/model/piezo_stroke.h"
#include "cell/model/puncture_holes.h"
#include "cell/model/scene.h"
#include "cell/model/shaft_resistance.h"
#include "cell/model/shaft_taper.h"

namespace microinjection {

/// Any cell under a needle, with membranes that fail according to scene.cell.puncture. It is a decorator, so that every
/// cell model can be punctured and none of them has to know how.
///
///             touch                layer 0 fails               the last layer fails
///     free ----------> contact ---------------------> in a hole ---------------------> through
///      ^ |            (inner cell)                     ^ (springs)                     (shaft)
///      | `-------- the needle's line meets a hole -----'     |                            |
///      `------------------ the tip is off the cell at rest <-+----------------------------'
///
/// doc/design/mechanics.md, Puncture, lists each part, doc/reference/scene_file.md the keys.
///
/// The outermost layer fails by the force, the indentation or the nominal strain of the inner
/// cell's contact. That cell then returns to rest, with a hole at the contact point, and springs and friction are all
/// that acts on the needle: only the force that breaks the zona is measured (7.5 uN at 45 um, section V.A of the
/// paper).
///
/// With a PiercedBranch the outermost layer is a solid of known toughness. It fails at the force of the branch's onset,
/// and the needle then feels the branch's force along the pipette: the hole grows with the needle, the dent stays as
/// deep as the branch has it, and its wall rubs on the shaft. A layer that is tougher for a faster needle (CrackSpeed)
/// fails at another force in each step. The branch is that of a needle on the axis; elsewhere its
/// depth is counted along the pipette. A membrane behind it lies below the surface at rest by its gap, and goes with
/// the cell: the tip meets it when the hole has come there, and presses on it through the cell's dent (Resistance).
/// Where the needle enters a hole, the force grows from nothing. It does so, too, where a layer fails before the needle
/// has given the energy that the branch has stored there: it was drawn through, a piezo has broken it, or it had only
/// resealed. Each further layer is a linear spring along the pipette from the point where the tip meets it. It was
/// dented together with the earlier layers and lies its gap ahead of the tip when they fail. It stays there while the
/// needle is in the cell; after the needle has left, all layers are at their gaps below the surface. In the cell,
/// ShaftResistance acts on the shaft. The cytoplasm begins at the innermost layer.
///
/// A tip in a hole is in the cell until it leaves through the hole, or beside it off the cell. A
/// needle line that passes within the tip's radius of a hole meets the next intact layer there;
/// elsewhere the cell is intact.
///
/// A needle with a bore draws the layer before its mouth in (BoreSuction), which then fails by its tension as its
/// aspiration says (AspiratedMembrane); behind the last layer the cytoplasm flows. A tongue of a bore is too small to
/// change the force on the needle. A hole that the needle has left reseals, if the scene says so: the cell is then
/// touched there as elsewhere, and its layers fail at a share of their limits that grows with the hole's age.
///
/// In a viscoelastic cell the branch's force has a memory (ForceMemory) as that of the whole cell has. What the whole
/// cell's force was above its elastic one at the break goes along, in proportion to what is left of the latter.
///
/// A pulse of a piezo-driven needle (StrokeResistance) is over before the hand can feel it. It adds its force to that
/// of the layer before the tip when it asks whether that fails, and its work is the piezo's.
///
/// A lost force fades (FadingForce) from its value in that step, so that the needle feels no step.
/// It returns at most the work of the needle since first contact, less what a branch has stored and its crack has
/// spent. The remaining forces are passive.
class PuncturableCell : public CellModel {
 public:
  /// `cell`: the model of the same scene's cell without a puncture. @pre scene.validate() does not throw
  /// `tongue`: of a scene whose needle has a bore, see solveBoreTongue(). Without it nothing is drawn in.
  /// `branch`: of a scene whose outermost layer has a toughness, see solvePiercedBranch(). Without it that layer does
  /// not fail. `pierced_error`: relative, of the branch's force behind the onset: one of ten has more.
  PuncturableCell(const Scene& scene, std::unique_ptr<CellModel> cell, std::optional<BoreTongue> tongue = {},
                  std::optional<PiercedBranch> branch = {}, std::optional<double> pierced_error = {});

  /// O(1), apart from the inner cell; does not allocate or lock.
  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;
  void release() override;

  void setBoreLine(const BoreLine& line) override { line_ = line; }
  void strike(const PiezoPulse& pulse) override { pulse_ = pulse; }
  const Bore* bore() const override { return bore_ ? &bore_->reading() : nullptr; }

  /// In the cell: since first contact or, in an existing hole, since the tip passed the surface.
  const std::optional<Contact>& contact() const override { return hole_ ? in_contact_ : cell_->contact(); }
  Insertion insertion() const override { return insertion_; }
  std::vector<std::string> layers() const override;
  const std::string& invalidReason() const override;
  /// In a hole, of a branch alone: what fades, springs and friction have none that is known.
  std::optional<double> forceError() const override { return force_error_; }
  std::optional<Solution> solution(double time) const override;
  std::vector<std::array<int, 3>> triangles() const override { return cell_->triangles(); }
  std::vector<std::uint32_t> held() const override { return cell_->held(); }
  std::vector<BorderTriangle> borders() const override { return cell_->borders(); }
  DeformedSurface deformedSurface() override;

 private:
  using Layer = PunctureConfig::Layer;
  struct Pose {
    Eigen::Vector3d tip, axis;
    double time, duration;
  };

  TipForce computeForce(const Pose& pose);
  void stepBore(const Pose& pose);
  void coverBore(int layer);
  TipForce contactForce(const Pose& pose);
  void followRadius();  ///< moves the holes with a surface whose radius has changed
  Eigen::Vector3d forceInside(const Pose& pose);
  std::optional<double> errorOf(const Eigen::Vector3d& force, const Pose& pose) const;
  double firstLength(double depth) const;              ///< m
  PiercedBranch::Resistance resistanceBefore() const;  ///< of the crack, before the tip in its hole
  void failByBranch(const Eigen::Vector3d& force, const Pose& pose);
  int layersWithin(double length) const;  ///< of the cell, into which a hole of this length goes
  double gapsTo(int layer) const;         ///< m, of all before it and its own, at rest
  /// N along the pipette, of the branch, whose hole grows, with its memory; and the dent that is drawn.
  double pierce(const Pose& pose);
  double openingForce(double depth, double length) const;   ///< N along the pipette, of the branch and the taper
  double openingEnergy(double depth, double length) const;  ///< J, that this force has stored since the mouth
  /// What is lost where the branch begins. @param work J, of the needle so far
  void loseToBranch(const PunctureHoles::Hole& opened, const Eigen::Vector3d& force, double work, const Pose& pose);
  void enter(int hole, const Pose& pose);
  void leave(const Pose& pose);
  void failLayer(const Pose& pose);
  /// Whether the layer before the tip fails, indented by `indentation` (m) with `push` (N along the pipette) and by the
  /// pulse.
  bool fails(const Layer& layer, double push, double indentation, double strength);
  void updateDepth(const Pose& pose);
  void touch(const Eigen::Vector3d& point, const Pose& pose);
  double strength() const { return membrane_ ? membrane_->strength() : 1; }  ///< left by suction, of the limits
  int layerCount() const { return static_cast<int>(config_.layers.size()); }
  bool isThrough() const { return holes_[*hole_].layers == layerCount(); }  ///< all layers have failed in the hole
  /// Whether the tip is off the cell at rest, relative to the hole's position on its surface.
  bool isOut(int hole, const Pose& pose) const;
  /// Distance of a tip from contact with the spherical cell at rest, m along the axis; infinite
  /// beside it.
  double clearance(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) const;
  /// Work, J, of the needle on the cell since first contact, if the tip now moves to `tip` against
  /// `force`.
  double workTo(const Eigen::Vector3d& force, const Eigen::Vector3d& tip) const;

  PunctureConfig config_;
  Scene::Tip tip_;
  double radius_;  ///< m, of the cell at rest
  std::unique_ptr<CellModel> cell_;
  ShaftResistance shaft_;
  FadingForce fading_;
  PunctureHoles holes_;
  std::optional<int> hole_;        ///< hole that the needle is in
  double next_layer_depth_ = 0;    ///< m below the surface, of the next layer; after all have failed, of the last
  double failed_at_ = 0;           ///< s, of the last failure in this hole; negative infinity before
  bool inner_force_used_ = false;  ///< the last force was computed by the inner cell
  BoreLine line_;
  std::optional<PiezoPulse> pulse_;  ///< of the next step
  std::optional<PiercedBranch> branch_;
  std::optional<CrackSpeed> crack_;  ///< of the branch
  std::optional<ShaftTaper> taper_;  ///< same
  ForceMemory memory_;               ///< of the branch's force
  double lost_at_border_ = 0;        ///< N, of the branch in this step: the hole has come into the cell's next layer
  std::optional<double> pierced_error_, force_error_;
  double mouth_from_ = 0;  ///< m below the surface, where the needle has entered the hole by the branch
  std::optional<BoreSuction> bore_;
  std::optional<AspiratedMembrane> membrane_;  ///< of the layer before the mouth that suction can break
  int covering_ = -1;                          ///< that layer; the count of layers: cytoplasm; -1: none
  bool drawn_through_ = false;                 ///< the membrane has broken by suction in this step
  std::optional<int> resealed_;                ///< hole that has closed where the needle touches
  double strength_ = 1;                        ///< share of the limits that this hole has regained
  double work_ = 0;                            ///< J, see workTo()
  Eigen::Vector3d last_force_ = Eigen::Vector3d::Zero(), last_tip_ = Eigen::Vector3d::Zero();
  std::optional<double> last_time_;  ///< s
  Insertion insertion_;
  std::optional<Contact> in_contact_;
  std::string invalid_reason_;
  LatestValue<PunctureHoles> published_holes_;  ///< from the thread that steps to the one that draws
};

}  // namespace microinjection
