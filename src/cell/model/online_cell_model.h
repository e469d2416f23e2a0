#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "base/latest_value.h"
#include "cell/model/cell_model.h"
#include "cell/model/online_cell.h"
#include "cell/model/solution_thread.h"

namespace microinjection {

struct OnlineCellModelConfig {
  double prepare_distance = 25e-6;    ///< m before the surface at which the contact is prepared
  double extrapolation_limit = 3e-6;  ///< m of tip travel from the last solution past which force is not valid
  double solution_period = 0.03;      ///< s between solutions when `fixed_period`
  bool fixed_period = false;          ///< take every solution exactly solution_period after it was asked for, waiting
                                      ///< for it if need be: same answers on any machine (lock step)

  static OnlineCellModelConfig read(ConfigReader& reader);
};

/// The live finite-element cell.
///
/// A thread of its own follows the newest tip pose with the cell's equilibrium; between solutions step() extrapolates
/// with the condensed contact stiffness, f = f_s - K (x - x_s). A contact lasts from the touch until the tip is off the
/// undeformed cell and the pull would be adhesive.
class OnlineCellModel : public CellModel {
 public:
  OnlineCellModel(std::shared_ptr<const OnlineCell> cell, const OnlineCellModelConfig& config);

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;

  void release() override;

  const std::optional<Contact>& contact() const override { return contact_; }
  const std::string& invalidReason() const override { return invalid_reason_; }
  std::optional<Solution> solution(double time) const override;
  std::vector<std::array<int, 3>> triangles() const override;
  std::vector<std::uint32_t> held() const override;
  DeformedSurface deformedSurface() override;

  const TipPatch& patch() const { return place_->patch; }  ///< that sticks to the tip, or will on touch

 private:
  /// All that the picture depends on.
  struct Shape {
    std::shared_ptr<const CellSolution> solution;  ///< null where nothing is deformed
    std::shared_ptr<const ContactPoint> touched;   ///< null without contact
  };

  TipForce computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time);
  void takeSolution(double time);
  void request(double time, const Eigen::Vector3d& displacement);
  void prepare(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& touch, double time);
  TipForce touchForce(double time);
  TipForce invalidForce(const char* reason);

  std::shared_ptr<const OnlineCell> cell_;
  OnlineCell::Surface rest_;
  std::vector<Member> members_at_rest_;
  OnlineCellModelConfig config_;
  SolutionThread thread_;
  int hint_ = 0;  ///< see OnlineCell::touch
  std::shared_ptr<const ContactPoint> place_ = std::make_shared<ContactPoint>();
  std::optional<Eigen::Vector3d> contact_prepared_at_;  ///< m, what place_ was made for; none until a needle was near
  unsigned contacts_ = 0;                               ///< that have ended
  double touched_ = 0;                                  ///< s, when the tip touched
  bool asked_ = false;                                  ///< a solution is under way
  double requested_at_ = 0;                             ///< s
  double solution_time_ = 0;                            ///< s, when the solution at hand was asked for
  bool contact_requested_ = false;                      ///< the thread works on place_, not on an older one
  std::shared_ptr<const CellSolution> solution_;
  std::optional<Contact> contact_;
  std::string invalid_reason_;
  std::string failure_;       ///< what the solver threw at the last question; else empty
  LatestValue<Shape> shape_;  ///< from the thread that steps to the one that draws
};

}  // namespace microinjection
