#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "contact/rounded_tip.h"
#include "surrogate/contact_place.h"
#include "surrogate/prepared_cell.h"

namespace microinjection {

/// The on-line stage: what a prepared cell does to a moving needle. Keeps where the tip touched; allocates nothing
/// after its making. The needle's axis is vertical.
class PreparedContact {
 public:
  struct Answer {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< N, of the cell on the needle
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, d(force)/d(tip) = -stiffness
    bool prepared = true;  ///< false: out of the prepared range; the force is that at its border
  };

  PreparedContact(const Scene& scene, std::shared_ptr<const PreparedCell> cell);

  /// For the tip (its lowest point, or the disc's centre) at `tip`, m, the cell's centre being the origin.
  Answer step(const Eigen::Vector3d& tip);

  /// Not touched.
  void reset() { place_.reset(); }

  const std::optional<ContactPlace>& place() const { return place_; }
  Eigen::Vector3d displacement() const { return displacement_; }  ///< m, of the tip, in the frame of the place
  double storedEnergy() const { return energy_; }                 ///< J

  /// Surface for people: places of its nodes at rest and their displacement, m, in the frame of the cell. Allocates.
  void surface(Eigen::Matrix3Xd& at_rest, Eigen::Matrix3Xd& displaced) const;

 private:
  bool overlaps(const Eigen::Vector3d& tip) const;

  Scene scene_;
  std::optional<RoundedTip> shape_;
  std::shared_ptr<const PreparedCell> cell_;
  EnergyExpansion::Local local_;
  std::optional<ContactPlace> place_;
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();
  double energy_ = 0;
};

}  // namespace microinjection
