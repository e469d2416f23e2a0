#pragma once

#include <Eigen/Core>

namespace microinjection {

/// How far one has pressed into what is touched, and how stiff it is.
class ContactDisplacement {
 public:
  /// `contact_force` (N): below it nothing is touched.
  explicit ContactDisplacement(double contact_force) : contact_force_(contact_force) {}

  void reset() { *this = ContactDisplacement(contact_force_); }
  void move(const Eigen::Vector3d& way) { way_ += way; }  ///< m, since the call before
  void touch(const Eigen::Vector3d& force);               ///< N, of what is touched
  bool isTouching() const { return touched_ >= contact_force_; }
  double pressed() const { return pressed_; }  ///< J, force times way since the touch
  /// N/m, force over way; 0: nothing is touched, infinite: it is touched where the way began.
  double stiffness() const;

 private:
  double contact_force_;
  double touched_ = 0;                             // N
  double pressed_ = 0;                             // J
  Eigen::Vector3d way_ = Eigen::Vector3d::Zero();  // m, since the touch
};

}  // namespace microinjection
