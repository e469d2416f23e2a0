#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "base/latest_value.h"
#include "cell/cell_under_needle.h"
#include "cell/live_cell.h"
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

/// The live finite-element cell.
///
/// A thread of its own solves the cell's equilibrium for the newest tip pose; between solutions step() extrapolates
/// with the condensed contact stiffness, f = f_s - K (x - x_s). The surface vertices under the tip stick to it from
/// touch until the pull would be adhesive; a force along the pipette of scene.cell.puncture_force punctures the cell
/// for good.
class CellTracker : public CellUnderNeedle {
 public:
  CellTracker(std::shared_ptr<const LiveCell> cell, const CellTrackerConfig& config);

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;

  const std::optional<Contact>& contact() const override { return contact_; }
  bool punctured() const override { return punctured_; }
  const std::string& distrust() const override { return distrust_; }
  std::optional<Solution> solution(double time) const override;
  std::vector<std::array<int, 3>> triangles() const override;
  std::vector<std::uint32_t> held() const override;
  Picture picture() override;

  const LiveCell& cell() const { return *cell_; }
  const TipPatch& patch() const { return *patch_; }  ///< that sticks to the tip, or will on touch

 private:
  /// All that the picture depends on.
  struct Shape {
    std::shared_ptr<const CellSolution> solution;  ///< null where nothing is deformed
    std::shared_ptr<const TipPatch> touched;       ///< null without contact
  };

  TipForce answer(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time);
  void collect(double time);
  void ask(double time, const Eigen::Vector3d& displacement);
  void prepare(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const SurfaceHit& hit, double time);
  TipForce touchForce(double time);
  TipForce distrustBecause(const char* reason);
  std::vector<std::uint32_t> onSurface(const std::vector<int>& mesh_vertices) const;
  void release();

  std::shared_ptr<const LiveCell> cell_;
  CellTrackerConfig config_;
  SolutionThread thread_;
  int start_triangle_ = 0;
  std::shared_ptr<const TipPatch> patch_ = std::make_shared<TipPatch>();
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
  std::vector<Member> members_at_rest_;
  LatestValue<Shape> shape_;  ///< from the thread that steps to the one that draws
};

}  // namespace microinjection
