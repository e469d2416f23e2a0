#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Displacement since the beginning of a contact, the work done along it, and the apparent
/// stiffness.
class ContactDisplacement {
 public:
  /// Forces below `contact_force` (N) count as no contact.
  explicit ContactDisplacement(double contact_force) : contact_force_(contact_force) {}

  void reset() { *this = ContactDisplacement(contact_force_); }
  void move(const Eigen::Vector3d& step) { displacement_ += step; }  ///< m, since the last call
  void setForce(const Eigen::Vector3d& force);                       ///< N, of the touched body
  bool isTouching() const { return force_ >= contact_force_; }
  double contactWork() const { return contact_work_; }  ///< J, force times displacement since contact
  /// N/m, force over displacement. 0: no contact; infinite: contact without displacement.
  double stiffness() const;

 private:
  double contact_force_;
  double force_ = 0;                                        // N
  double contact_work_ = 0;                                 // J
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();  // m, since contact
};

}  // namespace microinjection
