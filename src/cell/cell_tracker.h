#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "cell/cell_model.h"
#include "cell/solution_thread.h"

namespace microinjection {

struct CellTrackerConfig {
  double prepare_distance = 25e-6;    ///< m before the surface at which the contact is prepared
  double extrapolation_limit = 3e-6;  ///< m of tip travel from the last solution past which force is not trusted
  double solution_period = 0.03;      ///< s between solutions when `fixed_period`
  bool fixed_period = false;          ///< take every solution exactly solution_period after it was asked for, waiting
                                      ///< for it if need be: same answers on any machine (lock step)

  static CellTrackerConfig read(ConfigReader& reader);
};

/// What the cell does to the needle now.
struct TipForce {
  bool trusted = true;  ///< false: no converged solution near the tip pose; `force` is then zero
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the tip
};

/// The cell under a moving needle, at the needle's rate: contact, force and puncture.
///
/// A thread of its own solves the cell's equilibrium for the newest tip pose; between solutions step() extrapolates
/// with the condensed contact stiffness, f = f_s - K (x - x_s). The surface vertices under the tip stick to it from
/// touch until the pull would be adhesive; a force along the pipette of scene.cell.puncture_force punctures the cell
/// for good.
class CellTracker {
 public:
  struct Contact {
    Eigen::Vector3d touched_at = Eigen::Vector3d::Zero();    ///< m, where the tip met the surface
    Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, of the tip since then
    double indentation = 0;                                  ///< m, along the pipette into the cell
  };

  CellTracker(std::shared_ptr<const CellModel> cell, const CellTrackerConfig& config);

  /// Force for the tip at `tip` (m) with the pipette along `axis` (unit, out of the cell) at `time` (s, increasing).
  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time);

  const CellModel& cell() const { return *cell_; }
  const std::optional<Contact>& contact() const { return contact_; }
  const TipPatch& patch() const { return patch_; }  ///< that sticks to the tip, or will on touch
  bool punctured() const { return punctured_; }
  const std::string& distrust() const { return distrust_; }  ///< why the last force was not trusted; else empty
  /// Newest solution for the present patch; null before the first one.
  const std::shared_ptr<const CellSolution>& solution() const { return solution_; }
  double solutionAge(double time) const { return time - solution_time_; }  ///< s

 private:
  void collect(double time);
  void ask(double time, const Eigen::Vector3d& displacement);
  void prepare(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const SurfaceHit& hit, double time);
  TipForce touchForce(double time);
  TipForce distrustBecause(const std::string& reason);
  void release();

  std::shared_ptr<const CellModel> cell_;
  CellTrackerConfig config_;
  SolutionThread thread_;
  int start_triangle_ = 0;
  TipPatch patch_;
  Eigen::Vector3d patch_at_ = Eigen::Vector3d::Zero();  ///< m, what patch_ was made for
  bool asked_ = false;                                  ///< a solution is under way
  double asked_at_ = 0;                                 ///< s
  double solution_time_ = 0;                            ///< s, when the solution at hand was asked for
  bool patch_asked_ = false;                            ///< the thread works on patch_, not on an older one
  std::shared_ptr<const CellSolution> solution_;
  std::optional<Contact> contact_;
  bool punctured_ = false;
  std::string distrust_;
  std::string failure_;  ///< what the solver threw at the last question; else empty
};

}  // namespace microinjection
