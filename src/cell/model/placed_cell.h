#pragma once

#include <atomic>
#include <optional>

#include "cell/model/cell_model.h"

namespace microinjection {

/// A cell that is not where its scene has it: higher or lower along the world's z axis, where it moves at a bounded
/// speed, so that the force on a needle in contact changes steadily; and where its holding pipette has it, at once.
class PlacedCell : public CellModel {
 public:
  static constexpr double kSpeed = 10e-6;    ///< m/s
  static constexpr double kHighest = 0.25;   ///< of the cell's radius, up or down
  static constexpr char kName[] = "height";  ///< of the parameter (m), see CellParameters.msg

  /// `cell` outlives it.
  explicit PlacedCell(CellModel& cell) : cell_(cell) {}

  /// `height`: m, of the cell above its place in the scene, from the next step on. Any thread.
  void moveTo(double height) { wanted_ = height; }
  /// m, of the last step. Any thread.
  double height() const { return height_; }
  /// `offset`: m, of the cell from its place, besides its height, from the next step on. The thread that steps.
  void follow(const Eigen::Vector3d& offset);

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;
  void release() override {
    cell_.release();
    contact_.reset();
  }

  void setBoreLine(const BoreLine& line) override { cell_.setBoreLine(line); }
  void strike(const PiezoPulse& pulse) override { cell_.strike(pulse); }
  const Bore* bore() const override { return cell_.bore(); }
  const std::optional<Contact>& contact() const override { return contact_; }
  std::optional<double> radius() const override { return cell_.radius(); }
  Insertion insertion() const override { return cell_.insertion(); }
  std::vector<std::string> layers() const override { return cell_.layers(); }
  const std::string& invalidReason() const override { return cell_.invalidReason(); }
  std::optional<double> forceError() const override { return cell_.forceError(); }
  std::optional<Solution> solution(double time) const override { return cell_.solution(time); }
  std::vector<std::array<int, 3>> triangles() const override { return cell_.triangles(); }
  std::vector<std::uint32_t> held() const override { return cell_.held(); }
  std::vector<BorderTriangle> borders() const override { return cell_.borders(); }
  DeformedSurface deformedSurface() override;

 private:
  CellModel& cell_;
  Eigen::Vector3d place() const;

  std::atomic<double> wanted_{0}, height_{0};
  std::array<std::atomic<double>, 3> offset_{};
  std::optional<double> time_;  ///< s, of the last step
  std::optional<Contact> contact_;
};

}  // namespace microinjection
