#pragma once

#include <memory>
#include <string>

#include "base/latest_value.h"
#include "cell/model/cell_model.h"
#include "cell/surrogate/force_memory.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {

/// The prepared cell under a moving needle: converged force at every step, in microseconds. Beside
/// the prepared range the force fades, which is reported. The force is invalid for a needle that is
/// not upright, that touches too far from the pole, or that moves deeper below the range, where a
/// fading force would feel like a puncture; a needle that has rested there may be withdrawn. A
/// viscoelastic cell's force relaxes, and never pulls along the pipette. A step does not allocate
/// or lock.
class SurrogateCellModel : public CellModel {
 public:
  SurrogateCellModel(const Scene& scene, std::shared_ptr<const SurrogateData> cell);

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;

  void release() override;

  const std::optional<Contact>& contact() const override { return contact_; }
  const std::string& invalidReason() const override { return invalid_reason_; }
  std::optional<Solution> solution(double time) const override;
  std::vector<std::array<int, 3>> triangles() const override;
  std::vector<std::uint32_t> held() const override;
  DeformedSurface deformedSurface() override;

 private:
  TipForce computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double duration);
  TipForce invalidForce(const char* reason);
  bool continuesBelow(bool too_deep, double duration);

  Scene scene_;
  std::shared_ptr<const SurrogateData> cell_;
  SurrogateContact needle_;
  ForceMemory memory_;
  double time_ = 0;  ///< s, of the last step
  std::optional<Contact> contact_;
  double deepest_ = 0;                                   ///< m, deepest indentation below the range
  double rested_ = 0;                                    ///< s, without moving deeper there
  Eigen::Matrix3d stiffness_ = Eigen::Matrix3d::Zero();  ///< N/m
  std::string invalid_reason_;
  LatestValue<SurrogateContact::Shape> shape_;  ///< from the thread that steps to the one that draws
};

}  // namespace microinjection
