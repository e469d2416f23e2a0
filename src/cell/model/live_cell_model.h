#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "base/latest_value.h"
#include "cell/model/cell_model.h"
#include "cell/model/live_cell.h"
#include "cell/model/solution_thread.h"

namespace microinjection {

struct LiveCellModelConfig {
  double prepare_distance = 25e-6;    ///< m above the surface at which the contact is prepared
  double extrapolation_limit = 3e-6;  ///< m of tip travel from the last solution beyond which the force is invalid
  double solution_period = 0.03;      ///< s between solutions when `fixed_period`
  /// Uses every solution exactly solution_period after its request, and waits for it if necessary:
  /// the results are the same on any machine (virtual time).
  bool fixed_period = false;

  /// Reads the three lengths and times; `fixed_period` follows from the session's clock.
  static LiveCellModelConfig read(ConfigReader& reader);
};

/// Serves a needle at 1 kHz with a LiveCell, whose solutions take far longer: 20 to 50 ms of P1Cell, 95 ms (median) of
/// LiveFemCell (doc/reference/benchmarks.md, Live cells).
///
/// A separate thread follows the newest tip position x_s with the cell's equilibrium. Between solutions step()
/// extrapolates with the condensed contact stiffness K of the last one,
///
///     f = f_s - K (x - x_s),
///
/// because a force that was held until the next solution would have no stiffness, and would change in steps that the
/// hand feels. Positions between two requests are left out rather than queued, since a queue would lag more and more
/// behind a fast hand. The extrapolation is a tangent, so beyond `extrapolation_limit` the force is invalid, and the
/// needle is held until the solver has caught up.
///
///     free ----> prepared ----> in contact ----> free
///          (1)            (2)               (3)
///
///     (1) The tip is less than `prepare_distance` above the surface: the thread makes the contact's equations and
///         solves them at LiveCell::preparedDisplacement(), so that there is a tangent at the touch. The contact is
///         prepared anew only when the needle's line has moved by more than a tremor (tremorAllowance).
///     (2) The tip reaches the surface at rest. Without a solution yet the force is invalid.
///     (3) The tip is off the cell at rest and no longer pushed away, or release() was called. In between a force that
///         would pull is zero: a live cell has no adhesion, so the extrapolation is wrong there.
///
/// A step never waits for the solver, unless `fixed_period`. An error of the solver, as of a tip that touches held
/// vertices, makes the force invalid until the next solution.
class LiveCellModel : public CellModel {
 public:
  LiveCellModel(std::shared_ptr<const LiveCell> cell, const LiveCellModelConfig& config);

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

  std::shared_ptr<const LiveCell> cell_;
  LiveCell::Surface rest_;
  std::vector<Member> members_at_rest_;
  LiveCellModelConfig config_;
  SolutionThread thread_;
  int hint_ = 0;  ///< see LiveCell::touch
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
