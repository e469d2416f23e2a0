#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cell/model/cell_model.h"

namespace microinjection {

/// A ball that a point-like tip from above meets as a spring, the same in all directions, from where it touched.
class SpringCell : public CellModel {
 public:
  SpringCell(double radius, double stiffness) : radius_(radius), stiffness_(stiffness) {}  ///< m, N/m

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double /*time*/) override {
    const double aside = tip.head<2>().norm();
    const double height = aside < radius_ ? std::sqrt(radius_ * radius_ - aside * aside) : -radius_;
    if (tip.z() >= height || aside >= radius_) contact_.reset();
    if (tip.z() >= height || aside >= radius_) return {};
    const Eigen::Vector3d touch =
        aside < snap ? Eigen::Vector3d(0, 0, radius_) : Eigen::Vector3d(tip.x(), tip.y(), height);
    if (!contact_) contact_ = Contact{touch, Eigen::Vector3d::Zero(), 0};
    contact_->displacement = tip - contact_->contact_point;
    contact_->indentation = -contact_->displacement.dot(axis);
    const double stiffness = (1 + viscous) * stiffness_;
    return {valid, valid ? Eigen::Vector3d(-stiffness * contact_->displacement) : Eigen::Vector3d::Zero()};
  }
  void release() override {
    contact_.reset();
    ++released;
  }

  const std::optional<Contact>& contact() const override { return contact_; }
  std::optional<double> forceError() const override { return error; }
  const std::string& invalidReason() const override { return invalid_reason_; }
  std::optional<Solution> solution(double /*time*/) const override { return std::nullopt; }
  std::vector<std::array<int, 3>> triangles() const override { return {}; }
  std::vector<std::uint32_t> held() const override { return {}; }
  DeformedSurface deformedSurface() override { return {}; }

  bool valid = true;
  int released = 0;
  std::optional<double> error;  ///< N
  double viscous = 0;           ///< of the elastic force, in addition
  double snap = 0;              ///< m, from the axis: a touch within it is on the axis, as that of a live cell

 private:
  double radius_, stiffness_;
  std::optional<Contact> contact_;
  std::string invalid_reason_;
};

}  // namespace microinjection
