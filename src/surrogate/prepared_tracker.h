#pragma once

#include <memory>
#include <string>

#include "cell/cell_under_needle.h"
#include "surrogate/prepared_contact.h"

namespace microinjection {

/// The prepared cell under a moving needle: converged force at every step, in microseconds. Out of the prepared range,
/// or with a needle that is not upright, it trusts nothing. A force along the pipette of scene.cell.puncture_force
/// punctures the cell for good.
class PreparedTracker : public CellUnderNeedle {
 public:
  PreparedTracker(const Scene& scene, std::shared_ptr<const PreparedCell> cell);

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;

  const std::optional<Contact>& contact() const override { return contact_; }
  bool punctured() const override { return punctured_; }
  const std::string& distrust() const override { return distrust_; }
  std::optional<Solution> solution(double time) const override;
  std::vector<std::array<int, 3>> triangles() const override;
  std::vector<std::uint32_t> held() const override;
  Picture picture() const override;

 private:
  TipForce distrustBecause(const char* reason);

  Scene scene_;
  std::shared_ptr<const PreparedCell> cell_;
  PreparedContact needle_;
  std::optional<Contact> contact_;
  Eigen::Matrix3d stiffness_ = Eigen::Matrix3d::Zero();  ///< N/m
  bool punctured_ = false;
  std::string distrust_;
};

}  // namespace microinjection
