#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "cell/contact/rounded_tip.h"
#include "cell/model/contact_frame.h"
#include "cell/surrogate/passive_correction.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// On-line contact of a surrogate cell with a moving needle. Stores the contact point; does not
/// allocate after its construction. The needle's axis is vertical.
///
///     tip --> overlap with the cell at rest --> first touch: contact frame, fit at this contact point
///      |                                                         |
///      `------> displacement u in the contact frame <------------'
///                 |
///                 +--> limited to the range (LimitedDisplacement) --> energy's gradient, force field
///                 +--> fade at the end of the contact             --> PassiveCorrection --> force, stiffness
///
/// Force field and energy are both needed. The field is several times more exact, because the force of a sticking tip
/// depends on its path and is no gradient (median error 0.23 % against 1.1 % of the energy alone:
/// doc/reference/benchmarks.md, A surrogate cell), but a field alone may create energy on a closed path, which the hand
/// would feel as a cell that pushes by itself. PassiveCorrection adds of the field what the needle has paid for.
///
/// A contact ends when the tip is off the cell at rest by 5 % of its displacement, and not at the surface at rest,
/// because a surface that sticks follows the tip a little beyond its place. From 2 % on the energy falls to zero, so
/// that the force ends continuously.
class SurrogateContact {
 public:
  struct Result {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< N, of the cell on the needle
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, d(force)/d(tip) = -stiffness
    bool prepared = true;                                 ///< false: outside of the surrogate's range; the force fades
    bool too_deep = false;                                ///< deeper than the surrogate's range
  };

  /// All data that the surface depends on.
  struct Shape {
    const SurrogateData* cell = nullptr;                     ///< identifies it
    double angle = 0;                                        ///< rad, of the contact point
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< from the contact frame to the cell's
    Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, of the tip, in the contact frame
  };

  /// `cell`: prepared for this scene, in its units (SI). Throws ConfigError for a bad radius of the tip.
  SurrogateContact(const Scene& scene, std::shared_ptr<const SurrogateData> cell);

  /// `tip` (its lowest point, or the disc's centre): m, relative to the cell's centre.
  Result step(const Eigen::Vector3d& tip);

  /// Removes the contact; the next step may begin a new one, elsewhere.
  void reset();

  /// Takes over the contact of another cell, before the first step. It keeps its place: the surface
  /// of a cell of another size is where it was, until the needle is clear of both. Does not
  /// allocate.
  void continueFrom(const SurrogateContact& other);
  double energy() const { return energy_; }  ///< J, stored in the cell in the last step
  double radius() const { return radius_; }  ///< m, of the surface at rest that the needle touches
  const Scene& scene() const { return scene_; }
  const std::shared_ptr<const SurrogateData>& cell() const { return cell_; }

  const std::optional<ContactFrame>& contactFrame() const { return contact_frame_; }
  Eigen::Vector3d displacement() const { return displacement_; }  ///< m, of the tip, in the contact frame

  Shape shape() const;
  /// Surface of `cell` for display: positions of its nodes at rest and their displacement, m, in the
  /// frame of the cell. Allocates. Any thread may call it at any time.
  static void surface(const SurrogateData& cell, const Shape& shape, Eigen::Matrix3Xd& at_rest,
                      Eigen::Matrix3Xd& displaced);

 private:
  struct Local {
    Jet energy;                                           ///< J, by the displacement
    Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< N, of the field
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, of the field
  };
  /// m, of the tip with a cell of `radius` at rest.
  Jet overlap(const Eigen::Vector3d& tip, double radius) const;
  void makeLocals(double angle);
  Local evaluate(const Jet& overlap);  ///< in the contact frame; sets prepared_

  Scene scene_;
  double radius_;
  std::optional<RoundedTip> shape_;
  std::shared_ptr<const SurrogateData> cell_;
  EnergyExpansion::Local local_energy_;
  ForceField::Local local_field_;
  PassiveCorrection correction_;
  std::optional<ContactFrame> contact_frame_;
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();
  bool prepared_ = true, too_deep_ = false;
  double energy_ = 0;
};

}  // namespace microinjection
