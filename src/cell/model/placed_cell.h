#pragma once

#include <atomic>
#include <optional>

#include "cell/model/cell_model.h"

namespace microinjection {

/// A cell that lies higher or lower than its scene has it, along the world's z axis. It moves there at a
/// bounded speed, so that the force on a needle in contact changes steadily.
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

  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;
  void release() override {
    cell_.release();
    contact_.reset();
  }

  void setBoreLine(const BoreLine& line) override { cell_.setBoreLine(line); }
  const Bore* bore() const override { return cell_.bore(); }
  const std::optional<Contact>& contact() const override { return contact_; }
  std::optional<double> radius() const override { return cell_.radius(); }
  Insertion insertion() const override { return cell_.insertion(); }
  std::vector<std::string> layers() const override { return cell_.layers(); }
  const std::string& invalidReason() const override { return cell_.invalidReason(); }
  std::optional<Solution> solution(double time) const override { return cell_.solution(time); }
  std::vector<std::array<int, 3>> triangles() const override { return cell_.triangles(); }
  std::vector<std::uint32_t> held() const override { return cell_.held(); }
  std::vector<BorderTriangle> borders() const override { return cell_.borders(); }
  DeformedSurface deformedSurface() override;

 private:
  CellModel& cell_;
  std::atomic<double> wanted_{0}, height_{0};
  std::optional<double> time_;  ///< s, of the last step
  std::optional<Contact> contact_;
};

}  // namespace microinjection
