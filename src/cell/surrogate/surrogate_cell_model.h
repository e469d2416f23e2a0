#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/latest_value.h"
#include "cell/material/force_memory.h"
#include "cell/model/cell_model.h"
#include "cell/surrogate/changing_contact.h"
#include "cell/surrogate/surrogate_contact.h"
#include "cell/surrogate/work_limit.h"

namespace microinjection {

/// The surrogate cell under a moving needle: converged force at every step, in microseconds. A hand needs a force every
/// millisecond, whereas a live solution takes 95 ms and is some per cent off (LiveFemCell). So the equilibria are
/// solved before the session (SurrogatePlan) and fitted, and a step evaluates the fit (SurrogateContact): 0.41 % off
/// (median, 1.7 % at the worst) at 32 places without training, in 2.8 us (doc/reference/benchmarks.md, A surrogate
/// cell).
///
///     tip --> ChangingContact --> + ForceMemory --> no pull along --> WorkLimit --> force
///             one cell, or two     Prony terms      the pipette      after a change
///             while it changes                                       of the cell
///
/// Beside the surrogate's range the force fades, which is reported. The force is invalid for a needle that is
/// not upright, that touches too far from the pole, or that moves deeper below the range, where a
/// fading force would feel like a puncture; a needle that has rested there may be withdrawn. A
/// viscoelastic cell's force relaxes, and never pulls along the pipette. A step does not allocate
/// or lock: what the surface depends on is published as a small value (LatestValue), and a cell that was replaced is
/// freed by the next change(), in the thread that calls it.
class SurrogateCellModel : public CellModel {
 public:
  /// What the error of the data does not have in it.
  struct MoreError {
    double more = 0;            ///< relative, to be added
    bool on_axis_only = false;  ///< beside the axis no error is known
  };

  /// `cell`: prepared for this scene, in SI units. @pre SurrogatePlan::check(scene) does not throw
  SurrogateCellModel(const Scene& scene, std::shared_ptr<const SurrogateData> cell);
  SurrogateCellModel(const Scene& scene, std::shared_ptr<const SurrogateData> cell, const MoreError& error);

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;

  void release() override;

  /// Serves another cell from the next step on, as ChangingContact does. The relaxation times stay.
  /// Call it in one ordinary thread at a time.
  void change(const Scene& scene, std::shared_ptr<const SurrogateData> cell);

  const std::optional<Contact>& contact() const override { return contact_; }
  std::optional<double> radius() const override { return needle_.felt().radius(); }
  const std::string& invalidReason() const override { return invalid_reason_; }
  std::optional<double> forceError() const override { return force_error_; }
  std::optional<Solution> solution(double time) const override;
  std::vector<std::array<int, 3>> triangles() const override;
  std::vector<std::uint32_t> held() const override;
  DeformedSurface deformedSurface() override;

 private:
  TipForce computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double duration);
  TipForce invalidForce(const char* reason);
  bool continuesBelow(bool too_deep, double duration);
  std::optional<double> errorOf(const TipForce& force, const Eigen::Vector3d& axis) const;

  /// A cell that is or was served.
  struct Served {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const SurrogateData> cell;
  };
  Served served(const SurrogateData* cell);

  ChangingContact needle_;
  ForceMemory memory_;
  WorkLimit limit_;
  double time_ = 0;  ///< s, of the last step
  std::optional<Contact> contact_;
  double deepest_ = 0;                                   ///< m, deepest indentation below the range
  double rested_ = 0;                                    ///< s, without moving deeper there
  Eigen::Matrix3d stiffness_ = Eigen::Matrix3d::Zero();  ///< N/m
  std::string invalid_reason_;
  std::optional<double> force_error_;           ///< N
  bool changing_ = false;                       ///< from one cell to another
  LatestValue<SurrogateContact::Shape> shape_;  ///< from the thread that steps to the one that draws
  std::mutex served_mutex_;                     ///< of the ordinary threads; the one that steps never takes it
  std::vector<Served> served_;                  ///< the last few, newest last
  MoreError more_error_;
};

}  // namespace microinjection
