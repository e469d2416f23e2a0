#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/model/cell_model.h"
#include "cell/model/withdrawal_loss.h"

namespace microinjection {

/// Any cell under a needle that rubs or adheres, whose force on the way out is less than that of the way in. A
/// decorator of a cell that has the way in, because the way out depends on what was before:
///
///     force = force of the way in - slip * loss(depth, turn) * force at the turn
///
/// The turn is the deepest place since first contact. Slip is 1 on the first way out, falls to 0 as the needle goes in
/// again by kReversal of the turn, and rises as it goes out: a stop operator (Visintin, "Differential models of
/// hysteresis", 1994, III.2). Solved cells return to the way in over about that length (doc/design/mechanics.md).
///
/// It is passive if the cell is: on each way in the needle gets back, of what a way out has cost, at most the same at
/// the same depths, because slip is at most 1 and the loss is none at the turn, where a further way in begins.
///
/// The loss is that of a needle on the axis, along the pipette; sideways it is not known, and does not change. An
/// adhering needle stays in contact above first contact, until adhesion has fallen off or the needle is beside the
/// place. The surface that is drawn does not follow it there, and the stiffness is that of the way in.
class WithdrawnCell : public CellModel {
 public:
  static constexpr double kReversal = 0.4;

  /// `tip_radius`: m
  WithdrawnCell(std::unique_ptr<CellModel> cell, WithdrawalLoss loss, double tip_radius)
      : cell_(std::move(cell)), loss_(std::move(loss)), tip_radius_(tip_radius) {}

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;
  void release() override;

  void setBoreLine(const BoreLine& line) override { cell_->setBoreLine(line); }
  void strike(const PiezoPulse& pulse) override { cell_->strike(pulse); }
  const Bore* bore() const override { return cell_->bore(); }
  const std::optional<Contact>& contact() const override { return contact_; }
  std::optional<double> radius() const override { return cell_->radius(); }
  Insertion insertion() const override { return cell_->insertion(); }
  std::vector<std::string> layers() const override { return cell_->layers(); }
  const std::string& invalidReason() const override { return cell_->invalidReason(); }
  std::optional<double> forceError() const override;
  std::optional<Solution> solution(double time) const override { return cell_->solution(time); }
  std::vector<std::array<int, 3>> triangles() const override { return cell_->triangles(); }
  std::vector<std::uint32_t> held() const override { return cell_->held(); }
  std::vector<BorderTriangle> borders() const override { return cell_->borders(); }
  DeformedSurface deformedSurface() override { return cell_->deformedSurface(); }

 private:
  struct Touch {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, first contact
    double depth = 0, turn = 0;                       ///< m
    double force = 0;                                 ///< N, along the pipette, at the turn
    double beside = 0;                                ///< m, of the tip, across the pipette
    double slip = 1;
  };
  double loss(double depth, double force);  ///< N

  std::unique_ptr<CellModel> cell_;
  WithdrawalLoss loss_;
  double tip_radius_;
  std::optional<Touch> touch_;
  std::optional<Contact> contact_;
};

}  // namespace microinjection
