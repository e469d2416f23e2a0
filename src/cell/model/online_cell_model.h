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
  double prepare_distance = 25e-6;    ///< m above the surface at which the contact is prepared
  double extrapolation_limit = 3e-6;  ///< m of tip travel from the last solution beyond which the force is invalid
  double solution_period = 0.03;      ///< s between solutions when `fixed_period`
  /// Uses every solution exactly solution_period after its request, and waits for it if necessary:
  /// the results are the same on any machine (virtual time).
  bool fixed_period = false;

  static OnlineCellModelConfig read(ConfigReader& reader);
};

/// The live finite-element cell.
///
/// A separate thread follows the newest tip pose with the cell's equilibrium. Between solutions
/// step() extrapolates with the condensed contact stiffness, f = f_s - K (x - x_s). A contact lasts
/// from first contact until the tip is off the undeformed cell and the force would be adhesive.
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
  std::vector<BorderTriangle> borders() const override { return rest_.borders; }
  DeformedSurface deformedSurface() override;

  const TipPatch& patch() const {
    return contact_point_->patch;
  }  ///< vertices that stick to the tip, or will at first contact

 private:
  /// All data that the surface depends on.
  struct Shape {
    std::shared_ptr<const CellSolution> solution;       ///< null if undeformed
    std::shared_ptr<const ContactPoint> contact_point;  ///< null without contact
  };

  TipForce computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time);
  void receiveSolution(double time);
  void request(double time, const Eigen::Vector3d& displacement);
  void prepare(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& touch, double time);
  TipForce contactForce(double time);
  TipForce invalidForce(const char* reason);

  std::shared_ptr<const OnlineCell> cell_;
  OnlineCell::Surface rest_;
  std::vector<Member> members_at_rest_;
  OnlineCellModelConfig config_;
  SolutionThread thread_;
  int hint_ = 0;  ///< see OnlineCell::touch
  std::shared_ptr<const ContactPoint> contact_point_ = std::make_shared<ContactPoint>();
  std::optional<Eigen::Vector3d> contact_prepared_at_;  ///< m, basis of contact_point_; none before the first
  unsigned contacts_ = 0;                               ///< number of contacts that have ended
  double contact_start_ = 0;                            ///< s, of first contact
  bool request_pending_ = false;                        ///< a solution was requested and not received yet
  double requested_at_ = 0;                             ///< s
  double solution_time_ = 0;                            ///< s, at which the present solution was requested
  bool contact_requested_ = false;                      ///< the thread solves contact_point_, not an earlier one
  std::shared_ptr<const CellSolution> solution_;
  std::optional<Contact> contact_;
  std::string invalid_reason_;
  std::string failure_;       ///< error of the solver's last request; else empty
  LatestValue<Shape> shape_;  ///< from the thread that steps to the one that draws
};

}  // namespace microinjection
